#include "proc/radiance/frame_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/radiance/frames.h"

namespace gonio::proc {
namespace {

using test::perfectDarks;
using test::Shot;

std::vector<Shot> ladder() {
    std::vector<Shot> shots;
    for (double us : {20.0, 80.0, 320.0, 1280.0, 5120.0, 40000.0})
        shots.push_back({.seconds = us * 1e-6});
    shots.push_back({.seconds = 20e-6, .level = 3277});
    return shots;
}

/// Reports on the bracket of a lobe; the light of frame i is times `gain(i)`.
template <class Gain>
FrameReport reportOf(const std::vector<Shot>& shots,
                     Size size,
                     std::mt19937_64& random,
                     Gain gain,
                     const NominalUncertainty& nominal = {}) {
    const DarkLibrary darks = perfectDarks(shots, size);
    MergeAccumulator accumulator(Band::G, darks, {});
    for (std::size_t i = 0; i < shots.size(); ++i) {
        Frame frame = test::takeScene(test::lobe(size, 3e8 * gain(i)), shots[i], random);
        frame.number = static_cast<std::uint32_t>(40 + i);
        EXPECT_TRUE(accumulator.add(frame));
    }
    const auto state = mergeSums(accumulator.sums());
    EXPECT_TRUE(state);
    return frameResiduals(accumulator.sums(), *state, 0.01, nominal);
}

/// A rig that grants its exposures to 0.2 us, and dims its LEDs to 1 %.
const NominalUncertainty kWellKnown{.exposure = Seconds(0.2e-6), .dimmed = 0.01};

TEST(FrameResiduals, AStepOfFivePerCentIsFlagged) {
    std::mt19937_64 random(31);
    for (std::size_t first = 1; first < ladder().size(); ++first) {
        for (const double step : {1.05, 0.95}) {
            const FrameReport report = reportOf(
                ladder(),
                {96, 96},
                random,
                [&](std::size_t i) { return i >= first ? step : 1; },
                kWellKnown);
            ASSERT_TRUE(report.change) << first;
            EXPECT_EQ(report.change->first, first);
            EXPECT_EQ(report.change->last, ladder().size() - 1);
            // 5 % is found to 0.25 % of itself in second order.
            EXPECT_NEAR(report.change->offset.size, step - 1, 4 * report.change->offset.u + 0.004);
            EXPECT_GT(std::abs(report.change->offset.significance()), 5);
        }
    }
}

TEST(FrameResiduals, ASingleBrighterFrameIsNamed) {
    std::mt19937_64 random(32);
    const FrameReport report =
        reportOf(ladder(), {96, 96}, random, [](std::size_t i) { return i == 3 ? 1.05 : 1; });
    ASSERT_TRUE(report.change);
    EXPECT_EQ(report.change->first, 3U);
    EXPECT_EQ(report.change->last, 3U);
    EXPECT_EQ(report.frames[3].number, 43U);
    ASSERT_TRUE(report.frames[3].offset);
    EXPECT_NEAR(report.frames[3].offset->size, 0.05, 4 * report.frames[3].offset->u + 0.004);
    const FrameResidual& bad = report.frames[3];
    // Its own chi^2 stands out: one degree of freedom per witness pixel, sigma sqrt(2 / pixels).
    EXPECT_GT(bad.chiSquare / static_cast<double>(bad.freedom),
              1 + 5 * std::sqrt(2 / static_cast<double>(bad.freedom)));
}

TEST(FrameResiduals, NoFalseAlarmInAThousandCleanBrackets) {
    const bool nightly = std::getenv("GONIO_NIGHTLY") != nullptr;
    const Size size = nightly ? Size{64, 64} : Size{16, 16};
    const std::vector<Shot> shots{{.seconds = 20e-6},
                                  {.seconds = 160e-6},
                                  {.seconds = 1280e-6},
                                  {.seconds = 10240e-6},
                                  {.seconds = 20e-6, .level = 3277}};
    const DarkLibrary darks = perfectDarks(shots, size);
    const Image<double> light = test::lobe(size, 3e8);
    std::mt19937_64 random(33);
    int alarms = 0, beyond3 = 0, offsets = 0;
    double chiSquare = 0, freedom = 0;
    for (int bracket = 0; bracket < 1000; ++bracket) {
        MergeAccumulator accumulator(Band::G, darks, {});
        for (const Shot& shot : shots)
            ASSERT_TRUE(accumulator.add(test::takeScene(light, shot, random)));
        const auto state = mergeSums(accumulator.sums());
        ASSERT_TRUE(state);
        const FrameReport report = frameResiduals(accumulator.sums(), *state, 0);
        alarms += report.change ? 1 : 0;
        for (const FrameResidual& frame : report.frames) {
            chiSquare += frame.chiSquare;
            freedom += static_cast<double>(frame.freedom);
            if (!frame.offset) continue;
            ++offsets;
            beyond3 += std::abs(frame.offset->significance()) > 3 ? 1 : 0;
        }
    }
    EXPECT_EQ(alarms, 0);  // of any size
    // Uncertainties are honest: 0.27 % of a Gaussian are beyond 3, and no less than a third of it.
    EXPECT_LT(beyond3, 0.006 * offsets);
    EXPECT_GT(beyond3, 0.0009 * offsets);
    EXPECT_NEAR(chiSquare / freedom, 1, 0.01);
}

TEST(FrameResiduals, AConstantErrorOfAScaleIsNoStep) {
    std::mt19937_64 random(36);
    const auto first = [](std::size_t i) { return i == 0 ? 1.04 : 1; };
    EXPECT_TRUE(reportOf(ladder(), {96, 96}, random, first, kWellKnown).change);
    // 0.8 us more than 20: less than twice what the exposure may be off.
    const FrameReport report = reportOf(ladder(), {96, 96}, random, first);
    EXPECT_FALSE(report.change);
    ASSERT_TRUE(report.frames[0].offset);
    EXPECT_GT(report.frames[0].offset->significance(), 5) << "it is seen all the same";
}

TEST(FrameResiduals, AStepWithinAGroupIsNoErrorOfItsScale) {
    std::vector<Shot> shots;
    for (const double seconds : {20e-6, 320e-6})
        for (int i = 0; i < 8; ++i) shots.push_back({.seconds = seconds});
    std::mt19937_64 random(37);
    const FrameReport report =
        reportOf(shots, {96, 96}, random, [](std::size_t i) { return i >= 4 ? 1.03 : 1; });
    ASSERT_TRUE(report.change);
    EXPECT_EQ(report.change->first, 4U);
    EXPECT_GT(report.change->offset.size, 2 * report.change->uNominal);
}

TEST(FrameResiduals, TheNoiseOfADarkFrameIsNoStep) {
    // All frames of an exposure share one dark frame of the same noise as theirs: as if it were of
    // each frame's own, the difference of two groups of 8 would be thought 2.1 times as certain.
    constexpr Size kSize{16, 16};
    const Image<double> light = test::lobe(kSize, 3e3);
    const NominalUncertainty exact{.exposure = Seconds(0), .relative = 1e-9, .dimmed = 0};
    std::mt19937_64 random(38);
    int alarms = 0;
    double chiSquare = 0, freedom = 0;
    for (int bracket = 0; bracket < 400; ++bracket) {
        DarkLibrary darks;
        for (const double seconds : {1e-3, 2e-3}) {
            const Frame dark = test::take({.seconds = seconds, .level = 0}, kSize, random);
            auto mean = averageDark({&dark, 1}, {});
            ASSERT_TRUE(mean) << mean.error().message;
            mean->hot.clear();
            darks.add(std::move(*mean));
        }
        MergeAccumulator accumulator(Band::G, darks, {});
        for (const double seconds : {1e-3, 2e-3})
            for (int i = 0; i < 8; ++i)
                ASSERT_TRUE(accumulator.add(test::takeScene(light, {.seconds = seconds}, random)));
        const auto state = mergeSums(accumulator.sums());
        ASSERT_TRUE(state);
        const FrameReport report = frameResiduals(accumulator.sums(), *state, 0, exact);
        alarms += report.change ? 1 : 0;
        for (const FrameResidual& frame : report.frames) {
            chiSquare += frame.chiSquare;
            freedom += static_cast<double>(frame.freedom);
        }
    }
    EXPECT_EQ(alarms, 0);
    // The light of a pixel is its own, and none below 0: 6 % too much shot noise is thought of
    // here.
    EXPECT_NEAR(chiSquare / freedom, 1, 0.08);
}

TEST(FrameResiduals, AWanderingZeroIsNoStep) {
    // The first frame sees an electron of light in each pixel, and 0.15 that are none.
    std::vector<Shot> shots{{.seconds = 20e-6, .level = 1640}};
    for (const double seconds : {20e-6, 320e-6, 2e-3}) shots.push_back({.seconds = seconds});
    const Size size{256, 256};
    const DarkLibrary darks = perfectDarks(shots, size);
    const Image<double> light(size, 2e6);
    const auto reportWith = [&](const NominalUncertainty& nominal) {
        std::mt19937_64 random(39);
        MergeAccumulator accumulator(Band::G, darks, {});
        for (std::size_t i = 0; i < shots.size(); ++i) {
            Image<double> seen = light;
            if (i == 0)
                for (double& pixel : seen.pixels()) pixel += 0.3e6;
            EXPECT_TRUE(accumulator.add(test::takeScene(seen, shots[i], random)));
        }
        const auto state = mergeSums(accumulator.sums());
        EXPECT_TRUE(state);
        return frameResiduals(accumulator.sums(), *state, 0.03, nominal);
    };
    EXPECT_FALSE(reportWith({}).change);
    EXPECT_TRUE(reportWith({.zero = 0}).change);
}

/// As a rig sends it that bins 4 x 4 pixels: each the mean of 16, rounded a second time.
Frame binnedByFour(const Frame& fine) {
    constexpr int kBinning = 4;
    Frame frame = fine;
    const Size size = fine.pixels.size();
    frame.pixels = Image<std::uint16_t>({size.width / kBinning, size.height / kBinning});
    frame.window.binning = kBinning;
    for (int y = 0; y < frame.pixels.height(); ++y) {
        for (int x = 0; x < frame.pixels.width(); ++x) {
            double sum = 0;
            for (int j = 0; j < kBinning; ++j)
                for (int i = 0; i < kBinning; ++i)
                    sum += fine.pixels.at(kBinning * x + i, kBinning * y + j);
            frame.pixels.at(x, y) =
                static_cast<std::uint16_t>(std::lround(sum / (kBinning * kBinning)));
        }
    }
    return frame;
}

// The noise of 16 pixels' mean is a quarter of a DN: a light of 0.3 DN is mostly rounded away, in
// each pixel alike, and one of 3 DN is known to 5 %.
TEST(FrameResiduals, RoundingOfBinnedPixelsIsNoStep) {
    const std::vector<Shot> shots{{.seconds = 20e-6}, {.seconds = 200e-6}, {.seconds = 2e-3}};
    const Size fine{512, 512}, size{128, 128};
    const Image<double> light(fine, 0.3 * 2.6 / 20e-6);
    for (const double step : {1.0, 1.2}) {
        std::mt19937_64 random(43);
        DarkLibrary darks;
        for (const Shot& shot : shots) {
            const Frame frame = binnedByFour(test::unexposed(shot, fine));
            darks.add({.mean = Image<float>(size, static_cast<float>(test::kBlackDn)),
                       .exposure = frame.exposure,
                       .window = frame.window,
                       .frames = 1});
        }
        MergeAccumulator accumulator(Band::G, darks, {});
        for (const Shot& shot : shots) {
            Image<double> seen = light;
            for (double& pixel : seen.pixels()) pixel *= &shot == &shots.back() ? step : 1;
            EXPECT_TRUE(accumulator.add(binnedByFour(test::takeScene(seen, shot, random))));
        }
        const auto state = mergeSums(accumulator.sums());
        ASSERT_TRUE(state);
        const FrameReport report = frameResiduals(accumulator.sums(), *state, 0.03);
        ASSERT_EQ(report.change.has_value(), step > 1) << step;
        if (report.change) {
            EXPECT_EQ(report.change->first, 2U);
        }
    }
}

TEST(FrameResiduals, OneFrameSaysNothing) {
    std::mt19937_64 random(34);
    const FrameReport report =
        reportOf({{.seconds = 1e-3}}, {40, 40}, random, [](std::size_t) { return 1; });
    ASSERT_EQ(report.frames.size(), 1U);
    EXPECT_FALSE(report.frames[0].offset);
    EXPECT_EQ(report.frames[0].freedom, 0U);
    EXPECT_FALSE(report.change);
}

TEST(FrameResiduals, ASampleThatMovedRaisesItsFramesChiSquare) {
    const Size size{96, 96};
    const std::vector<Shot> shots{{.seconds = 20e-6}, {.seconds = 25e-6}, {.seconds = 30e-6}};
    const DarkLibrary darks = perfectDarks(shots, size);
    std::mt19937_64 random(35);
    MergeAccumulator accumulator(Band::G, darks, {});
    const Image<double> light = test::lobe(size, 2e8);
    Image<double> moved(size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) moved.at(x, y) = light.at(std::max(0, x - 3), y);
    for (std::size_t i = 0; i < 3; ++i)
        ASSERT_TRUE(accumulator.add(test::takeScene(i == 1 ? moved : light, shots[i], random)));
    const auto state = mergeSums(accumulator.sums());
    ASSERT_TRUE(state);
    const FrameReport report = frameResiduals(accumulator.sums(), *state);
    const auto relative = [&](std::size_t i) {
        return report.frames[i].chiSquare / static_cast<double>(report.frames[i].freedom);
    };
    EXPECT_GT(relative(1), 1.5 * relative(0));
    EXPECT_GT(relative(1), 1.5 * relative(2));
    EXPECT_GT(relative(1), 2);
}

}  // namespace
}  // namespace gonio::proc
