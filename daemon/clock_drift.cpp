#include "daemon/clock_drift.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

namespace gonio::daemon {
namespace {

constexpr std::size_t kMostReadings = 32, kFewestReadings = 4;  // of one look
constexpr double kLookTime = 0.3;                               // s, for more than the fewest
constexpr double kTick = 1e-6;                                  // s, of the rig's clock
constexpr double kApart = 1;                                    // s, between two looks
constexpr double kLongest = 6;                                  // s, to the last look's begin
constexpr std::size_t kMostLooks = 6;
constexpr auto kPause = std::chrono::milliseconds(100);
// Student's t, 95 % two-sided, of 1 to 4 degrees of freedom.
constexpr std::array kStudent{12.706, 4.303, 3.182, 2.776};

double hostNow(const driver::RigLink& link) {
    return std::chrono::duration<double>(link.clock().now()).count();
}

/// No look yet: one pair of times, without an uncertainty.
Result<ClockLook> readOnce(driver::RigLink& link) {
    const double before = hostNow(link);
    const auto answer = link.command(driver::Op::SyncTime,
                                     driver::encodeU64(static_cast<std::uint64_t>(before * 1e6)));
    if (!answer) return answer.error();
    const double after = hostNow(link);
    const double host = (before + after) / 2;
    return ClockLook{.host = host,
                     .offset = static_cast<double>(driver::decodeU64(*answer)) * 1e-6 - host,
                     .furthest = (after - before) / 2 + kTick,
                     .roundTrip = after - before};
}

/// At `then` (s, the host's), or at once where that has passed.
Result<ClockLook> lookAt(double then, driver::RigLink& link) {
    for (double left = then - hostNow(link); left > 0; left = then - hostNow(link)) {
        const auto pause = std::min<Nanoseconds>(kPause, Nanoseconds(std::llround(left * 1e9) + 1));
        if (auto waited = link.readBulk(pause); !waited) return waited.error();
    }
    return lookAtClock(link);
}

/// Times the spread of the looks' times: how steep a line is through looks of no drift, where the
/// round trip changes between any two of them as it does in these, and all of that on one way.
double slopeOfAShift(std::span<const ClockLook> looks) {
    double middle = 0;
    for (const ClockLook& look : looks) {
        middle += (look.host - looks.front().host) / static_cast<double>(looks.size());
    }
    double behind = 0, most = 0;
    for (const ClockLook& look : looks) {
        behind += look.host - looks.front().host - middle;
        most = std::max(most, std::abs(behind));
    }
    const auto [quickest, slowest] = std::ranges::minmax_element(looks, {}, &ClockLook::furthest);
    return most * (slowest->furthest - quickest->furthest);
}

}  // namespace

Result<ClockLook> lookAtClock(driver::RigLink& link) {
    std::vector<ClockLook> readings;
    const double end = hostNow(link) + kLookTime;
    while (readings.size() < kMostReadings &&
           (readings.size() < kFewestReadings || hostNow(link) < end)) {
        const Result<ClockLook> one = readOnce(link);
        if (!one) return one.error();
        readings.push_back(*one);
    }
    std::sort(readings.begin(), readings.end(), [](const auto& a, const auto& b) {
        return a.roundTrip < b.roundTrip;
    });
    ClockLook mean{.roundTrip = readings.front().roundTrip};
    for (const ClockLook& one : readings)
        mean.usual += one.roundTrip / static_cast<double>(readings.size());
    while (readings.back().roundTrip > 2 * mean.roundTrip) readings.pop_back();
    double n = 0, squares = 0;
    for (const ClockLook& one : readings) {
        n += 1;
        mean.host += (one.host - mean.host) / n;
        mean.offset += (one.offset - mean.offset) / n;
        mean.furthest += (one.furthest - mean.furthest) / n;
    }
    for (const ClockLook& one : readings) squares += std::pow(one.offset - mean.offset, 2);
    // Two or three have no scatter to speak of.
    mean.uncertainty = readings.size() < kFewestReadings ? mean.furthest
                                                         : std::sqrt(squares / (n - 1) / n) + kTick;
    return mean;
}

bool ClockDrift::beyondCrystals() const {
    return std::abs(relative) - uncertainty > kMostCrystalsDiffer;
}

ClockDrift driftOf(std::span<const ClockLook> looks) {
    const ClockLook& first = looks.front();  // offsets are large, and differ by little
    double n = 0, host = 0, offset = 0;
    for (const ClockLook& look : looks) {
        n += 1;
        host += (look.host - first.host - host) / n;
        offset += (look.offset - first.offset - offset) / n;
    }
    double spread = 0, slope = 0, scatter = 0, residuals = 0;
    for (const ClockLook& look : looks) {
        const double from = look.host - first.host - host;
        spread += from * from;
        slope += from * (look.offset - first.offset - offset);
        scatter += std::pow(from * look.uncertainty, 2);
    }
    slope /= spread;
    for (const ClockLook& look : looks) {
        const double line = offset + slope * (look.host - first.host - host);
        residuals += std::pow(look.offset - first.offset - line, 2);
    }
    double uncertainty = 2 * std::sqrt(scatter) / spread;
    if (looks.size() > 2) {
        const double student = kStudent[std::min(looks.size() - 2, kStudent.size()) - 1];
        const double byResiduals = student * std::sqrt(residuals / (n - 2) / spread);
        uncertainty = std::max({uncertainty, byResiduals, slopeOfAShift(looks) / spread});
    }
    const auto slowest = std::ranges::max_element(looks, {}, &ClockLook::roundTrip);
    return {.relative = slope,
            .uncertainty = uncertainty,
            .passed = looks.back().host - first.host,
            .roundTrip = slowest->roundTrip};
}

Result<ClockDrift> driftSince(const ClockLook& first, driver::RigLink& link) {
    std::vector<ClockLook> looks{first};
    while (true) {
        const Result<ClockLook> next = lookAt(looks.back().host + kApart, link);
        if (!next) return next.error();
        looks.push_back(*next);
        ClockDrift drift = driftOf(looks);
        const bool onlyTwo = looks.size() == 2;
        if (looks.size() == kMostLooks || (onlyTwo && !drift.beyondCrystals())) return drift;
        const double again = std::max(next->host + kApart, hostNow(link));
        if (again <= first.host + kLongest && drift.roundTrip <= kSlowRoundTrip) continue;
        if (onlyTwo) drift.uncertainty = (first.furthest + next->furthest) / drift.passed;
        return drift;
    }
}

}  // namespace gonio::daemon
