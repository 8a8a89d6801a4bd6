// Planned captures on a simulated rig of coarse pictures that shows something else than what was
// asked for, and does not say so: what comes of it is what an undisturbed rig gives.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "tests/daemon/lab.h"

namespace gonio::daemon {
namespace {

constexpr int kPilots = 9;  // three of each band of the one LED
constexpr const char* kPolished = "ggx,alpha=0.05,f0=0.5";
constexpr const char* kGrey = "lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.3,f0=0.04";
const CaptureGoal kDraft{.effort = Effort::Draft};

using Darks = test::Lab::Darks;

class PlannedRunOnSim : public testing::TestWithParam<Darks> {
protected:
    void SetUp() override {
        lab.calibrateMirror();
        lab.calibrateBlack();
        lab.calibrateWhite();
    }
    [[nodiscard]] test::Lab::Planned taken(const std::string& faults,
                                           const std::string& sample = kGrey) {
        return lab.planned(sample, kDraft, faults, GetParam());
    }
    test::Lab lab{"none", "none", 11, 2, {.binnings = sim::kCoarsestBinning, .leds = 1}};
};

/// The largest difference of two runs, in standard uncertainties of the difference; infinite where
/// one run has a cell that the other has not.
double apart(const PlacementSignals& seen, const PlacementSignals& wanted) {
    double most = seen.size() == wanted.size() ? 0 : INFINITY;
    for (std::size_t led = 0; led < std::min(seen.size(), wanted.size()); ++led) {
        for (const Band band : kBands) {
            const auto& a = seen[led][index(band)];
            const auto& b = wanted[led][index(band)];
            for (std::size_t cell = 0; cell < a.size(); ++cell) {
                if (a.present(cell) != b.present(cell)) return INFINITY;
                if (!a.present(cell)) continue;
                const double variance = a.variance[cell] + b.variance[cell];
                most =
                    std::max(most, std::abs(a.signal[cell] - b.signal[cell]) / std::sqrt(variance));
            }
        }
    }
    return most;
}

std::vector<std::string> causes(const std::vector<Setback>& setbacks) {
    std::vector<std::string> names;
    for (const Setback& one : setbacks) names.emplace_back(name(one.cause));
    return names;
}

// A pilot that is too dim to tell by changes the plan, and weighs next to nothing.
TEST_P(PlannedRunOnSim, PilotsOfLateSettingsAreTakenAgainOrChangeNothing) {
    for (const std::string sample : {kGrey, kPolished}) {
        const auto undisturbed = taken("", sample);
        ASSERT_TRUE(undisturbed.setbacks.empty()) << undisturbed.setbacks.front().message;
        int again = 0;
        for (int frame = 1; frame <= kPilots; ++frame) {
            SCOPED_TRACE(sample + ", pilot " + std::to_string(frame));
            const auto seen =
                taken("on frame " + std::to_string(frame) + " hidden late settings", sample);
            const double most = apart(seen.captured.signals, undisturbed.captured.signals);
            std::cout << "pilot " << frame << ": " << testing::PrintToString(causes(seen.setbacks))
                      << ", " << most << " u apart\n";
            EXPECT_LE(seen.setbacks.size(), 1U);
            EXPECT_LT(most, 6);
            again += seen.setbacks.empty() ? 0 : 1;
        }
        EXPECT_GE(again, 5);
    }
}

TEST_P(PlannedRunOnSim, LedThatDiesInTheMiddleIsToldOfEachState) {
    std::string dead;
    for (int frame = 4; frame < 200; ++frame)
        dead += "on frame " + std::to_string(frame) + " unlit led\n";
    const auto seen = taken(dead);
    std::vector<std::string> brackets;
    for (const Setback& one : seen.setbacks) {
        EXPECT_EQ(name(one.cause), "unlit");
        if (std::ranges::find(brackets, one.bracket) == brackets.end())
            brackets.push_back(one.bracket);
    }
    EXPECT_GE(brackets.size(), 2U) << testing::PrintToString(brackets);
    EXPECT_EQ(framesVerdict(seen.captured.oddFrames).grade, proc::Grade::Warned);
}

TEST_P(PlannedRunOnSim, NoAlarmOfASoundRig) {
    for (const std::string sample : {"lambert,albedo=0.0003",
                                     "lambert,albedo=0.02",
                                     "ggx,alpha=0.02,f0=0.9",
                                     "lambert,albedo=0.99",
                                     "zero"}) {
        SCOPED_TRACE(sample);
        const auto seen = taken("", sample);
        EXPECT_TRUE(seen.setbacks.empty()) << seen.setbacks.front().message;
    }
}

INSTANTIATE_TEST_SUITE_P(,
                         PlannedRunOnSim,
                         testing::Values(Darks::Held, Darks::None),
                         [](const auto& one) {
                             return one.param == Darks::Held ? "WithADarkLibrary" : "Without";
                         });

}  // namespace
}  // namespace gonio::daemon
