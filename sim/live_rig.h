#pragma once
// A simulated rig in real time: its clock is the computer's, counted from when it was made. Each
// request finds it where it would be now; between requests a thread of its own lets time pass and
// hands on the input reports. What it does wrong is its fault script's (FaultyUsb::play), or what a
// test sets by hand in Faults.

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

#include "proc/core/frame.h"
#include "sim/faults/faulty_usb.h"

namespace gonio::sim {

/// Read by the doors; counters go down to zero as they are used up.
struct Faults {
    std::atomic<bool> hung{false};            ///< enumerated, and answers nothing
    std::atomic<bool> claimed{false};         ///< another program has the stream interface
    std::atomic<bool> keepsCancelled{false};  ///< transfers that were cancelled do not come back
    std::atomic<int> mostTransfers{1000};     ///< then the kernel has no memory for another
    std::atomic<int> shorten{0};              ///< transfers that end after half their bytes
    std::atomic<int> overflow{0};             ///< transfers that bring more than their buffer holds
    std::atomic<int> protocolErrors{0};       ///< transfers that end in an error of the bus
    std::atomic<int> portResets{0};  ///< counts up: asked for, also of a port without a rig
};

class LiveRig {
public:
    /// Takes a report; an empty one says that their endpoint is stalled, again and again until its
    /// halt is cleared.
    using Sink = std::function<void(const std::vector<std::uint8_t>& report)>;
    /// Never goes back; asked by one thread at a time.
    using Clock = std::function<Nanoseconds()>;

    explicit LiveRig(DeviceConfig config, Clock clock = computersClock);
    ~LiveRig();
    LiveRig(const LiveRig&) = delete;
    LiveRig& operator=(const LiveRig&) = delete;

    /// What `use` answers, with the rig at the present time. Reports that it caused are handed on
    /// at once: an ACK does not wait for the picture that its command began.
    template <class Use>
    auto with(Use use) {
        const std::scoped_lock lock(mutex_);
        advance();
        if constexpr (std::is_void_v<std::invoke_result_t<Use&, FaultyUsb&>>) {
            use(usb_);
            handOn();
        } else {
            auto answer = use(usb_);
            handOn();
            return answer;
        }
    }
    /// Takes the reports from now on, of the rig that is at the plug and until another one is, or
    /// it again; empty: nobody listens, and they are lost.
    void listen(Sink sink);
    /// takes a lit frame of each LED in this window, so that later frames come as fast
    /// as a rig's: what the simulator works out once is then known.
    void warmUp(const Window& window);

    Faults faults;

private:
    [[nodiscard]] static Nanoseconds computersClock();
    void flushReports();
    void advance();
    void handOn();

    FaultyUsb usb_;
    std::mutex mutex_;
    Sink sink_;
    int listenedAfter_ = 0;  ///< pulls of the cable
    Clock clock_;
    Nanoseconds boot_;
    Nanoseconds skipped_{0};  ///< device time that warming up took
    std::jthread pump_;
};

}  // namespace gonio::sim
