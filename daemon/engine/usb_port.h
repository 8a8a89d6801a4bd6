#pragma once
// A rig on USB. The first rig that was opened stays the only one that is: another serial number in
// its place is refused, both are named, and the port waits on (PROTOCOL.md 4).

#include <memory>

#include "daemon/engine/rig_port.h"
#include "driver/usb_transport.h"

namespace gonio::daemon {

class UsbPort : public RigPort {
public:
    explicit UsbPort(driver::UsbSelection selection) : selection_(std::move(selection)) {}

    [[nodiscard]] std::string_view kind() const override { return "usb"; }
    [[nodiscard]] Result<std::vector<RigListing>> list() override;
    [[nodiscard]] Result<driver::Transport*> open() override;
    void close() override { transport_.reset(); }
    [[nodiscard]] std::string placed() const override { return {}; }
    Result<bool> placeMirror(const proc::Wedge& /*wedge*/) override { return false; }
    void describe(proc::SampleInfo& info) const override { info.extra["rig"] = "USB"; }

private:
    driver::UsbSelection selection_;
    std::unique_ptr<driver::Transport> transport_;
};

}  // namespace gonio::daemon
