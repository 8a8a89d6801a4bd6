#pragma once
// The cable from a simulated rig to a USB port of this computer's own kernel: the module vhci-hcd
// takes one end of a socket pair, the rig answers at the other. Neither a network nor the usbip
// tools are needed, but root is.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "sim/live_rig.h"

namespace gonio::sim {

/// Where the module says what it has: a port per line.
[[nodiscard]] std::filesystem::path vhciFolder();

/// A free port of this speed ("hs" or "ss") in the text of `status`; empty: none.
[[nodiscard]] std::optional<unsigned> freeVhciPort(const std::string& status,
                                                   const std::string& speed);

class VhciCable {
public:
    /// The rig is borrowed; `number` tells several of them apart, from 1. No module: NoRig. No
    /// right, or no free port: Busy. From then on what is done to the rig's plug
    /// (FaultyUsb::unplug and plug, or a script) happens to the port.
    [[nodiscard]] static Result<std::unique_ptr<VhciCable>> attach(LiveRig& rig,
                                                                   unsigned number = 1);
    ~VhciCable();
    VhciCable(const VhciCable&) = delete;
    VhciCable& operator=(const VhciCable&) = delete;

private:
    struct Line;
    VhciCable(LiveRig& rig, unsigned number);
    [[nodiscard]] std::optional<int> pullsIfPlugged();
    Result<void> plug(int pulls);
    void follow(const std::stop_token& stop);

    LiveRig& rig_;
    unsigned number_;
    int pulls_ = 0;  ///< of the rig when it was attached last
    std::unique_ptr<Line> line_;
    std::string obstacle_;  ///< why it could not be plugged in last time, of the following thread
    std::jthread follower_;
};

}  // namespace gonio::sim
