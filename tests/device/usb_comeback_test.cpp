// The real USB code when a rig is unplugged in mid-capture and plugged in again, time after time.

#include <sys/stat.h>
#include <umockdev.h>

#include <cstdlib>
#include <fstream>
#include <random>

#include "driver/usb_ledger.h"
#include "tests/device/holdings.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/device/without_rights.h"
#include "tests/support/wait_until.h"

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;
using driver::Rig;
using driver::Transport;
using SteadyTime = std::chrono::steady_clock::time_point;

constexpr Window kTinyWindow{.x = 576, .y = 448, .size = {128, 128}, .binning = 1};

SteadyTime steadyNow() { return std::chrono::steady_clock::now(); }

/// An open rig that finds its way back by itself.
class Returning {
public:
    Returning(MockBus& bus, const std::string& serial) : bus_(bus), serial_(serial) {
        if (!reopen(10s)) return;
        auto opened = Rig::open(*transport_, kSession);
        EXPECT_TRUE(opened) << opened.error().message;
        if (!opened) return;
        rig.emplace(std::move(*opened));
        EXPECT_TRUE(rig->configure(kTinyWindow));
        rig->onLost([this](const Error& lost) -> Result<Transport*> {
            noticedAt = steadyNow();
            losses.push_back(lost);
            close();
            closedAt = steadyNow();
            if (!reopen(10s)) return Error{ErrorKind::Interrupted, "given up: " + obstacle_};
            openedAt = steadyNow();
            return transport_.get();
        });
    }
    ~Returning() {
        rig.reset();
        close();
    }
    Returning(const Returning&) = delete;
    Returning& operator=(const Returning&) = delete;

    std::optional<Rig> rig;
    std::vector<Error> losses;
    std::atomic<SteadyTime> noticedAt{}, closedAt{}, openedAt{};

private:
    void close() {
        const std::scoped_lock lock(bus_.listeners());
        transport_.reset();
    }
    bool reopen(std::chrono::milliseconds patience) {
        for (const SteadyTime end = steadyNow() + patience; steadyNow() < end;) {
            {
                const std::scoped_lock lock(bus_.listeners());
                auto opened = driver::openUsb({.serial = serial_});
                if (opened) {
                    transport_ = std::move(*opened);
                    return true;
                }
                obstacle_ = opened.error().message;
            }
            std::this_thread::sleep_for(20ms);
        }
        return false;
    }

    MockBus& bus_;
    std::string serial_, obstacle_;
    std::unique_ptr<Transport> transport_;
};

class UsbComeback : public UsbRigTest {
protected:
    UsbComeback() { mock.live().warmUp(kTinyWindow); }
    /// The frames of a rig that nothing disturbs, step after step.
    std::vector<Frame> undisturbed(const driver::CaptureRequest& request) {
        if (!twin_) {
            twinDoor_.device().place(mattGrey());
            twin_.emplace(std::move(*Rig::open(twinDoor_, kSession)));
            EXPECT_TRUE(twin_->configure(kTinyWindow));
        }
        auto capture = twin_->capture(request);
        EXPECT_TRUE(capture);
        return std::move(capture->frames);
    }
    void expectUndisturbed(const driver::Capture& capture, const driver::CaptureRequest& request) {
        const auto wanted = undisturbed(request);
        ASSERT_EQ(capture.size(), wanted.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            EXPECT_EQ(capture[i].captureId >> 16, request.planStep);
            EXPECT_EQ(capture[i].pixels, wanted[i].pixels)
                << "step " << request.planStep << ", frame " << i;
        }
    }

private:
    sim::InProcessDoor twinDoor_{rigConfig()};
    std::optional<Rig> twin_;
};

int cycles() { return std::getenv("GONIO_NIGHTLY") != nullptr ? 200 : 20; }

