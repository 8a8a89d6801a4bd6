#pragma once
// What happens, in order and numbered, for whoever watches: the newest few thousand events. Numbers
// ascend over restarts, so that a watcher who comes back says the last that it saw.

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/logbook.h"

namespace gonio::daemon {

/// For any number of threads.
class EventLog {
public:
    /// Numbers begin after `newest`.
    explicit EventLog(std::uint64_t newest) : newest_(newest) {}

    /// With its number.
    EventRecord add(EventRecord event);
    /// Those after `id`, oldest first; waits until there is one, closed() or `wait` has passed.
    [[nodiscard]] std::vector<EventRecord> after(std::uint64_t id, std::chrono::milliseconds wait);
    /// Number of the oldest that is still here; one more than newest() when there is none.
    [[nodiscard]] std::uint64_t oldest();
    [[nodiscard]] std::uint64_t newest();

    /// Nobody waits from now on.
    void close();
    [[nodiscard]] bool closed();

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<EventRecord> events_;
    std::uint64_t newest_;
    bool closed_ = false;
};

}  // namespace gonio::daemon
