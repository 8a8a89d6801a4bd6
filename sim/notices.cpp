#include "sim/notices.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

constexpr std::size_t kStoredEvents = 64;
constexpr std::size_t kInputQueue = 63;  // as hidraw keeps them
constexpr std::size_t kEventsPerPage = 2;

}  // namespace

void Notices::raise(const Happening& happening, std::uint64_t timeUs) {
    events_.push_back({.sequence = nextEvent_++,
                       .timeUs = timeUs,
                       .code = happening.code,
                       .arg0 = happening.arg0,
                       .arg1 = happening.arg1});
    if (events_.size() > kStoredEvents) events_.pop_front();
    inputs_.push_back(encode(events_.back()));
}

void Notices::tell(const Status& status) {
    inputs_.push_back(encode(status));
    // The host's queue keeps the oldest; what does not fit is lost.
    while (inputs_.size() > kInputQueue) {
        const bool isStatus = inputs_.back()[0] == static_cast<std::uint8_t>(ReportId::Status);
        ++overflow_.reports;
        overflow_.statuses += isStatus ? 1 : 0;
        inputs_.pop_back();
    }
}

std::optional<Report> Notices::take() {
    if (inputs_.empty()) return std::nullopt;
    const Report report = inputs_.front();
    inputs_.pop_front();
    return report;
}

EventsPage Notices::page() const {
    EventsPage page{.oldest = events_.empty() ? 0 : events_.front().sequence,
                    .newest = newestEvent(),
                    .events = {}};
    for (const Event& e : events_) {
        if (e.sequence >= from_ && page.events.size() < kEventsPerPage) page.events.push_back(e);
    }
    return page;
}

}  // namespace gonio::sim
