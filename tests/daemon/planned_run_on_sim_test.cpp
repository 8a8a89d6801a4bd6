// Planned captures on a simulated rig of coarse pictures that shows something else than what was
// asked for, and does not say so: what comes of it is what an undisturbed rig gives.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "tests/daemon/lab.h"

namespace gonio::daemon {
namespace {

constexpr const char* kPolished = "ggx,alpha=0.05,f0=0.5";
constexpr const char* kGrey = "lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.3,f0=0.04";
const CaptureGoal kDraft{.effort = Effort::Draft};

using Darks = test::Lab::Darks;

const bool kNightly = std::getenv("GONIO_NIGHTLY") != nullptr;

class PlannedRunOnSim : public testing::Test {
protected:
    void SetUp() override {
        lab.calibrateMirror();
        lab.calibrateBlack();
        lab.calibrateWhite();
    }
    [[nodiscard]] test::Lab::Planned taken(const std::string& sample,
                                           const std::string& faults,
                                           Darks darks) {
        return lab.planned(sample, kDraft, faults, darks);
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

// A pilot that is too dim to tell by changes the plan, and weighs next to nothing. Nightly each
// pilot, with a dark library and without; else the ones that are hardest to tell.
TEST_F(PlannedRunOnSim, PilotsOfLateSettingsAreTakenAgainOrChangeNothing) {
    const std::vector<int> pilots =
        kNightly ? std::vector{1, 2, 3, 4, 5, 6, 7, 8, 9} : std::vector{1, 2};
    for (const Darks darks : {Darks::Held, Darks::None}) {
        for (const std::string sample : {kGrey, kPolished}) {
            if (!kNightly && (darks == Darks::None) == (sample == kPolished)) continue;
            const auto undisturbed = taken(sample, "", darks);
            ASSERT_TRUE(undisturbed.setbacks.empty()) << undisturbed.setbacks.front().message;
            for (const int pilot : pilots) {
                SCOPED_TRACE(sample + ", pilot " + std::to_string(pilot));
                const auto seen = taken(
                    sample, "on frame " + std::to_string(pilot) + " hidden late settings", darks);
                const double most = apart(seen.captured.signals, undisturbed.captured.signals);
                std::cout << sample << ", pilot " << pilot << ": "
                          << testing::PrintToString(causes(seen.setbacks)) << ", " << most
                          << " u apart\n";
                EXPECT_LE(seen.setbacks.size(), 1U);
                EXPECT_LT(most, 6);
                EXPECT_TRUE(pilot == 1 || seen.setbacks.size() == 1U) << "the first may be dark";
            }
        }
    }
}

TEST_F(PlannedRunOnSim, LedThatDiesInTheMiddleIsToldOfEachState) {
    std::string dead;
    for (int frame = 4; frame < 200; ++frame)
        dead += "on frame " + std::to_string(frame) + " unlit led\n";
    const auto seen = taken(kGrey, dead, Darks::None);
    std::vector<std::string> brackets;
    for (const Setback& one : seen.setbacks) {
        EXPECT_EQ(name(one.cause), "unlit");
        if (std::ranges::find(brackets, one.bracket) == brackets.end())
            brackets.push_back(one.bracket);
    }
    EXPECT_GE(brackets.size(), 2U) << testing::PrintToString(brackets);
    EXPECT_EQ(framesVerdict(seen.captured.oddFrames).grade, proc::Grade::Warned);
}

TEST_F(PlannedRunOnSim, NoAlarmOfASoundRig) {
    const std::vector<std::string> hard{"lambert,albedo=0.0003", "ggx,alpha=0.02,f0=0.9"};
    const std::vector<std::string> others{"lambert,albedo=0.02", "lambert,albedo=0.99", "zero"};
    for (const Darks darks : {Darks::Held, Darks::None}) {
        std::vector<std::string> samples = hard;
        if (kNightly) samples.insert(samples.end(), others.begin(), others.end());
        for (const std::string& sample : samples) {
            SCOPED_TRACE(sample);
            const auto seen = taken(sample, "", darks);
            EXPECT_TRUE(seen.setbacks.empty()) << seen.setbacks.front().message;
        }
    }
}

}  // namespace
}  // namespace gonio::daemon
