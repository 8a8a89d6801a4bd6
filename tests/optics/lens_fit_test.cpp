#include "proc/optics/lens_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/optics/mirror.h"
#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

constexpr SensorPoint kMiddle{640, 512};
constexpr double kSigma = 0.03;  // pixels

std::vector<MirrorSpot> spotsOf(const LensMap& map, std::span<const Wedge> wedges, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, kSigma);
    std::vector<MirrorSpot> spots;
    for (const Wedge& wedge : wedges) {
        for (const Radians led : {0_deg, 20_deg, 40_deg, 60_deg}) {
            const Direction seen = mirroredBy(wedge, Direction::fromSpherical(led, 0_deg));
            const SensorPoint at = map.pointOf(seen);
            spots.push_back({seen, {at.x + noise(random), at.y + noise(random)}, kSigma});
        }
    }
    return spots;
}

TEST(LensFit, FindsACrookedLensOverItsWholeField) {
    const LensMap truth = test::crookedLens();
    const auto fit = fitLens(spotsOf(truth, mirrorWedges(), 1), kMiddle, 6.6);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LT(fit->rmsPixels, 2 * kSigma);
    for (double theta = 5; theta <= 75; theta += 5) {
        for (double phi = 0; phi < 360; phi += 15) {
            const Direction wo =
                Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
            const auto seen = fit->map.directionAt(truth.pointOf(wo));
            ASSERT_TRUE(seen);
            EXPECT_LT(angleBetween({wo, *seen}).degrees(), 0.06) << theta << " " << phi;
        }
    }
}

TEST(LensFit, KnowsHowWrongItMayBe) {
    // Over many fits, the normalised error of a direction has unit variance per axis.
    const LensMap truth = test::crookedLens();
    for (const auto& [theta, phi] : {std::pair{10.0, 30.0}, {50.0, 180.0}, {70.0, 90.0}}) {
        const Direction wo =
            Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
        double sum = 0;
        constexpr int kFits = 150;
        for (unsigned seed = 0; seed < kFits; ++seed) {
            const auto fit = fitLens(spotsOf(truth, mirrorWedges(), 100 + seed), kMiddle, 6.6);
            ASSERT_TRUE(fit);
            const auto seen = fit->map.directionAt(truth.pointOf(wo));
            const double error = angleBetween({wo, *seen}).value();
            sum += 0.5 * std::pow(error / DirectionUncertainty(*fit)(wo).value(), 2);
        }
        // Birge only widens, so the mean lies a little below 1.
        EXPECT_GT(sum / kFits, 0.6) << theta;
        EXPECT_LT(sum / kFits, 1.25) << theta;
    }
}

TEST(LensFit, OnePlacementIsSingular) {
    const auto fit =
        fitLens(spotsOf(test::crookedLens(), mirrorWedges().first(1), 1), kMiddle, 6.6);
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().kind, ErrorKind::Quality);
    EXPECT_NE(fit.error().message.find("all placements"), std::string::npos);
    EXPECT_FALSE(fitLens({}, kMiddle, 6.6));
}

TEST(LensFit, NoticesAWrongWedge) {
    auto spots = spotsOf(test::crookedLens(), mirrorWedges(), 1);
    // The operator turned the third wedge the wrong way: its spots are those of the second.
    for (std::size_t i = 8; i < 12; ++i) spots[i].at = spots[i - 4].at;
    const auto fit = fitLens(spots, kMiddle, 6.6);
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().kind, ErrorKind::Quality);
}

}  // namespace
}  // namespace gonio::proc