TEST_F(UsbComeback, UnpluggedInMidBracketTimeAfterTimeNoFrameIsLostAndNothingLeaks) {
    constexpr int kWarm = 4;  // cycles after which everything that is made once has been made
    constexpr std::uint32_t kSeed = 8;
    std::mt19937 random(kSeed);
    Returning one(bus, "SIM-0042");
    ASSERT_TRUE(one.rig);
    std::uint64_t step = 1;
    int resent = 0, redone = 0;
    std::chrono::nanoseconds noticed{0}, back{0};
    Holdings before;
    for (int cycle = 0; cycle < cycles(); ++cycle) {
        SCOPED_TRACE("cycle " + std::to_string(cycle));
        if (cycle == kWarm) before = Holdings();
        const auto pause = std::chrono::milliseconds(random() % 120);
        SteadyTime pulled, plugged;
        std::jthread hand([&] {
            std::this_thread::sleep_for(pause);
            pulled = steadyNow();
            mock.unplug();
            std::this_thread::sleep_for(50ms);
            mock.plug();
            plugged = steadyNow();
        });
        const std::size_t losses = one.losses.size();
        const SteadyTime end = steadyNow() + 20s;
        // Some captures after it came back, too: the last pictures of the bracket.
        for (int after = 0; after < 2 && steadyNow() < end; ++step) {
            const auto capture = one.rig->capture(litFrames(step, 3), {litFrames(step + 1, 3)});
            ASSERT_TRUE(capture) << capture.error().message;
            EXPECT_EQ(capture->recaptures, 0);
            expectUndisturbed(*capture, litFrames(step, 3));
            after += one.losses.size() > losses ? 1 : 0;
        }
        hand.join();
        ASSERT_GT(one.losses.size(), losses);
        mock.forgetPulled();
        for (const driver::Interruption& gap : one.rig->takeInterruptions()) {
            EXPECT_TRUE(gap.sameBoot);
            resent += gap.resent;
            redone += gap.redone;
        }
        noticed = std::max<std::chrono::nanoseconds>(noticed, one.noticedAt.load() - pulled);
        back = std::max<std::chrono::nanoseconds>(back, one.openedAt.load() - plugged);
    }
    const Holdings after;
    const auto& ledger = driver::usbLedger();
    // A machine so busy that a rig does not answer in a second loses it once more, and may leave a
    // thread behind, which ends later.
    if (one.losses.size() == static_cast<std::size_t>(cycles())) {
        EXPECT_EQ(ledger.quarantinedThreads, 0);
        EXPECT_EQ(ledger.hidThreads, 1);
        EXPECT_EQ(mock.faults().portResets, 0) << "an empty port takes a kernel seconds to reset";
    }
    EXPECT_EQ(ledger.quarantinedTransfers, 0);
    EXPECT_EQ(ledger.streams, 1);
    EXPECT_LE(after.fds, before.fds);
    EXPECT_LE(after.threads, before.threads);
    // A stream that was not freed holds 2 MiB.
    const auto grown = static_cast<double>(after.heap) - static_cast<double>(before.heap);
    EXPECT_LT(grown, (cycles() - kWarm) * 100e3);
    EXPECT_LT(noticed, 3s) << "expected 0.3 s";
    EXPECT_LT(back, 20s) << "expected 2 s";
    EXPECT_GT(resent + redone, 0);
    std::cout << cycles() << " cycles: noticed after " << noticed / 1ms << " ms at most, back "
              << back / 1ms << " ms after the rig at most, " << resent << " frames sent again, "
              << redone << " exposed again; heap " << grown / 1000 / (cycles() - kWarm)
              << " kB a cycle; fds " << before.fds << " to " << after.fds << ", threads "
              << before.threads << " to " << after.threads << "\n";
}

