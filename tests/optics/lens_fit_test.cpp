#include "proc/optics/lens_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "proc/optics/mirror.h"
#include "tests/optics/lenses.h"

namespace gonio::proc {
namespace {

constexpr SensorPoint kMiddle{640, 512};
constexpr double kSigma = 0.03;  // pixels

std::vector<MirrorSpot> spotsOf(const LensMap& map,
                                std::span<const Wedge> wedges,
                                unsigned seed,
                                Radians wedgeTolerance = {}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 1);
    std::vector<MirrorSpot> spots;
    for (const Wedge& wedge : wedges) {
        const Wedge real{wedge.aboutX + wedgeTolerance * noise(random),
                         wedge.aboutY + wedgeTolerance * noise(random)};
        for (const Radians led : {0_deg, 20_deg, 40_deg, 60_deg}) {
            const Direction light = Direction::fromSpherical(led, 0_deg);
            if (mirroredBy(wedge, light).theta() > 75_deg) continue;
            const SensorPoint at = map.pointOf(mirroredBy(real, light));
            spots.push_back({wedge,
                             light,
                             {at.x + kSigma * noise(random), at.y + kSigma * noise(random)},
                             kSigma});
        }
    }
    return spots;
}

/// Root mean square of the fitted directions' errors over the disc to 75 degrees, each square pixel
/// of it alike, over some fits; degrees.
double rmsOverTheDisc(std::span<const Wedge> wedges, Radians wedgeTolerance) {
    const LensMap truth = test::crookedLens();
    double squares = 0, area = 0;
    for (unsigned seed = 0; seed < 20; ++seed) {
        const auto fit = fitLens(
            spotsOf(truth, wedges, 100 + seed, wedgeTolerance), kMiddle, 6.6, wedgeTolerance);
        if (!fit) return std::numeric_limits<double>::infinity();
        for (double theta = 2.5; theta <= 75; theta += 2.5) {
            for (double phi = 0; phi < 360; phi += 15) {
                const Direction wo = Direction::fromSpherical(Radians::fromDegrees(theta),
                                                              Radians::fromDegrees(phi));
                const auto seen = fit->map.directionAt(truth.pointOf(wo));
                if (!seen) return std::numeric_limits<double>::infinity();
                squares += theta * std::pow(angleBetween({wo, *seen}).degrees(), 2);
                area += theta;
            }
        }
    }
    return std::sqrt(squares / area);
}

TEST(LensFit, FindsACrookedLensOverItsWholeFieldTo0Point02Degrees) {
    EXPECT_LT(rmsOverTheDisc(mirrorWedges(), {}), 0.005);
    EXPECT_LT(rmsOverTheDisc(mirrorWedges(), 0.01_deg), 0.02);
}

/// Mean over many fits of the squared normalised error of a direction, per axis: 1 where the stated
/// uncertainty is right.
double normalisedVariance(const Direction& wo, Radians wedgeTolerance) {
    const LensMap truth = test::crookedLens();
    double sum = 0;
    constexpr int kFits = 150;
    for (unsigned seed = 0; seed < kFits; ++seed) {
        const auto fit = fitLens(spotsOf(truth, mirrorWedges(), 100 + seed, wedgeTolerance),
                                 kMiddle,
                                 6.6,
                                 wedgeTolerance);
        if (!fit) return std::numeric_limits<double>::infinity();
        const auto seen = fit->map.directionAt(truth.pointOf(wo));
        const double error = angleBetween({wo, *seen}).value();
        sum += 0.5 * std::pow(error / DirectionUncertainty(*fit)(wo).perAxis().value(), 2);
    }
    return sum / kFits;
}

TEST(LensFit, KnowsHowWrongItMayBe) {
    for (const Radians wedgeTolerance : {0_deg, 0.01_deg}) {
        for (const auto& [theta, phi] : {std::pair{10.0, 30.0}, {50.0, 180.0}, {70.0, 90.0}}) {
            const Direction wo =
                Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
            const double variance = normalisedVariance(wo, wedgeTolerance);
            // Birge only widens, so the mean lies a little below 1.
            EXPECT_GT(variance, 0.6) << theta << " " << wedgeTolerance.degrees();
            EXPECT_LT(variance, 1.25) << theta << " " << wedgeTolerance.degrees();
        }
    }
}

TEST(LensFit, OnePlacementIsSingular) {
    const auto fit =
        fitLens(spotsOf(test::crookedLens(), mirrorWedges().first(1), 1), kMiddle, 6.6, {});
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().kind, ErrorKind::Quality);
    EXPECT_NE(fit.error().message.find("all placements"), std::string::npos);
    EXPECT_FALSE(fitLens({}, kMiddle, 6.6, {}));
}

TEST(LensFit, NoticesAWrongWedge) {
    auto spots = spotsOf(test::crookedLens(), mirrorWedges(), 1);
    // The operator turned the third wedge the wrong way: its spots are those of the second.
    for (std::size_t i = 8; i < 12; ++i) spots[i].at = spots[i - 4].at;
    const auto fit = fitLens(spots, kMiddle, 6.6, {});
    ASSERT_FALSE(fit);
    EXPECT_EQ(fit.error().kind, ErrorKind::Quality);
}

}  // namespace
}  // namespace gonio::proc
