#include "sim/in_process.h"

#include <algorithm>
#include <utility>

namespace gonio::sim {
namespace {

constexpr Nanoseconds kControlTime = std::chrono::microseconds(200);

Error stalled(int id) {
    return {ErrorKind::Device, "feature report " + std::to_string(id) + ": the device stalled"};
}

/// Takes from the device, letting its time run up to `wait`.
template <class Take>
auto waitFor(Device& device, Nanoseconds wait, Take take) {
    const Nanoseconds deadline = device.now() + wait;
    while (true) {
        auto item = take();
        if (item || device.now() >= deadline) return item;
        // At least one step, so that an event at this very moment is passed.
        const Nanoseconds next = std::max(device.nextEvent(), device.now() + Nanoseconds(1));
        device.advanceTo(std::min(next, deadline));
    }
}

}  // namespace

driver::DeviceStrings InProcessDoor::strings() const {
    return {.vendor = 0x1209, .product = 0x0001, .serial = device_.serial(), .protocol = "GRP/1.0"};
}

Result<void> InProcessDoor::write(const driver::Report& report) {
    spend(kControlTime);
    device_.output(report);
    return {};
}

Result<void> InProcessDoor::setFeature(const driver::Report& report) {
    spend(kControlTime);
    if (!device_.setFeature(report)) return stalled(report[0]);
    return {};
}

Result<driver::Report> InProcessDoor::getFeature(std::uint8_t id) {
    spend(kControlTime);
    if (auto report = device_.getFeature(id)) return *report;
    return stalled(id);
}

Result<std::optional<driver::Report>> InProcessDoor::readInput(Nanoseconds wait) {
    return waitFor(device_, wait, [this] { return device_.takeInput(); });
}

Result<std::optional<driver::BulkBytes>> InProcessDoor::readBulk(Nanoseconds wait) {
    auto chunk = waitFor(device_, wait, [this] { return device_.takeBulk(); });
    if (!chunk) return std::optional<driver::BulkBytes>{};
    lent_ = std::move(*chunk);
    const double cost = device_.link().nanosecondsPerByte * static_cast<double>(lent_.size());
    spend(Nanoseconds(static_cast<std::int64_t>(cost)));
    return std::optional<driver::BulkBytes>(lent_);
}

Result<void> InProcessDoor::resetStream() {
    spend(kControlTime);
    device_.resetStream();
    return {};
}

Result<void> InProcessDoor::reopenReports() {
    spend(kControlTime);
    while (device_.takeInput()) {
    }
    return {};
}

Result<void> InProcessDoor::resetPort() {
    spend(kControlTime);
    device_.linkLost();
    return {};
}

}  // namespace gonio::sim
