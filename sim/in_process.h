#pragma once
// The in-process door: the driver's transport on a simulated device, in virtual time. Each call
// costs what it would on USB (a control or interrupt transfer 0.2 ms, bulk what the rig's camera
// kind carries), and waiting lets the virtual clock run to the next thing that happens. Every byte
// passes the codec on both sides.

#include "driver/protocol/transport.h"
#include "sim/device.h"

namespace gonio::sim {

class InProcessDoor : public driver::Transport, private Clock {
public:
    explicit InProcessDoor(DeviceConfig config) : device_(std::move(config)) {}

    [[nodiscard]] driver::DeviceStrings strings() const override;
    [[nodiscard]] const Clock& clock() const override { return *this; }
    Result<void> write(const driver::Report& report) override;
    Result<void> setFeature(const driver::Report& report) override;
    [[nodiscard]] Result<driver::Report> getFeature(std::uint8_t id) override;
    [[nodiscard]] Result<std::optional<driver::Report>> readInput(Nanoseconds wait) override;
    [[nodiscard]] Result<std::optional<driver::BulkBytes>> readBulk(Nanoseconds wait) override;
    Result<void> resetStream() override;
    Result<void> reopenReports() override;
    Result<void> resetPort() override;

    [[nodiscard]] Device& device() { return device_; }

private:
    [[nodiscard]] Nanoseconds now() const override { return device_.now(); }
    void spend(Nanoseconds time) { device_.advanceTo(device_.now() + time); }

    Device device_;
    std::vector<std::uint8_t> lent_;  ///< the chunk that the caller has
};

}  // namespace gonio::sim
