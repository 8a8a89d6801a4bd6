#include "proc/table/rotations.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

constexpr Radians kSame = 0.01_deg;
constexpr Radians kSameLed = 0.5_deg;

}  // namespace

Radians rotationOf(double degrees) {
    double turn = std::fmod(std::round(degrees * 1e9) / 1e9, 360);
    if (turn < 0) turn = std::round((turn + 360) * 1e9) / 1e9;
    if (turn >= 360) turn = 0;
    return turn == 0 ? Radians() : Radians::fromDegrees(turn);  // never -0
}

bool sameRotation(Radians a, Radians b) {
    return std::abs(std::remainder((a - b).value(), 2 * kPi)) <= kSame.value();
}

bool sameIncidence(Radians a, Radians b) { return std::abs((a - b).value()) <= kSameLed.value(); }

bool sameLight(const LedTable& a, const LedTable& b) {
    return sameIncidence(a.incidence, b.incidence) && sameRotation(a.rotation, b.rotation);
}

std::vector<Radians> rotationsOf(const SampleSet& set) {
    std::vector<Radians> all;
    for (const LedTable& led : set.leds) {
        const bool known = std::any_of(
            all.begin(), all.end(), [&](Radians r) { return sameRotation(r, led.rotation); });
        if (!known) all.push_back(led.rotation);
    }
    std::sort(all.begin(), all.end());
    return all;
}

void turnTo(SampleSet& set, Radians rotation) {
    for (LedTable& led : set.leds) led.rotation = rotation;
}

SampleSet unturned(SampleSet set) {
    turnTo(set, Radians());
    return set;
}

void sortTables(SampleSet& set) {
    std::stable_sort(set.leds.begin(), set.leds.end(), [](const LedTable& a, const LedTable& b) {
        return a.rotation == b.rotation ? a.incidence < b.incidence : a.rotation < b.rotation;
    });
}

}  // namespace gonio::proc
