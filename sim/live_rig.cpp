#include "sim/live_rig.h"

#include "driver/protocol/reports.h"

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;
using namespace driver;

}  // namespace

LiveRig::LiveRig(DeviceConfig config, Clock clock)
    : usb_(std::move(config)), clock_(std::move(clock)), boot_(clock_()) {
    pump_ = std::jthread([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            flushReports();
            std::this_thread::sleep_for(1ms);
        }
    });
}

LiveRig::~LiveRig() {
    pump_.request_stop();
    pump_.join();
}

Nanoseconds LiveRig::computersClock() {
    return std::chrono::steady_clock::now().time_since_epoch();
}

void LiveRig::advance() { usb_.advanceTo(clock_() - boot_ + skipped_); }

void LiveRig::listen(Sink sink) {
    const std::scoped_lock lock(mutex_);
    sink_ = std::move(sink);
    listenedAfter_ = usb_.pulls();
}

void LiveRig::flushReports() {
    const std::scoped_lock lock(mutex_);
    advance();
    handOn();
}

void LiveRig::handOn() {
    while (true) {
        const UsbReply reply = usb_.interruptIn();
        if (reply.answer == UsbAnswer::Stall && sink_ && !faults.hung) sink_({});
        if (reply.answer != UsbAnswer::Done) return;
        if (sink_ && !faults.hung && usb_.pulls() == listenedAfter_) sink_(reply.data);
    }
}

void LiveRig::warmUp(const Window& window) {
    const std::scoped_lock lock(mutex_);
    Device& device = usb_.device();
    constexpr std::uint64_t kSession = 0xFFFFFFFF;
    const SessionSet claim{.sessionId = kSession, .heartbeatMs = 10000, .hostMinor = 0};
    device.setFeature(encode(claim));
    std::uint16_t sequence = 0;
    const auto send = [&](Op op, const Arguments& arguments) {
        device.output(encode(Command{.sessionLow = static_cast<std::uint32_t>(kSession),
                                     .sequence = ++sequence,
                                     .op = op,
                                     .arguments = arguments}));
    };
    const auto u16 = [](int value) { return static_cast<std::uint16_t>(value); };
    send(Op::SetFormat,
         encode(SetFormat{.format = PixelFormat::Mono12Packed,
                          .x = u16(window.x),
                          .y = u16(window.y),
                          .width = u16(window.size.width),
                          .height = u16(window.size.height),
                          .binning = static_cast<std::uint8_t>(window.binning)}));
    for (std::uint8_t led = 0; led < device.leds(); ++led) {
        send(Op::SetLed, encode(SetLed{.led = led, .levels = {1, 0, 0}}));
        send(Op::Arm, encode(Arm{.captureId = led + 1ULL, .frames = 1, .trigger = 0}));
        device.advanceTo(device.now() + 1s);
    }
    SessionSet release = claim;
    release.release = true;
    device.setFeature(encode(release));
    skipped_ = device.now() - (clock_() - boot_);
    while (usb_.interruptIn().answer == UsbAnswer::Done) {
    }
}

}  // namespace gonio::sim
