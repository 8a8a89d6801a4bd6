#include "proc/models/spec.h"
#include "sim/in_process.h"
#include "tests/faults/rig_door.h"

namespace gonio::fault_test {
namespace {

/// Ends what would never end: after its last call the rig is gone for good.
class Patience : public driver::Transport {
public:
    Patience(std::unique_ptr<sim::InProcessDoor> door, int& callsLeft)
        : door_(std::move(door)), callsLeft_(callsLeft) {}
    [[nodiscard]] driver::DeviceStrings strings() const override { return door_->strings(); }
    [[nodiscard]] const Clock& clock() const override { return door_->clock(); }
    Result<void> write(const driver::Report& report) override {
        if (over()) return end();
        return door_->write(report);
    }
    Result<void> setFeature(const driver::Report& report) override {
        if (over()) return end();
        return door_->setFeature(report);
    }
    Result<driver::Report> getFeature(std::uint8_t id) override {
        if (over()) return end();
        return door_->getFeature(id);
    }
    Result<std::optional<driver::Report>> readInput(Nanoseconds wait) override {
        if (over()) return end();
        return door_->readInput(wait);
    }
    Result<std::optional<driver::BulkBytes>> readBulk(Nanoseconds wait) override {
        if (over()) return end();
        return door_->readBulk(wait);
    }
    Result<void> reopenReports() override { return door_->reopenReports(); }
    Result<void> resetPort() override { return door_->resetPort(); }
    [[nodiscard]] const sim::InProcessDoor::Counters& counters() const { return door_->counters(); }

private:
    bool over() { return callsLeft_ == 0 || --callsLeft_ == 0; }
    static Error end() { return {ErrorKind::Device, "the test's patience is at its end"}; }

    std::unique_ptr<sim::InProcessDoor> door_;
    int& callsLeft_;  ///< of all doors to this rig
};

class InProcessRig : public RigDoor {
public:
    InProcessRig(const RigSetup& setup, int mostCalls)
        : first_(setup.config), callsLeft_(mostCalls) {
        placeSample(first_.device());
    }
    Result<driver::Transport*> open() override {
        auto door = first_.openAgain();
        if (!door) return door.error();
        door_ = std::make_unique<Patience>(std::move(*door), callsLeft_);
        return door_.get();
    }
    void close() override { door_.reset(); }
    [[nodiscard]] Ring ring() override {
        if (!door_) return {};
        return {.allowed = door_->counters().ring, .inFlight = door_->counters().inFlight};
    }
    [[nodiscard]] int slack() const override { return 1; }
    void pause(Nanoseconds time) override { first_.usb().advanceTo(first_.usb().now() + time); }
    void with(const std::function<void(sim::FaultyUsb&)>& use) override { use(first_.usb()); }

private:
    sim::InProcessDoor first_;  ///< keeps the rig; nobody uses it
    int callsLeft_;
    std::unique_ptr<Patience> door_;
};

}  // namespace

void placeSample(sim::Device& device) {
    device.place({.role = sim::Role::Sample,
                  .surface = std::move(*proc::makeModel("lambert,albedo=0.5")),
                  .wedge = {}});
}

std::unique_ptr<RigDoor> inProcess(const RigSetup& setup, int mostCalls) {
    return std::make_unique<InProcessRig>(setup, mostCalls);
}

}  // namespace gonio::fault_test
