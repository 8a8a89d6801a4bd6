#include "proc/quality/reciprocity.h"

#include <cmath>

#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"
#include "proc/table/sample_lookup.h"

namespace gonio::proc {
namespace {

constexpr double kAboveNoise = 5;

Direction at(Radians theta, bool opposite) {
    return Direction::fromSpherical(theta, Radians(opposite ? kPi : 0));
}

std::optional<ReciprocalPair> pairOf(const Answer& there, const Answer& back, Band band) {
    const double a = there.f[band], b = back.f[band];
    const auto ua = there.u(band), ub = back.u(band);
    if (!std::isfinite(a) || !std::isfinite(b) || !ua || !ub) return std::nullopt;
    if (!(a > kAboveNoise * (*there.uRandom)[band])) return std::nullopt;
    if (!(b > kAboveNoise * (*back.uRandom)[band])) return std::nullopt;
    const double u = 2 * std::hypot(*ua, *ub) / (a + b);
    if (!(u > 0)) return std::nullopt;
    return ReciprocalPair{.band = band, .difference = 2 * (a - b) / (a + b), .u = u};
}

double chiSquarePerPair(const std::vector<ReciprocalPair>& pairs) {
    double sum = 0;
    for (const ReciprocalPair& pair : pairs) sum += std::pow(pair.difference / pair.u, 2);
    return sum / static_cast<double>(pairs.size());
}

/// The median size, and the median uncertainty of one: what they have in common does not average.
Figure medianDifference(const std::vector<ReciprocalPair>& pairs) {
    std::vector<double> sizes, us;
    for (const ReciprocalPair& pair : pairs) {
        sizes.push_back(std::abs(pair.difference));
        us.push_back(pair.u);
    }
    return {.value = median(std::move(sizes)), .u = median(std::move(us)), .unit = "1"};
}

}  // namespace

std::vector<ReciprocalPair> reciprocalPairs(const SampleSet& sample) {
    const std::vector<Radians> rotations = rotationsOf(sample);
    if (rotations.size() > 1) {
        std::vector<ReciprocalPair> all;
        for (const Radians rotation : rotations) {
            const auto part = reciprocalPairs(tablesAt(sample, rotation));
            all.insert(all.end(), part.begin(), part.end());
        }
        return all;
    }
    const SampleLookup lookup(sample);
    const std::vector<LedTable>& leds = lookup.set().leds;
    std::vector<ReciprocalPair> pairs;
    for (std::size_t i = 0; i < leds.size(); ++i) {
        for (std::size_t j = i + 1; j < leds.size(); ++j) {
            for (const bool mirrored : {false, true}) {
                const Radians first = leds[i].incidence, second = leds[j].incidence;
                const Answer there = lookup.answer({at(first, false), at(second, mirrored)});
                const Answer back = lookup.answer({at(second, false), at(first, mirrored)});
                if (!there.present() || !back.present()) continue;
                for (const Band band : kBands) {
                    if (auto pair = pairOf(there, back, band)) {
                        pair->led = i;
                        pair->other = j;
                        pair->mirrored = mirrored;
                        pairs.push_back(*pair);
                    }
                }
            }
        }
    }
    return pairs;
}

Verdict reciprocityVerdict(const SampleSet& sample, const QualityLimits& limits) {
    const std::vector<ReciprocalPair> pairs = reciprocalPairs(sample);
    Verdict verdict{.name = "reciprocity", .figure = {}, .evidence = {}, .next = {}};
    if (pairs.empty()) {
        verdict.evidence = "no two LEDs saw each other's direction above the noise";
        return verdict;
    }
    verdict.figure = medianDifference(pairs);
    const double chiSquare = chiSquarePerPair(pairs);
    verdict.grade = graded(*verdict.figure, limits.reciprocity);
    if (chiSquare < limits.reciprocityChiSquare) verdict.grade = Grade::Ok;
    const std::string what = std::to_string(pairs.size()) +
                             " pairs of directions, measured both ways, differ by " +
                             amount(verdict.figure->value, "1") +
                             " in the median, chi-square per pair " + fixed(chiSquare, 1);
    verdict.evidence = what;
    if (verdict.grade != Grade::Ok) {
        verdict.evidence = "f is not reciprocal: " + what;
        verdict.next =
            "see that the sample lies still, is alike all over, and not brushed or woven in one "
            "direction";
    }
    return verdict;
}

}  // namespace gonio::proc
