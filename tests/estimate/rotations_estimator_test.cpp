#include "proc/estimate/rotations_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/estimate/interpolation_study.h"
#include "proc/optics/cell_grid.h"
#include "tests/estimate/scatterers.h"

namespace gonio::proc {
namespace {

/// Brighter where oblique light comes along x, darker where it comes along y.
double grained(const LightView& pair) {
    const double along = pair.in.x() * pair.in.x() - pair.in.y() * pair.in.y();
    return 0.1 * (1 + 0.5 * along) * (1 + 0.5 * pair.out.z());
}

/// As the rig sees it at a rotation: the light stays at azimuth 0.
test::Made grainedAt(Radians rotation) {
    return test::Made([rotation](const LightView& pair) {
        return test::answerOf(
            grained({.in = pair.in.turned(-rotation), .out = pair.out.turned(-rotation)}));
    });
}

SampleSet measuredAt(const std::vector<double>& rotationsDeg) {
    SampleSet all;
    for (const double deg : rotationsDeg) {
        const Radians rotation = Radians::fromDegrees(deg);
        SampleSet one = syntheticSample(grainedAt(rotation), {.relativeNoise = 0.002});
        for (LedTable& led : one.leds) {
            led.rotation = rotation;
            all.leds.push_back(std::move(led));
        }
    }
    return all;
}

LightView pairOf(double thetaI, double phiI, double thetaO, double phiO) {
    return {
        .in = Direction::fromSpherical(Radians::fromDegrees(thetaI), Radians::fromDegrees(phiI)),
        .out = Direction::fromSpherical(Radians::fromDegrees(thetaO), Radians::fromDegrees(phiO))};
}

class Grained : public testing::Test {
protected:
    static std::unique_ptr<const RotationsEstimator> over(const std::vector<double>& rotationsDeg) {
        auto made = RotationsEstimator::over(measuredAt(rotationsDeg), {.method = "specular-log"});
        EXPECT_TRUE(made) << made.error().message;
        return std::move(*made);
    }
};

TEST_F(Grained, IsAnsweredAtEachAzimuthOfTheLight) {
    const auto estimator = over({0, 45, 90, 135, 180, 225, 270, 315});
    int within = 0;
    int all = 0;
    for (const double phiI : {0.0, -45.0, 22.5, 100.0, 300.0, 359.0}) {
        for (const double thetaI : {10.0, 20.0, 35.0, 55.0, 70.0}) {
            const LightView pair = pairOf(thetaI, phiI, 40, phiI + 130);
            const Answer answer = estimator->answer(pair);
            ASSERT_TRUE(answer.present()) << phiI << " " << thetaI;
            ++all;
            const double off = std::abs(answer.f[Band::R] - grained(pair));
            // Between rotations of 45 degrees it can be no better under oblique light.
            EXPECT_LT(off, (thetaI < 50 ? 0.06 : 0.5) * grained(pair)) << phiI << " " << thetaI;
            if (off <= 2 * *answer.u(Band::R)) ++within;
        }
    }
    EXPECT_GE(within, 0.9 * all);
    // Halfway to an extremum both neighbours are alike, and their own neighbours tell of the bend.
    const auto shifted = over({22.5, 67.5, 112.5, 157.5, 202.5, 247.5, 292.5, 337.5});
    const LightView peak = pairOf(55, 0, 40, 130);
    const Answer flat = shifted->answer(peak);
    EXPECT_LE(std::abs(flat.f[Band::R] - grained(peak)), 2 * *flat.u(Band::R));
    EXPECT_GT(*flat.u(Band::R), 0.02 * grained(peak));
    // What is exchanged belongs to another azimuth: with it, 40 degrees would be measured here.
    const Answer along = estimator->answer(pairOf(70, 0, 40, 90));
    EXPECT_NE(along.source, Source::Reciprocity);
}

TEST_F(Grained, AMeasuredCellOfARotationIsThatCell) {
    const SampleSet set = measuredAt({0, 90});
    const auto made = RotationsEstimator::over(set, {.method = "specular-log"});
    ASSERT_TRUE(made);
    const std::size_t cell = 7000;
    const LedTable& led = set.leds[5];  // of 90 degrees, at 20
    const Radians phi = -led.rotation;
    const Answer answer = (*made)->answer({.in = Direction::fromSpherical(led.incidence, phi),
                                           .out = CellGrid::centre(cell).turned(phi)});
    EXPECT_EQ(answer.source, Source::Measured);
    EXPECT_EQ(answer.f[Band::R], led.bands[0].f[cell]);
    // At the normal all rotations saw the same, each from its side.
    const Answer normal = (*made)->answer(
        {.in = Direction::fromSpherical(0_deg, 0_deg), .out = CellGrid::centre(cell)});
    EXPECT_EQ(normal.f[Band::R], set.leds[0].bands[0].f[cell]) << "of the first rotation";
}

TEST_F(Grained, FarFromTheRotationsIsSaidToBeExtrapolated) {
    const auto estimator = over({0, 30, 60});
    EXPECT_FALSE(estimator->answer(pairOf(30, -15, 40, 100)).flags.has(Flag::Extrapolated));
    const Answer far = estimator->answer(pairOf(30, 150, 40, 100));
    EXPECT_TRUE(far.present());
    EXPECT_TRUE(far.flags.has(Flag::Extrapolated));
    EXPECT_FALSE(far.u(Band::R)) << "nobody knows";
    // Of two rotations no bend can be seen.
    const auto two = over({0, 90});
    EXPECT_FALSE(two->answer(pairOf(30, -45, 40, 100)).u(Band::R));
    EXPECT_EQ(far.source, Source::Extrapolated);
}

}  // namespace
}  // namespace gonio::proc
