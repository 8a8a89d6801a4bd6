#include "proc/radiance/group_scales.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

using test::perfectDarks;
using test::Shot;

constexpr Size kSize{160, 160};

/// What the rig says it did, and what it really did.
struct Truth {
    double offsetSeconds = 0;  ///< more than granted
    double dimmed = 1;         ///< light of the dimmed level against nominal
};

std::vector<Shot> ladder() {
    std::vector<Shot> shots;
    for (double us : {20.0, 80.0, 320.0, 1280.0, 5120.0, 40000.0})
        shots.push_back({.seconds = us * 1e-6});
    shots.push_back({.seconds = 20e-6, .level = 3277});
    return shots;
}

Frame lying(const Image<double>& light, const Shot& said, const Truth& truth, std::mt19937_64& r) {
    Shot real = said;
    real.seconds += truth.offsetSeconds;
    Image<double> seen = light;
    if (said.level < 65535)
        for (double& x : seen.pixels()) x *= truth.dimmed;
    Frame frame = test::takeScene(seen, real, r);
    frame.exposure.granted = Nanoseconds(std::llround(said.seconds * 1e9));
    return frame;
}

MergeAccumulator accumulated(const Truth& truth,
                             const DarkLibrary& darks,
                             std::mt19937_64& random,
                             double peak = 3e8) {
    MergeAccumulator accumulator(Band::G, darks, {});
    const Image<double> light = test::lobe(kSize, peak);
    for (const Shot& shot : ladder())
        EXPECT_TRUE(accumulator.add(lying(light, shot, truth, random)));
    return accumulator;
}

ScaleReport reportOf(const MergeAccumulator& accumulator) {
    const auto state = mergeSums(accumulator.sums());
    EXPECT_TRUE(state);
    return groupScales(accumulator.sums(), *state);
}

const GroupScale& scaleOf(const ScaleReport& report, double us, std::uint16_t level) {
    for (const GroupScale& scale : report.groups)
        if (scale.granted == Nanoseconds(std::llround(us * 1000)) && scale.level == level)
            return scale;
    ADD_FAILURE() << "no group of " << us << " us";
    return report.groups.front();
}

/// Mean over the pixels of a border around the peak, where only the shortest exposures are not
/// saturated, of the relative error.
double errorAtThePeak(const MergedState& state, double peak) {
    const Image<double> light = test::lobe(kSize, peak);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < light.pixels().size(); ++i) {
        if (light.pixels()[i] < 0.5 * peak) continue;
        sum += static_cast<double>(state.radiance.pixels()[i]) / light.pixels()[i] - 1;
        ++count;
    }
    return sum / count;
}

TEST(GroupScales, NominalScalesStayWhereTheyAre) {
    const DarkLibrary darks = perfectDarks(ladder(), kSize);
    std::mt19937_64 random(2);
    const ScaleReport report = reportOf(accumulated({}, darks, random));
    ASSERT_EQ(report.groups.size(), 7U);
    for (const GroupScale& scale : report.groups) {
        EXPECT_LT(std::abs(scale.offset.size), 4 * scale.offset.u) << scale.granted.count();
        EXPECT_LE(scale.offset.u, scale.uNominal);
    }
    EXPECT_EQ(report.ratios.size(), 6U);
    for (const RatioResidual& ratio : report.ratios)
        EXPECT_LT(std::abs(ratio.offset.significance()), 4.5) << ratio.from << ' ' << ratio.to;
}

TEST(GroupScales, FifthOfAMicrosecondIsFoundAndRemoved) {
    // 1 % at 20 us, 0.25 % at 80 us.
    const DarkLibrary darks = perfectDarks(ladder(), kSize);
    std::mt19937_64 random(3);
    constexpr double kPeak = 3e8;
    MergeAccumulator accumulator = accumulated({.offsetSeconds = 0.2e-6}, darks, random, kPeak);
    const ScaleReport report = reportOf(accumulator);
    for (const double us : {20.0, 80.0, 320.0}) {
        const GroupScale& scale = scaleOf(report, us, 65535);
        EXPECT_NEAR(scale.offset.size, 0.2 / us, 4 * scale.offset.u) << us;
        EXPECT_LT(scale.offset.u, 0.1 * 0.2 / 20) << us;
    }
    EXPECT_GT(scaleOf(report, 20, 65535).offset.significance(), 10);
    const double before = errorAtThePeak(*mergeSums(accumulator.sums()), kPeak);
    correctScales(accumulator, report);
    const double after = errorAtThePeak(*mergeSums(accumulator.sums()), kPeak);
    // 330 pixels of 3000 to 6000 electrons: 0.08 %, the same before and after.
    EXPECT_NEAR(before, 0.01, 4 * 0.0008);
    EXPECT_LT(std::abs(after), 4 * 0.0008);
    EXPECT_NEAR(before - after, 0.01, 4 * scaleOf(report, 20, 65535).offset.u);
    // Corrected, nothing is left to be found.
    for (const GroupScale& scale : reportOf(accumulator).groups)
        EXPECT_LT(std::abs(scale.offset.size), 3e-4 + 0.5 * scale.uNominal * (scale.level < 65535));
}

TEST(GroupScales, ALevelThatIsNotProportionalIsFound) {
    const DarkLibrary darks = perfectDarks(ladder(), kSize);
    std::mt19937_64 random(4);
    MergeAccumulator accumulator = accumulated({.dimmed = 1.03}, darks, random);
    const ScaleReport report = reportOf(accumulator);
    const GroupScale& dim = scaleOf(report, 20, 3277);
    EXPECT_NEAR(dim.offset.size, 0.03, 4 * dim.offset.u + 0.03 * 0.03);
    EXPECT_LT(dim.offset.u, 0.005);
    EXPECT_LT(std::abs(scaleOf(report, 20, 65535).offset.size), 0.001);
}

TEST(GroupScales, WithoutCommonPixelsTheNominalUncertaintyStays) {
    // Flat light that is dark at 20 us and saturated at 40 ms: no pixel is usable in both.
    const std::vector<Shot> shots{{.seconds = 20e-6}, {.seconds = 40e-3}};
    const DarkLibrary darks = perfectDarks(shots, kSize);
    MergeAccumulator accumulator(Band::G, darks, {});
    std::mt19937_64 random(5);
    const Image<double> light(kSize, 1e7);
    for (const Shot& shot : shots)
        ASSERT_TRUE(accumulator.add(test::takeScene(light, shot, random)));
    const ScaleReport report = reportOf(accumulator);
    EXPECT_TRUE(report.ratios.empty());
    for (const GroupScale& scale : report.groups) {
        EXPECT_EQ(scale.offset.size, 0);
        EXPECT_NEAR(scale.offset.u / scale.uNominal, 1, 1e-9);
    }
}

TEST(GroupScales, RatiosSayWhatTheirPixelsSay) {
    const DarkLibrary darks = perfectDarks(ladder(), kSize);
    std::mt19937_64 random(6);
    const MergeAccumulator accumulator = accumulated({.offsetSeconds = 0.2e-6}, darks, random);
    const ScaleReport report = reportOf(accumulator);
    for (const RatioResidual& ratio : report.ratios) {
        const GroupSums& from = accumulator.sums().groups[ratio.from];
        const GroupSums& to = accumulator.sums().groups[ratio.to];
        EXPECT_LT(from.tau, to.tau);
        const double truth = (1 + 0.2e-6 / to.seconds) / (1 + 0.2e-6 / from.seconds) - 1;
        EXPECT_NEAR(ratio.offset.size, truth, 4.5 * ratio.offset.u + 1e-4);
    }
}

}  // namespace
}  // namespace gonio::proc
