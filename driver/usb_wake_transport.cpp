#include <libusb.h>
#include <pthread.h>

#include <array>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "driver/usb_ledger.h"
#include "driver/usb_wake.h"

namespace gonio::driver {
namespace {

/// Those that this process has asked for.
class PortResets {
public:
    static PortResets& one() {
        // Never freed: a reset may outlast main().
        static PortResets& resets = *std::make_unique<PortResets>().release();
        return resets;
    }
    void begin(const std::string& place) {
        const std::scoped_lock lock(mutex_);
        unanswered_.insert(place);
        underWay_.insert(place);
    }
    void end(const std::string& place) {
        const std::scoped_lock lock(mutex_);
        underWay_.erase(underWay_.find(place));
        changed_.notify_all();
    }
    void answered(const std::string& place) {
        const std::scoped_lock lock(mutex_);
        unanswered_.erase(place);
    }
    [[nodiscard]] bool isUnanswered(const std::string& place) {
        const std::scoped_lock lock(mutex_);
        return unanswered_.contains(place);
    }
    /// A place whose reset is still under way at the limit; empty: there is none.
    [[nodiscard]] std::string awaitNone() {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kPortResetLimit, [this] { return underWay_.empty(); });
        return underWay_.empty() ? std::string() : *underWay_.begin();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::set<std::string> unanswered_;  ///< places whose rig has not answered since
    std::multiset<std::string> underWay_;
};

/// As long as it lives, nobody looks for devices.
class UnderWay {
public:
    explicit UnderWay(std::string place) : place_(std::move(place)) {
        PortResets::one().begin(place_);
    }
    ~UnderWay() { PortResets::one().end(place_); }
    UnderWay(const UnderWay&) = delete;
    UnderWay& operator=(const UnderWay&) = delete;

private:
    std::string place_;
};

}  // namespace

int askWhetherThere(const OpenedRig& rig) {
    constexpr unsigned kProbeMs = 200;
    std::array<std::uint8_t, 2> status{};
    const int got = libusb_control_transfer(rig.handle.get(),
                                            LIBUSB_ENDPOINT_IN,
                                            LIBUSB_REQUEST_GET_STATUS,
                                            0,
                                            0,
                                            status.data(),
                                            static_cast<std::uint16_t>(status.size()),
                                            kProbeMs);
    if (got == static_cast<int>(status.size())) return 0;
    return got < 0 ? got : LIBUSB_ERROR_IO;
}

bool isSilent(const OpenedRig& rig) { return askWhetherThere(rig) == LIBUSB_ERROR_TIMEOUT; }

bool isGone(const OpenedRig& rig) {
    const int probe = askWhetherThere(rig);
    return probe != 0 && probe != LIBUSB_ERROR_TIMEOUT;
}

Result<void> resetPortOf(const OpenedRig& rig) {
    const UnderWay reset(rig.place);
    const int code = libusb_reset_device(rig.handle.get());
    // Not found: it shows up anew.
    if (code == 0 || code == LIBUSB_ERROR_NOT_FOUND) return {};
    return usbError(code, "reset the port of " + nameOf(rig));
}

Result<void> awaitPortResets() {
    const std::string place = PortResets::one().awaitNone();
    if (place.empty()) return {};
    return Error{ErrorKind::Device,
                 "the port of the rig at " + place +
                     " is still being reset; check the rig's cable and power"};
}

Result<void> wake(OpenedRig rig) {
    const std::string silent = nameOf(rig) + " does not answer";
    if (auto claimed = claimStream(rig); !claimed) return claimed.error().in(silent);
    if (PortResets::one().isUnanswered(rig.place))
        return Error{ErrorKind::Device,
                     silent + " even after its port was reset; check its cable and power"};
    std::packaged_task<Result<void>()> reset([asked = std::move(rig)]() mutable {
        (void)pthread_setname_np(pthread_self(), kWakeThread);
        const UnderWay untilClosed(asked.place);
        const OpenedRig own = std::move(asked);
        return resetPortOf(own);
    });
    auto done = reset.get_future();
    std::thread thread(std::move(reset));
    const bool ended = done.wait_for(kPortResetLimit) == std::future_status::ready;
    joinOrLeave(thread, ended, silent + "; the reset of its port does not end, and is left behind");
    if (!ended)
        return Error{ErrorKind::Device,
                     silent + ", and its port cannot be reset; check its cable and power"};
    auto woken = done.get();
    return woken ? woken : woken.error().in(silent);
}

void noteAnswer(const OpenedRig& rig) { PortResets::one().answered(rig.place); }

}  // namespace gonio::driver
