#include "proc/models/spec.h"
#include "sim/in_process.h"
#include "tests/faults/rig_door.h"

namespace gonio::fault_test {
namespace {

class InProcessRig : public RigDoor {
public:
    explicit InProcessRig(const RigSetup& setup) : first_(setup.config) {
        placeSample(first_.device());
    }
    Result<driver::Transport*> open() override {
        auto door = first_.openAgain();
        if (!door) return door.error();
        door_ = std::move(*door);
        return door_.get();
    }
    void close() override { door_.reset(); }
    void pause(Nanoseconds time) override { first_.usb().advanceTo(first_.usb().now() + time); }
    void with(const std::function<void(sim::FaultyUsb&)>& use) override { use(first_.usb()); }

private:
    sim::InProcessDoor first_;  ///< keeps the rig; nobody uses it
    std::unique_ptr<sim::InProcessDoor> door_;
};

}  // namespace

void placeSample(sim::Device& device) {
    device.place({.role = sim::Role::Sample,
                  .surface = std::move(*proc::makeModel("lambert,albedo=0.5")),
                  .wedge = {}});
}

std::unique_ptr<RigDoor> inProcess(const RigSetup& setup) {
    return std::make_unique<InProcessRig>(setup);
}

}  // namespace gonio::fault_test
