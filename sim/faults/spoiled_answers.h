#pragma once
// What a rig says of itself, made newer than its host, or nonsense: descriptors, strings, IDENT and
// LIMITS.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/faults/fault_player.h"
#include "sim/usb_device.h"

namespace gonio::sim {

/// What "malform" may be followed by, as a list for people.
[[nodiscard]] std::string malformations();
[[nodiscard]] bool isMalformation(std::string_view name);
/// Of a descriptor that a host reads when the device is plugged in.
[[nodiscard]] bool malformsDescriptors(std::string_view name);

class SpoiledAnswers {
public:
    /// False: it is no fault of answers. They stay spoiled.
    bool put(const DueFault& fault);
    void spoil(const UsbSetup& setup, UsbReply& reply) const;
    void spoilDevice(std::vector<std::uint8_t>& descriptor) const;
    void spoilConfig(std::vector<std::uint8_t>& descriptors) const;
    [[nodiscard]] const std::vector<std::string>& malformed() const { return malformed_; }

private:
    std::vector<std::string> malformed_;
    int major_ = 1, minor_ = 0;
};

}  // namespace gonio::sim
