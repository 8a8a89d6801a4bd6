#include "daemon/engine/event_log.h"

#include <algorithm>

namespace gonio::daemon {
namespace {

constexpr std::size_t kKept = 4096;

}  // namespace

EventRecord EventLog::add(EventRecord event) {
    {
        const std::scoped_lock lock(mutex_);
        event.id = ++newest_;
        events_.push_back(event);
        if (events_.size() > kKept) events_.pop_front();
    }
    changed_.notify_all();
    return event;
}

std::vector<EventRecord> EventLog::after(std::uint64_t id, std::chrono::milliseconds wait) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, wait, [&] { return closed_ || newest_ > id; });
    const auto first = std::find_if(
        events_.begin(), events_.end(), [&](const EventRecord& event) { return event.id > id; });
    return {first, events_.end()};
}

std::uint64_t EventLog::oldest() {
    const std::scoped_lock lock(mutex_);
    return events_.empty() ? newest_ + 1 : events_.front().id;
}

std::uint64_t EventLog::newest() {
    const std::scoped_lock lock(mutex_);
    return newest_;
}

void EventLog::close() {
    {
        const std::scoped_lock lock(mutex_);
        closed_ = true;
    }
    changed_.notify_all();
}

bool EventLog::closed() {
    const std::scoped_lock lock(mutex_);
    return closed_;
}

}  // namespace gonio::daemon