TEST_F(UsbComeback, OfTwoRigsThatStreamOneIsUnpluggedAndTheOtherNoticesNothing) {
    const sim::DeviceConfig otherConfig = rigConfig("SIM-0043");
    MockRig otherMock(bus, otherConfig, 2);
    otherMock.live().with([](sim::FaultyUsb& usb) { usb.device().place(mattGrey()); });
    otherMock.live().warmUp(kTinyWindow);
    sim::InProcessDoor door(otherConfig);
    door.device().place(mattGrey());
    auto otherTwin = Rig::open(door, kSession);
    ASSERT_TRUE(otherTwin->configure(kTinyWindow));
    Returning one(bus, "SIM-0042");
    Returning other(bus, "SIM-0043");
    ASSERT_TRUE(one.rig && other.rig);
    std::atomic<bool> over{false};
    std::jthread beside([&] {
        for (std::uint64_t step = 1; !over; ++step) {
            const auto seen = other.rig->capture(litFrames(step, 3), {litFrames(step + 1, 3)});
            const auto wanted = otherTwin->capture(litFrames(step, 3));
            ASSERT_TRUE(seen) << seen.error().message;
            for (std::size_t i = 0; i < wanted->size(); ++i)
                EXPECT_EQ((*seen)[i].pixels, (*wanted)[i].pixels) << "step " << step;
        }
    });
    for (std::uint64_t step = 1; step <= 12; ++step) {
        if (step % 4 == 2) mock.unplug();
        std::jthread hand([&] {
            std::this_thread::sleep_for(50ms);
            mock.plug();
        });
        const auto capture = one.rig->capture(litFrames(step, 3));
        if (!capture) ADD_FAILURE() << capture.error().message;
        if (capture) expectUndisturbed(*capture, litFrames(step, 3));
    }
    over = true;
    beside.join();
    EXPECT_EQ(one.losses.size(), 3U);
    EXPECT_TRUE(other.losses.empty());
    EXPECT_EQ(other.rig->anomalies(), driver::Anomalies{});
    EXPECT_EQ(other.rig->link().reopens(), 0U);
    EXPECT_EQ(driver::usbLedger().streams, 2);
    EXPECT_EQ(driver::usbLedger().quarantinedThreads, 0);
}

TEST_F(UsbComeback, SilentReportsAreOpenedAnewAndTheCaptureGoesOn) {
    Returning one(bus, "SIM-0042");
    ASSERT_TRUE(one.rig);
    mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::SilenceReports); });
    const SteadyTime begin = steadyNow();
    while (one.rig->link().reopens() == 0 && steadyNow() - begin < 6s) {
        ASSERT_TRUE(one.rig->keepAlive());
        std::this_thread::sleep_for(10ms);
    }
    std::cout << "noticed after " << (steadyNow() - begin) / 1ms << " ms\n";
    EXPECT_LT(steadyNow() - begin, 6s) << "expected 0.6 s";
    EXPECT_EQ(one.rig->link().reopens(), 1U);
    const auto capture = one.rig->capture(litFrames(1, 3));
    ASSERT_TRUE(capture) << capture.error().message;
    expectUndisturbed(*capture, litFrames(1, 3));
    EXPECT_TRUE(one.losses.empty());
}

TEST_F(UsbComeback, ARigThatHangsUntilItsPortIsResetMeasuresOn) {
    Returning one(bus, "SIM-0042");
    ASSERT_TRUE(one.rig);
    ASSERT_TRUE(one.rig->capture(litFrames(1)));
    mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::HangUntilReset); });
    const SteadyTime begin = steadyNow();
    const auto capture = one.rig->capture(litFrames(2, 3));
    ASSERT_TRUE(capture) << capture.error().message;
    std::cout << "captured " << (steadyNow() - begin) / 1ms << " ms later\n";
    EXPECT_LT(steadyNow() - begin, 20s);
    expectUndisturbed(*capture, litFrames(2, 3));
    EXPECT_EQ(one.losses.size(), 1U);
}

TEST_F(UsbComeback, ARigThatHangsForGoodIsLostAndEveryCallEnds) {
    Returning one(bus, "SIM-0042");
    ASSERT_TRUE(one.rig);
    one.rig->onLost({});
    mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::Hang); });
    const SteadyTime begin = steadyNow();
    const auto capture = one.rig->capture(litFrames(1));
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().kind, ErrorKind::Device);
    EXPECT_LT(steadyNow() - begin, 20s) << "expected 2 s";
    EXPECT_TRUE(one.rig->link().lost());
    const SteadyTime then = steadyNow();
    EXPECT_FALSE(one.rig->capture(litFrames(1)));
    EXPECT_FALSE(one.rig->darken());
    EXPECT_LT(steadyNow() - then, 100ms) << "at once";
}

