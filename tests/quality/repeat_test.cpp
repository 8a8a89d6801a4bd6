#include "proc/quality/repeat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr double kNoise = 0.01;  // relative, of a cell
const Direction kMirror = Direction::fromSpherical(20_deg, Radians(kPi));

/// A bracket with a factor on each cell's light, and noise.
template <class Factor>
CellSignal taken(unsigned seed, Factor factor) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, kNoise);
    CellSignal signal = CellSignal::missing(CellGrid::count());
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        if (CellGrid::place(cell).row >= 75) continue;
        const Direction wo = CellGrid::centre(cell);
        const double away = angleBetween({wo, kMirror}).degrees();
        const double level = 1e4 * (0.2 + std::exp(-away * away / 50));
        signal.signal[cell] = level * (factor(away) + noise(random));
        signal.variance[cell] = std::pow(kNoise * level, 2);
        signal.flags[cell] = Flags{Flag::Measured};
    }
    return signal;
}

CellSignal rested(unsigned seed) {
    return taken(seed, [](double /*away*/) { return 1.0; });
}

TEST(Repeat, NoiseAloneIsNoChange) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const RepeatChange change = changeBetween(rested(seed), rested(100 + seed), kMirror);
        ASSERT_TRUE(change.drift && change.softness);
        EXPECT_LT(std::abs(change.drift->size), 4 * change.drift->u);
        EXPECT_LT(std::abs(change.softness->size), 4 * change.softness->u);
        EXPECT_EQ(softnessVerdict(change).grade, Grade::Ok);
        EXPECT_EQ(driftVerdict(change).grade, Grade::Ok);
    }
}

TEST(Repeat, AllCellsAlikeIsDriftAndNoSoftness) {
    const auto bright = taken(1, [](double /*away*/) { return 1.02; });
    const RepeatChange change = changeBetween(bright, rested(2), kMirror);
    EXPECT_NEAR(change.drift->size, 0.02, 4 * change.drift->u);
    EXPECT_NEAR(change.softness->size, 0, 4 * change.softness->u);
    EXPECT_EQ(driftVerdict(change).grade, Grade::Warned);
    EXPECT_EQ(softnessVerdict(change).grade, Grade::Ok);
}

TEST(Repeat, ALobeThatRelaxesIsSoftnessAndNoDrift) {
    const auto pressed =
        taken(1, [](double away) { return 1 + 0.03 * std::exp(-away * away / 200); });
    const RepeatChange change = changeBetween(pressed, rested(2), kMirror);
    EXPECT_NEAR(change.drift->size, 0, 4 * change.drift->u + 1e-4);
    EXPECT_GT(change.softness->size, 0.02);
    EXPECT_LT(change.softness->size, 0.03);
    EXPECT_EQ(softnessVerdict(change).grade, Grade::Refused);
    EXPECT_EQ(driftVerdict(change).grade, Grade::Ok);
}

TEST(Repeat, SmallOrUnsureChangesAreLetBe) {
    const auto grade = [](double size, double u) {
        return softnessVerdict(RepeatChange{.drift = {}, .softness = Change{size, u}}).grade;
    };
    EXPECT_EQ(grade(0.0099, 1e-4), Grade::Ok);
    EXPECT_EQ(grade(0.0101, 1e-4), Grade::Refused);
    EXPECT_EQ(grade(-0.0101, 1e-4), Grade::Refused);
    EXPECT_EQ(grade(0.0101, 0.0021), Grade::Ok);
}

TEST(Repeat, OfALobeThatIsSaturatedNothingIsDetermined) {
    CellSignal first = rested(1);
    const auto brightest = *CellGrid::cellAt(kMirror);
    first.flags[brightest] = Flags{Flag::Saturated};
    const RepeatChange change = changeBetween(first, rested(2), kMirror);
    EXPECT_TRUE(change.drift);
    EXPECT_FALSE(change.softness);
    EXPECT_EQ(softnessVerdict(change).grade, Grade::NotDetermined);
}

TEST(Repeat, WithoutARepeatOrLightNothingIsDetermined) {
    EXPECT_EQ(softnessVerdict({}).grade, Grade::NotDetermined);
    EXPECT_EQ(driftVerdict({}).grade, Grade::NotDetermined);
    const CellSignal none = CellSignal::missing(CellGrid::count());
    const RepeatChange change = changeBetween(none, none, kMirror);
    EXPECT_EQ(softnessVerdict(change).grade, Grade::NotDetermined);
    EXPECT_EQ(driftVerdict(change).grade, Grade::NotDetermined);
}

}  // namespace
}  // namespace gonio::proc
