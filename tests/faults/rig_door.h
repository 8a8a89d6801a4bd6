#pragma once
// A way to a simulated rig that a fault script disturbs: in this process and in virtual time, or
// through the real USB libraries and in real time.

#include <functional>
#include <memory>

#include "driver/protocol/transport.h"
#include "proc/core/frame.h"
#include "sim/faults/faulty_usb.h"

namespace gonio::fault_test {

class RigDoor {
public:
    virtual ~RigDoor() = default;
    /// What is at the plug, whatever its serial number. The transport of before is closed first.
    [[nodiscard]] virtual Result<driver::Transport*> open() = 0;
    virtual void close() = 0;
    virtual void pause(Nanoseconds time) = 0;
    virtual void with(const std::function<void(sim::FaultyUsb&)>& use) = 0;
    /// Transfers of the opened stream: how many may be in flight, and how many are.
    struct Ring {
        int allowed = 0, inFlight = 0;
    };
    [[nodiscard]] virtual Ring ring() = 0;
    /// How many times as long as in virtual time things may last here.
    [[nodiscard]] virtual int slack() const = 0;

    [[nodiscard]] Nanoseconds now() {
        Nanoseconds time{0};
        with([&](sim::FaultyUsb& usb) { time = usb.now(); });
        return time;
    }
};

/// Small frames of eight chunks.
struct RigSetup {
    Window window;
    sim::DeviceConfig config;
};
[[nodiscard]] inline RigSetup setupOf(int side, std::uint32_t chunk) {
    return {.window = {.x = 960, .y = 704, .size = {side, side}, .binning = 1},
            .config = {.serial = "SIM-0042",
                       .seed = 11,
                       .bootCount = 1,
                       .errors = {},
                       .maxChunkPayload = chunk}};
}
[[nodiscard]] inline RigSetup smallSetup() { return setupOf(64, 1024); }

/// A matt grey, so that every frame has a picture.
void placeSample(sim::Device& device);
/// The rig is gone for good after so many calls, so that a test ends whatever the driver does.
[[nodiscard]] std::unique_ptr<RigDoor> inProcess(const RigSetup& setup, int mostCalls = 100'000);

}  // namespace gonio::fault_test
