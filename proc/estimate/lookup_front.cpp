#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/number_text.h"
#include "proc/estimate/lookup_study.h"

namespace gonio::proc {
namespace {

constexpr double kSameTime = 1.1;

/// Of the same material.
bool beats(const LookupRow& one, const LookupRow& other) {
    if (one.material != other.material) return false;
    const bool noWorse = one.worst() <= other.worst() && one.bytes <= other.bytes &&
                         one.scalarNs <= kSameTime * other.scalarNs;
    // Equal ones stand beside each other: something must be better by more than a tie of times.
    return noWorse && (one.worst() < other.worst() || one.bytes < other.bytes ||
                       one.scalarNs * kSameTime < other.scalarNs);
}

struct LogRange {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void hold(double value) {
        low = std::min(low, std::log(value));
        high = std::max(high, std::log(value));
    }
    [[nodiscard]] double share(double value) const {
        return high > low ? (std::log(value) - low) / (high - low) : 0;
    }
};

/// `front` is not empty.
LookupRow* kneeOf(const std::vector<LookupRow*>& front) {
    LogRange error, bytes;
    for (const LookupRow* row : front) {
        error.hold(row->worst());
        bytes.hold(static_cast<double>(row->bytes));
    }
    const auto cost = [&](const LookupRow* row) {
        return error.share(row->worst()) + bytes.share(static_cast<double>(row->bytes));
    };
    return *std::min_element(front.begin(), front.end(), [&](const auto* a, const auto* b) {
        return cost(a) < cost(b);
    });
}

std::string nanoseconds(double value) { return std::isnan(value) ? "" : fixed(value, 1); }

}  // namespace

void markFront(std::span<LookupRow> rows) {
    for (LookupRow& row : rows) {
        row.knee = false;
        row.onFront = std::none_of(
            rows.begin(), rows.end(), [&](const LookupRow& other) { return beats(other, row); });
    }
    for (const LookupRow& first : rows) {
        std::vector<LookupRow*> front;
        bool done = false;
        for (LookupRow& row : rows) {
            if (row.material != first.material) continue;
            done = done || row.knee;
            if (row.onFront) front.push_back(&row);
        }
        if (!done && !front.empty()) kneeOf(front)->knee = true;
    }
}

std::string markdown(std::span<const LookupRow> rows) {
    std::string text =
        "| material | method | nodes | storage | KiB | worst % | p99 % | mean % | lobe worst % | "
        "lobe p99 % | ns one | ns in arrays | ns draw | front |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const LookupRow& row : rows) {
        text += "| " + row.material + " | " + row.method + " | " + row.resolution + " | " +
                row.storage + " | " + fixed(static_cast<double>(row.bytes) / 1024, 0) + " | " +
                fixed(100 * row.cosine.worst, 2) + " | " + fixed(100 * row.cosine.p99, 3) + " | " +
                fixed(100 * row.cosine.mean, 4) + " | " + fixed(100 * row.lobe.worst, 2) + " | " +
                fixed(100 * row.lobe.p99, 3) + " | " + nanoseconds(row.scalarNs) + " | " +
                nanoseconds(row.batchNs) + " | " + nanoseconds(row.drawNs) + " | " +
                (row.knee      ? "knee"
                 : row.onFront ? "yes"
                               : "") +
                " |\n";
    }
    return text;
}

}  // namespace gonio::proc
