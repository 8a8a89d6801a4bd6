#include "proc/estimate/error_model.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gonio::proc {
namespace {

const ErrorScale kScale(1e-3);  // of a black: f = 1 is bright, and its own scale

ProbeError error(double relative, Reach reach, double mirrorDeg) {
    return {.off = relative, .reach = reach, .fromMirror = Radians::fromDegrees(mirrorDeg)};
}

TEST(ErrorModel, GrowsWithTheReachOfAnAnchoredMethod) {
    const ErrorModel model(
        kScale, true, {error(0.02, {.between = 1}, 3), error(0.1, {.between = 1}, 50)});
    EXPECT_NEAR(model.of(1, 0, {.between = 1}, 3_deg), std::hypot(0.02, ErrorModel::kLeast), 1e-10);
    EXPECT_NEAR(
        model.of(1, 0, {.between = 0.5}, 3_deg), std::hypot(0.01, ErrorModel::kLeast), 1e-10);
    EXPECT_NEAR(model.of(1, 0, {.between = 1}, 50_deg), std::hypot(0.1, ErrorModel::kLeast), 1e-10);
    EXPECT_NEAR(model.of(1, 0, {.between = 0}, 50_deg), ErrorModel::kLeast, 1e-10);
}

TEST(ErrorModel, IsTheSameEverywhereForAMethodThatIsNotAnchored) {
    const ErrorModel model(kScale, false, {error(0.02, {.between = 0.3}, 3)});
    EXPECT_NEAR(model.of(1, 0, {.between = 0}, 3_deg), std::hypot(0.02, ErrorModel::kLeast), 1e-10);
}

TEST(ErrorModel, GrowsBeyondTheIncidencesAndTheEdge) {
    ErrorModel model(kScale, true, {});
    model.learnBeyondIncidence({error(0.2, {.beyondIncidence = 20_deg}, 0)});
    model.learnEdge({error(0.3, {.steps = 15}, 0)});
    EXPECT_NEAR(model.of(1, 0, {.beyondIncidence = 10_deg}, 0_deg), std::hypot(0.1, 5e-4), 1e-8);
    EXPECT_NEAR(model.of(1, 0, {.steps = 5}, 0_deg), std::hypot(0.1, 5e-4), 1e-8);
}

TEST(ErrorModel, TakesErrorsBelowTheNoiseForNone) {
    ProbeError below = error(0.01, {.between = 1}, 3);
    below.u = 0.02;
    EXPECT_NEAR(ErrorModel(kScale, true, {below}).of(1, 0, {.between = 1}, 3_deg),
                ErrorModel::kLeast,
                1e-10);
}

TEST(ErrorModel, IsNotRuledByAFewThatAreFarOff) {
    std::vector<ProbeError> errors(1000, error(0.02, {.between = 1}, 3));
    for (std::size_t i = 0; i < 30; ++i) errors[i * 7].off = 50;
    EXPECT_NEAR(ErrorModel(kScale, true, errors).of(1, 0, {.between = 1}, 3_deg), 0.02, 1e-4);
    // One in ten is no accident: two standard deviations hold it.
    for (std::size_t i = 0; i < 70; ++i) errors[i * 7 + 300].off = 50;
    EXPECT_NEAR(ErrorModel(kScale, true, errors).of(1, 0, {.between = 1}, 3_deg), 25, 1e-4);
}

TEST(ErrorModel, WhereNothingWasPredictedIsAsWrongAsAtItsWorst) {
    const ErrorModel model(
        kScale, true, {error(0.02, {.between = 1}, 10), error(0.1, {.between = 1}, 50)});
    EXPECT_NEAR(model.of(1, 0, {.between = 1}, 3_deg), 0.1, 1e-5);
}

TEST(ErrorModel, TakesTheErrorOfADarkAnswerForAnAmount) {
    ProbeError dark = error(0.01, {.between = 1}, 3);
    dark.dark = true;
    const ErrorModel model(ErrorScale(1), true, {error(0.02, {.between = 1}, 3), dark});
    EXPECT_NEAR(model.of(1e-4, 0, {.between = 1}, 3_deg), 0.01, 1e-4);
    EXPECT_NEAR(model.of(0, 0, {.between = 0.5}, 3_deg), 0.005, 1e-4);
    // It fades where answers are bright: at the mean, 1 / 20 of it are left.
    EXPECT_NEAR(model.of(1, 0, {.between = 1}, 3_deg), std::hypot(0.02, 0.01 / 20), 1e-5);
    EXPECT_NEAR(model.of(10, 0, {.between = 1}, 3_deg), 0.2, 1e-3);
}

TEST(ErrorModel, OfNothingIsTheLeast) {
    EXPECT_NEAR(
        ErrorModel().of(1, 0, {.between = 1, .steps = 10}, 10_deg), ErrorModel::kLeast, 1e-10);
}

}  // namespace
}  // namespace gonio::proc
