#include "driver/anomalies.h"

#include <array>

namespace gonio::driver {
namespace {

struct Counter {
    std::uint32_t Anomalies::*count;
    const char* one;
    const char* many;
};

constexpr std::array kCounters{
    Counter{&Anomalies::emptyTransfers, "empty transfer", "empty transfers"},
    Counter{&Anomalies::badLengths, "bad length", "bad lengths"},
    Counter{&Anomalies::badHeaders, "bad header", "bad headers"},
    Counter{&Anomalies::badPayloads, "bad payload", "bad payloads"},
    Counter{&Anomalies::badFrames, "bad frame", "bad frames"},
    Counter{&Anomalies::lostChunks, "lost chunk", "lost chunks"},
    Counter{&Anomalies::disordered, "chunk out of order", "chunks out of order"},
    Counter{&Anomalies::duplicates, "duplicate", "duplicates"},
    Counter{&Anomalies::stale, "stale chunk", "stale chunks"},
    Counter{&Anomalies::unknownTypes, "unknown chunk type", "unknown chunk types"},
    Counter{&Anomalies::contradictions, "contradicting chunk", "contradicting chunks"},
    Counter{&Anomalies::aborted, "aborted frame", "aborted frames"},
    Counter{&Anomalies::givenUp, "frame given up", "frames given up"},
};

}  // namespace

std::uint32_t Anomalies::total() const {
    std::uint32_t sum = 0;
    for (const Counter& c : kCounters) sum += this->*c.count;
    return sum;
}

Anomalies Anomalies::since(const Anomalies& before) const {
    Anomalies fresh;
    for (const Counter& c : kCounters) fresh.*c.count = this->*c.count - before.*c.count;
    return fresh;
}

std::string Anomalies::text() const {
    std::string list;
    for (const Counter& c : kCounters) {
        const std::uint32_t n = this->*c.count;
        if (n == 0) continue;
        if (!list.empty()) list += ", ";
        list += std::to_string(n) + " " + (n == 1 ? c.one : c.many);
    }
    return list.empty() ? "none" : list;
}

}  // namespace gonio::driver
