#pragma once
// What the USB side of this process holds at this moment, over all rigs, so that a leak can be
// seen. Quarantined is what the kernel did not give back in time: it may still write there, so it
// is never freed, and these two only grow.

#include <atomic>
#include <string>
#include <thread>

namespace gonio::driver {

struct UsbLedger {
    std::atomic<int> streams{0};
    std::atomic<int> transfersInFlight{0};
    std::atomic<int> transfersAllowed{0};  ///< in flight at most, as the rings are now
    std::atomic<int> hidThreads{0};
    std::atomic<int> quarantinedTransfers{0};
    std::atomic<int> quarantinedThreads{0};
};

[[nodiscard]] UsbLedger& usbLedger();

/// Joins a thread that has ended; one that has not is left behind with what it owns, counted, and
/// warned of.
void joinOrLeave(std::thread& thread, bool ended, const std::string& warning);

}  // namespace gonio::driver