TEST_F(UsbComeback, ARigWhoseTransfersComeBackLateIsBusyUntilThen) {
    auto transport = opened();
    ASSERT_TRUE(transport);
    mock.faults().keepsCancelled = true;
    const SteadyTime begin = steadyNow();
    transport.reset();
    EXPECT_LT(steadyNow() - begin, 5s) << "expected 0.9 s";
    EXPECT_EQ(driver::usbLedger().streams, 1);
    const auto refused = driver::openUsb();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Busy) << refused.error().message;
    mock.faults().keepsCancelled = false;
    EXPECT_TRUE(test::waitUntil([&] {
        auto again = driver::openUsb();
        if (again) transport = std::move(*again);
        return transport != nullptr;
    }));
    EXPECT_EQ(driver::usbLedger().streams, 1);
    EXPECT_EQ(driver::usbLedger().quarantinedTransfers, 0);
}

TEST_F(UsbComeback, PermissionThatComesLateIsABusyRigUntilThen) {
    ASSERT_EQ(chmod(bus.real("").c_str(), 0777), 0);
    // umockdev's own sockets must stay within reach, whatever becomes of the nodes.
    for (const std::string& node : {mock.usbNode(), mock.hidNode()})
        ASSERT_EQ(chmod(bus.real("/ioctl" + node).c_str(), 0777), 0);
    ASSERT_EQ(chmod(bus.real(mock.hidNode()).c_str(), 0666), 0);
    ASSERT_EQ(chmod(bus.real(mock.usbNode()).c_str(), 0), 0);
    for (int i = 0; i < 3; ++i) {
        const WithoutRights unprivileged;
        const auto refused = driver::openUsb();
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().kind, ErrorKind::Busy) << refused.error().message;
    }
    ASSERT_EQ(chmod(bus.real(mock.usbNode()).c_str(), 0666), 0);
    const WithoutRights unprivileged;
    const auto given = driver::openUsb();
    ASSERT_TRUE(given) << given.error().message;
}

class Autosuspend : public UsbRigTest {
protected:
    Autosuspend() {
        umockdev_testbed_set_attribute(
            bus.testbed(), "/sys/devices/usb1/1-1", "power/control", "auto");
    }
    [[nodiscard]] std::string path() const {
        return bus.real("/sys/devices/usb1/1-1/power/control");
    }
    [[nodiscard]] std::string control() const {
        std::ifstream file(path());
        std::string word;
        file >> word;
        return word;
    }
};

TEST_F(Autosuspend, IsForbiddenWhereThatIsAllowed) {
    ASSERT_EQ(control(), "auto");
    ASSERT_TRUE(opened());
    EXPECT_EQ(control(), "on");
}

TEST_F(Autosuspend, IsWarnedOfOnceWhereItCannotBeForbidden) {
    ASSERT_EQ(chmod(bus.real("").c_str(), 0777), 0);
    for (const std::string& node : {mock.usbNode(), mock.hidNode()}) {
        ASSERT_EQ(chmod(bus.real("/ioctl" + node).c_str(), 0777), 0);
        ASSERT_EQ(chmod(bus.real(node).c_str(), 0666), 0);
    }
    ASSERT_EQ(chmod(path().c_str(), 0444), 0);
    const WithoutRights unprivileged;
    testing::internal::CaptureStderr();
    ASSERT_TRUE(opened());
    const std::string first = testing::internal::GetCapturedStderr();
    EXPECT_NE(first.find("power/control"), std::string::npos) << first;
    testing::internal::CaptureStderr();
    ASSERT_TRUE(opened());
    EXPECT_EQ(testing::internal::GetCapturedStderr().find("power/control"), std::string::npos);
    EXPECT_EQ(control(), "auto");
}

}  // namespace
}  // namespace gonio::device_test
