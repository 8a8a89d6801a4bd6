#include "daemon/score.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/models/spec.h"
#include "tests/support/sample_sets.h"

namespace gonio::daemon {
namespace {

/// The same f everywhere, or none where wo.x() > 0.
class Flat : public Scatterer {
public:
    explicit Flat(double f, bool half = false) : f_(f), half_(half) {}
    Answer answer(const LightView& pair) const override {
        if (half_ && pair.out.x() > 0) return Answer::none({}, Source::Interpolated);
        return {.f = LedBands::all(f_)};
    }

private:
    double f_;
    bool half_;
};

/// All bands f, u_random 1 %, u_systematic 2 % of it.
proc::SampleSet measured(double f) {
    auto set = test::sampleSet([f](Radians, const Direction&) { return f; });
    for (proc::LedTable& led : set.leds) led.bands[1] = led.bands[2] = led.bands[0];
    return set;
}

constexpr double kExact = 1e-12;  // sums of 36 equal numbers, and one division

TEST(Score, KnowsAConstantError) {
    const Score result = score(measured(0.103), Flat(0.1));
    EXPECT_NEAR(result.medianRelativeError, 0.03, kExact);
    EXPECT_NEAR(result.p95RelativeError, 0.03, kExact);
    EXPECT_EQ(result.within2u, 1);        // 3 % against 2 sqrt(1 + 4) % of 0.103
    EXPECT_EQ(result.within2uRandom, 0);  // 3 % against 2 %
    EXPECT_EQ(score(measured(0.106), Flat(0.1)).within2u, 0);
}

TEST(Score, CountsEachMeasuredCellOfEachLedAndBand) {
    std::size_t cells = 0;
    while (proc::CellGrid::place(cells).row < 75) ++cells;
    const Score result = score(measured(0.1), Flat(0.1));
    EXPECT_EQ(result.cells, static_cast<int>(cells * 4 * 3));
    EXPECT_EQ(result.within2uRandom, 1);
    EXPECT_NEAR(result.medianRelativeError, 0, kExact);
}

TEST(Score, LeavesOutWhereTheTruthIsUnknownOrDim) {
    const int all = score(measured(0.1), Flat(0.1)).cells;
    const int half = score(measured(0.1), Flat(0.1, true)).cells;
    // Half of the hemisphere, less the cells that the border or a neighbour's step cuts.
    EXPECT_LT(half, all / 2);
    EXPECT_GT(half, 0.45 * all);
    EXPECT_GT(score(measured(0.1), Flat(0.01)).cells, 0);
    EXPECT_EQ(score(measured(0.1), Flat(0.0099)).cells, 0);
}

TEST(Score, LeavesOutFlanksSteeperThanTwentyPerCentPerDegree) {
    // f = exp(k theta_o): its relative slope is k everywhere, all in theta.
    class Flank : public Scatterer {
    public:
        explicit Flank(double perDegree) : k_(perDegree * 180 / kPi) {}
        Answer answer(const LightView& pair) const override {
            return {.f = LedBands::all(0.1 * std::exp(k_ * pair.out.theta().value()))};
        }

    private:
        double k_;
    };
    const proc::SampleSet set = measured(0.1);
    // Central differences over one degree: 2 sinh(k / 2) is 0.2003 at k = 0.2.
    EXPECT_GT(score(set, Flank(0.199)).cells, 0);
    EXPECT_EQ(score(set, Flank(0.201)).cells, 0);
}

TEST(Score, OfNothingIsNoNumber) {
    const Score result = score({}, Flat(0.1));
    EXPECT_EQ(result.cells, 0);
    EXPECT_TRUE(std::isnan(result.medianRelativeError));
}

TEST(Score, TakesTheTruthsMeanOverTheCell) {
    const auto model = proc::makeModel("ggx,alpha=0.1,f0=0.9");
    ASSERT_TRUE(model);
    // A measurement that holds the truth at the centre is wrong by the curvature: never by much
    // where the flank is not steep, and by something.
    auto set = test::sampleSet([&](Radians incidence, const Direction& wo) {
        return (*model)->answer({Direction::fromSpherical(incidence, {}), wo}).f[Band::R];
    });
    for (proc::LedTable& led : set.leds) led.bands[1] = led.bands[2] = led.bands[0];
    const Score result = score(set, **model);
    EXPECT_LT(result.p95RelativeError, 0.005);
    EXPECT_GT(result.p95RelativeError, 1e-5);
}

}  // namespace
}  // namespace gonio::daemon
