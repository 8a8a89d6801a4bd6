// The real USB code when a rig is unplugged in mid-capture and plugged in again, time after time.

#include <malloc.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <random>

#include "driver/usb_ledger.h"
#include "tests/device/usb_rig_fixture.h"

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;
using driver::Rig;
using driver::Transport;
using SteadyTime = std::chrono::steady_clock::time_point;

constexpr Window kTinyWindow{.x = 576, .y = 448, .size = {128, 128}, .binning = 1};

SteadyTime steadyNow() { return std::chrono::steady_clock::now(); }

/// Of a folder in /proc, but for links to `except`.
std::size_t entries(const char* folder, const std::string& except = "") {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::error_code none;
        const auto target = std::filesystem::read_symlink(entry.path(), none);
        if (target.empty() || target != except) ++count;
    }
    return count;
}

/// What a process may leak.
struct Holdings {
    // The test bed keeps the master of a terminal for each hidraw node that there ever was.
    std::size_t fds = entries("/proc/self/fd", "/dev/ptmx");
    std::size_t threads = entries("/proc/self/task");
    std::size_t heap = mallinfo2().uordblks;
};

/// An open rig that finds its way back by itself.
class Returning {
public:
    explicit Returning(const std::string& serial) : serial_(serial) {
        if (!reopen(10s)) return;
        auto opened = Rig::open(*transport_, kSession);
        EXPECT_TRUE(opened) << opened.error().message;
        if (!opened) return;
        rig.emplace(std::move(*opened));
        EXPECT_TRUE(rig->configure(kTinyWindow));
        rig->onLost([this](const Error& lost) -> Result<Transport*> {
            noticedAt = steadyNow();
            losses.push_back(lost);
            transport_.reset();
            closedAt = steadyNow();
            if (!reopen(10s)) return Error{ErrorKind::Interrupted, "given up: " + obstacle_};
            openedAt = steadyNow();
            return transport_.get();
        });
    }
    ~Returning() { rig.reset(); }
    Returning(const Returning&) = delete;
    Returning& operator=(const Returning&) = delete;

    std::optional<Rig> rig;
    std::vector<Error> losses;
    std::atomic<SteadyTime> noticedAt{}, closedAt{}, openedAt{};

private:
    bool reopen(std::chrono::milliseconds patience) {
        for (const SteadyTime end = steadyNow() + patience; steadyNow() < end;) {
            auto opened = driver::openUsb({.serial = serial_});
            if (opened) {
                transport_ = std::move(*opened);
                return true;
            }
            obstacle_ = opened.error().message;
            std::this_thread::sleep_for(20ms);
        }
        return false;
    }

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
    Returning one("SIM-0042");
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
        ASSERT_EQ(one.losses.size(), losses + 1);
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
    EXPECT_EQ(ledger.quarantinedThreads, 0);
    EXPECT_EQ(ledger.quarantinedTransfers, 0);
    EXPECT_EQ(ledger.streams, 1);
    EXPECT_EQ(ledger.hidThreads, 1);
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

}  // namespace
}  // namespace gonio::device_test
