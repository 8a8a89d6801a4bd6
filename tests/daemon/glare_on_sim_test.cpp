// Veiling glare, found and taken off on the simulated rig, whose own glare shares nothing with the
// correction. Samples are dark between their lobes: there f is about 1e-3 / sr, and what the lobes
// spread is as much.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "proc/models/spec.h"
#include "tests/daemon/lab.h"

namespace gonio::daemon {
namespace {

using Lower = test::Lab::Lower;
using Glare = test::Lab::Glare;

/// Over the cells whose true f is between 0.5 and 2e-3 / sr.
struct Dark {
    double medianError = 0;  ///< relative
    double medianU = 0;      ///< relative, k = 2
    double covered = 0;      ///< share of cells whose error is within 2 u
    int flagged = 0;
};

Dark darkCells(const proc::SampleSet& set, const Scatterer& truth) {
    std::vector<double> errors, uncertainties;
    Dark dark;
    for (const proc::LedTable& led : set.leds) {
        const Direction wi = Direction::fromSpherical(led.incidence, Radians(0));
        for (Band band : kBands) {
            const proc::CellSamples& cells = led.bands[index(band)];
            for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                if (!cells.present(cell)) continue;
                const LightView pair{.in = wi, .out = proc::CellGrid::centre(cell)};
                const double f = truth.answer(pair).f[band];
                if (f < 5e-4 || f > 2e-3) continue;
                const double error = std::abs(cells.f[cell] - f);
                const double expanded = 2 * cells.at(cell).u();
                errors.push_back(error / f);
                uncertainties.push_back(expanded / f);
                dark.covered += error <= expanded ? 1 : 0;
                dark.flagged += cells.flags[cell].has(Flag::GlareCorrected) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(errors.size(), 20'000U);
    dark.covered /= static_cast<double>(errors.size());
    dark.medianError = median(errors);
    dark.medianU = median(uncertainties);
    return dark;
}

/// A lab with this share of glare and references without errors of their own.
class GlaringLab {
public:
    explicit GlaringLab(const std::string& rigErrors) : lab(rigErrors, "none", 5, kFrames) {
        lab.calibrateMirror();
        lab.calibrateWhite();
        lab.calibrateZero();
    }
    /// As it is measured, and as it would be with the glare left in.
    struct Both {
        Dark after, before;
    };
    Both measured(const std::string& name, const std::string& model) {
        const auto truth = proc::makeModel(model);
        EXPECT_TRUE(truth) << truth.error().message;
        const test::Lab::Seen seen = lab.seen(model, {.frames = 1});
        Both both{.after = darkCells(lab.calibrated(seen, Lower::Zero), **truth),
                  .before = darkCells(lab.calibrated(seen, Lower::Zero, Glare::LeftIn), **truth)};
        std::cout << name << ": median error at f = 0.5..2e-3 " << 100 * both.before.medianError
                  << " % with glare, " << 100 * both.after.medianError << " % without, U(k=2) "
                  << 100 * both.after.medianU << " %, within it " << 100 * both.after.covered
                  << " % of the cells\n";
        return both;
    }

    static constexpr int kFrames = 2;
    test::Lab lab;
};

const std::string kGloss = "lambert,albedo=0.003+ggx,alpha=0.03,f0=0.04";
const std::string kMirrorLike = "lambert,albedo=0.003+ggx,alpha=0.005,f0=0.9";

class GlareOnSim : public testing::TestWithParam<double> {};

TEST_P(GlareOnSim, IsFoundAndTakenOff) {
    const double share = GetParam();
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "a nightly study of a minute";
    GlaringLab rig("glare=" + shortest(share));
    const auto& found = rig.lab.lens()->glare;
    ASSERT_TRUE(found);
    std::cout << "glare " << share << ": found " << found->share() << " (u " << found->uShare
              << "), " << found->everywhere << " everywhere, halo of " << found->radius
              << " pixels, exponent " << found->exponent << ", u relative " << found->uRelative
              << "\n";
    EXPECT_NEAR(found->share(), share, 0.1 * share);
    for (const auto& [name, model] :
         {std::pair{"black gloss", kGloss}, {"mirror-like", kMirrorLike}}) {
        SCOPED_TRACE(name);
        const auto both = rig.measured(name, model);
        EXPECT_GT(both.after.covered, 0.9);
        EXPECT_LT(both.after.medianError, both.after.medianU);
        // Four times, down to what noise leaves of 1e-3 / sr where glare was little from the start.
        constexpr double kNoiseFloor = 0.02;
        EXPECT_LT(both.after.medianError, std::max(both.before.medianError / 4, kNoiseFloor));
        if (both.before.medianError > 0.1) {
            EXPECT_GT(both.after.flagged, 10'000);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shares, GlareOnSim, testing::Values(0.001, 0.005, 0.01));

TEST(GlareOffOnSim, IsFoundToBeNoneAndDoesNoHarm) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "a nightly study of a minute";
    GlaringLab rig("none");
    const auto& found = rig.lab.lens()->glare;
    ASSERT_TRUE(found);
    std::cout << "no glare: found " << found->share() << " (u " << found->uShare << ")\n";
    EXPECT_EQ(found->share(), 0);
    EXPECT_LT(found->uShare, 2e-5);
    const auto both = rig.measured("black gloss", kGloss);
    EXPECT_EQ(both.after.medianError, both.before.medianError);
    EXPECT_EQ(both.after.flagged, 0);
}

}  // namespace
}  // namespace gonio::daemon
