#include "proc/quality/seen_direction.h"

#include <gtest/gtest.h>

namespace gonio::proc {
namespace {

const std::vector<Radians> kIncidences{0_deg, 20_deg, 40_deg, 60_deg};

/// One parameter of an even f-theta lens is not known.
LensFit unknown(Eigen::Index parameter, double u) {
    LensFit lens{.map = LensMap::fTheta({512, 512}, 6.6),
                 .covariance = Eigen::MatrixXd::Zero(8, 8)};
    lens.covariance(parameter, parameter) = u * u;
    return lens;
}

TiltEstimate estimate(std::size_t lobes = 4) {
    TiltEstimate found{.joint = {.direction = Direction(),
                                 .u = 0.01_deg,
                                 .uSeen = TurnUncertainty::even(0.01_deg)},
                       .leds = {4, std::nullopt},
                       .lobes = std::vector<TiltLobe>(4)};
    for (std::size_t led = 0; led < lobes; ++led) found.leds[led] = found.joint;
    return found;
}

Direction mirrorAt(std::size_t led) {
    return Direction::fromSpherical(kIncidences[led], Radians(kPi));
}

/// The light comes from +x, so that all lobes lie along x: a middle that is off along x moves them
/// all alike, as a tilt does.
TEST(SeenDirection, AMiddleThatIsOffDoesNoHarmBesideTheLobes) {
    const LensFit lens = unknown(0, 1);
    const DirectionUncertainty map(lens);
    const SeenDirection seen(lens, kIncidences, estimate());
    for (std::size_t led = 0; led < 4; ++led) {
        EXPECT_NEAR(map(mirrorAt(led)).perAxis().degrees(), 1 / 6.6 / std::sqrt(2), 1e-3) << led;
        EXPECT_LT(seen.uncertainty(led, mirrorAt(led)).perAxis(),
                  map(mirrorAt(led)).perAxis() * 0.01)
            << led;
    }
    const Direction beside = Direction::fromSpherical(43_deg, Radians(kPi));
    EXPECT_LT(seen.uncertainty(2, beside).perAxis(), map(beside).perAxis() * 0.01);
}

/// A lens whose scale is off shows all directions nearer to its middle: along theta alone.
TEST(SeenDirection, TellsThetaFromPhi) {
    LensMap centred = LensMap::fTheta({512, 512}, 6.6);
    constexpr auto kParameters = static_cast<Eigen::Index>(LensMap::kParameters);
    LensFit lens{.map = centred, .covariance = Eigen::MatrixXd::Zero(kParameters, kParameters)};
    lens.covariance(5, 5) = 0.01 * 0.01;  // c1
    const DirectionSpread spread =
        DirectionUncertainty(lens)(Direction::fromSpherical(40_deg, 130_deg));
    EXPECT_GT(spread.alongTheta, 0.1_deg);
    EXPECT_LT(spread.alongPhi.value(), 1e-6 * spread.alongTheta.value());
}

/// 1 % of scale is 0.2 to 0.6 degree at the lobes; a common tilt takes up their mean only.
TEST(SeenDirection, AScaleThatIsOffIsLeftWhereLobesDisagree) {
    const LensFit lens = unknown(5, 0.01);  // c1
    const DirectionUncertainty map(lens);
    const SeenDirection seen(lens, kIncidences, estimate());
    const double all = map(mirrorAt(3)).perAxis().value();
    const double left = seen.uncertainty(3, mirrorAt(3)).perAxis().value();
    EXPECT_GT(left, 0.3 * all);
    EXPECT_LT(left, 0.7 * all);
}

TEST(SeenDirection, WithoutLobesAllOfTheMapIsLeft) {
    const LensFit lens = unknown(1, 0.5);
    const SeenDirection seen(lens, kIncidences, estimate(0));
    const Direction wo = Direction::fromSpherical(30_deg, 77_deg);
    const DirectionSpread left = seen.uncertainty(1, wo), all = DirectionUncertainty(lens)(wo);
    EXPECT_DOUBLE_EQ(left.alongTheta.value(), all.alongTheta.value());
    EXPECT_DOUBLE_EQ(left.alongPhi.value(), all.alongPhi.value());
}

TEST(SeenDirection, OneLobeTakesUpAllOfItself) {
    const LensFit lens = unknown(5, 0.01);
    TiltEstimate one = estimate(0);
    one.leds[2] = one.joint;
    const SeenDirection seen(lens, kIncidences, one);
    EXPECT_LT(seen.uncertainty(2, mirrorAt(2)).perAxis().value(), 1e-9);
}

}  // namespace
}  // namespace gonio::proc
