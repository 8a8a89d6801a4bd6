#include "proc/table/neighbour_study.h"

#include <array>
#include <cmath>
#include <random>

#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr std::array<double, 4> kIncidencesDeg{0, 20, 40, 60};
constexpr double kJitterDeg = 10;
constexpr int kSeenRows = 75;
constexpr std::size_t kFewestQueries = 8;
constexpr std::size_t kQueries = 4096;  ///< different ones, asked in turn

/// Uniform in [0, 1), the same on every machine (the library's distributions need not be).
double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

std::size_t seenCells() {
    std::size_t cells = 0;
    for (int row = 0; row < kSeenRows; ++row) {
        cells += static_cast<std::size_t>(CellGrid::sectors(row));
    }
    return cells;
}

LightView rigLikePair(std::mt19937_64& random) {
    static const std::size_t cells = seenCells();
    const auto led = static_cast<std::size_t>(unit(random) * kIncidencesDeg.size());
    const double jitterDeg = kJitterDeg * (2 * unit(random) - 1);
    const auto cell = static_cast<std::size_t>(unit(random) * static_cast<double>(cells));
    const CellBounds bounds = CellGrid::bounds(cell);
    const auto within = [&](Radians low, Radians high) {
        return low + (high - low) * unit(random);
    };
    const Radians theta = within(bounds.thetaLow, bounds.thetaHigh);
    const Radians phi = within(bounds.phiLow, bounds.phiHigh);
    // Of a negative angle of incidence the light stands on the other side.
    return {.in = Direction::fromSpherical(
                Radians::fromDegrees(std::abs(kIncidencesDeg[led] + jitterDeg)), Radians(0)),
            .out = Direction::fromSpherical(theta, phi)};
}

std::vector<LightView> rigLikePairs(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<LightView> pairs;
    pairs.reserve(count);
    for (std::size_t i = 0; i < count; ++i) pairs.push_back(rigLikePair(random));
    return pairs;
}

/// Calls `ask` with 0, 1, 2 .. until `each` has passed; the time of one call. The watch is read
/// once for as many calls as double each time, so that its own time does not count.
template <class Ask>
Seconds timeOfOne(const Stopwatch& watch, Seconds each, const Ask& ask) {
    const Seconds start = watch.elapsed();
    std::size_t asked = 0;
    for (std::size_t until = kFewestQueries;; until *= 2) {
        while (asked < until) ask(asked++);
        const Seconds spent = watch.elapsed() - start;
        if (spent >= each) return spent / static_cast<double>(asked);
    }
}

template <class Time>
Seconds medianOf(int repeats, const Time& time) {
    std::vector<double> seconds;
    for (int i = 0; i < repeats; ++i) seconds.push_back(time().count());
    return Seconds(median(seconds));
}

NeighbourCost costOf(const Stopwatch& watch,
                     const NeighbourStudyOptions& options,
                     std::size_t count) {
    const std::vector<ScatteredSample> samples = rigLikeSamples(count, options.seed);
    const std::vector<LightView> queries = rigLikePairs(kQueries, options.seed + 1);
    const NeighbourQuery query{.count = options.neighbours};
    NeighbourCost cost{.samples = count};
    ScatteredSet set(options.symmetry);
    cost.build = medianOf(options.repeats, [&] {
        set = ScatteredSet(options.symmetry);
        const Seconds start = watch.elapsed();
        (void)set.add(samples);
        return watch.elapsed() - start;
    });
    std::size_t found = 0;  // keeps the work from being left out
    const auto timed = [&](const auto& nearest) {
        return medianOf(options.repeats, [&] {
            return timeOfOne(watch, options.each, [&](std::size_t i) {
                found += nearest(queries[i % kQueries]).size();
            });
        });
    };
    cost.query = timed([&](const LightView& at) { return set.nearest(at, query); });
    cost.bruteForce =
        timed([&](const LightView& at) { return set.nearestByBruteForce(at, query); });
    cost.treeBytes = set.treeBytes();
    cost.sampleBytes = set.sampleBytes();
    return found > 0 ? cost : NeighbourCost{.samples = count};
}

}  // namespace

std::vector<ScatteredSample> rigLikeSamples(std::size_t count, std::uint64_t seed) {
    std::vector<ScatteredSample> samples;
    samples.reserve(count);
    for (const LightView& pair : rigLikePairs(count, seed)) {
        samples.push_back(
            {.pair = pair, .f = LedBands::all(1 / kPi), .uRandom = {}, .uSystematic = {}});
    }
    return samples;
}

std::vector<NeighbourCost> studyNeighbours(const Stopwatch& watch,
                                           const NeighbourStudyOptions& options,
                                           const NeighbourProgress& progress) {
    std::vector<NeighbourCost> rows;
    for (const std::size_t count : options.sizes) {
        rows.push_back(costOf(watch, options, count));
        if (progress) {
            progress(static_cast<double>(rows.size()) / static_cast<double>(options.sizes.size()));
        }
    }
    return rows;
}

double growthOf(const std::vector<NeighbourCost>& rows, const NeighbourValue& value) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const NeighbourCost& row : rows) {
        const double x = std::log(static_cast<double>(row.samples));
        const double y = std::log(value(row));
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const auto n = static_cast<double>(rows.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

std::string neighbourCsv(const std::vector<NeighbourCost>& rows) {
    std::string text =
        "samples,build_seconds,query_seconds,brute_force_seconds,tree_bytes,sample_bytes\n";
    for (const NeighbourCost& row : rows) {
        text += std::to_string(row.samples) + "," + shortest(row.build.count()) + "," +
                shortest(row.query.count()) + "," + shortest(row.bruteForce.count()) + "," +
                std::to_string(row.treeBytes) + "," + std::to_string(row.sampleBytes) + "\n";
    }
    return text;
}

}  // namespace gonio::proc
