#include "daemon/sample_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "proc/models/spec.h"
#include "proc/quality/verdict.h"
#include "tests/support/sample_sets.h"

namespace gonio::daemon {
namespace {

constexpr Radians kLens = 0.01_deg;

/// A surface whose LEDs each see a normal of their own.
proc::SampleSet seen(const Scatterer& surface, const std::vector<Direction>& normals) {
    proc::SampleSet set;
    const Radians incidences[] = {0_deg, 20_deg, 40_deg, 60_deg};
    for (std::size_t led = 0; led < 4; ++led) {
        const auto turn =
            Eigen::Quaterniond::FromTwoVectors(normals[led].vector(), Eigen::Vector3d::UnitZ());
        const auto own = [&](const Direction& d) {
            return *Direction::fromVector(turn * d.vector());
        };
        const Direction wi = own(Direction::fromSpherical(incidences[led], Radians(0)));
        set.leds.push_back(
            test::ledTable(incidences[led], [&](Radians /*incidence*/, const Direction& wo) {
                return surface.answer({wi, own(wo)}).f[Band::G] * own(wo).z() / wo.z();
            }));
    }
    set.info.budgetJson = R"([{"led":0,"band":"r","components":[]}])";
    return set;
}

proc::SampleSet seen(const std::string& spec, const std::vector<Direction>& normals) {
    const auto surface = proc::makeModel(spec);
    EXPECT_TRUE(surface) << surface.error().message;
    return surface ? seen(**surface, normals) : proc::SampleSet();
}

const std::string kPlastic = "lambert,albedo=0.1+ggx,alpha=0.1,f0=0.04";

std::vector<Direction> tilted(Radians tilt) {
    return std::vector<Direction>(4, Direction::fromSpherical(tilt, 30_deg));
}

bool corrected(const proc::SampleSet& set) {
    return set.leds[1].bands[0].flags[100].has(Flag::TiltCorrected);
}

proc::Verdict verdictOf(const proc::SampleSet& set, const std::string& name) {
    for (const proc::Verdict& one : proc::readVerdicts(set.info.qcVerdicts)) {
        if (one.name == name) return one;
    }
    ADD_FAILURE() << "no verdict '" << name << "' in " << set.info.qcVerdicts;
    return {};
}

TEST(SamplePose, TiltIsCorrectedAndItsLineStandsInTheBudget) {
    const auto flat = referredToItsNormal(seen(kPlastic, tilted(0.5_deg)), kLens);
    EXPECT_TRUE(corrected(flat));
    const proc::Verdict tilt = verdictOf(flat, "tilt");
    EXPECT_EQ(tilt.grade, proc::Grade::Ok);
    ASSERT_TRUE(tilt.figure && tilt.figure->u);
    EXPECT_NEAR(tilt.figure->value, 0.5, 0.02);
    EXPECT_EQ(tilt.figure->limit, 1);
    EXPECT_NE(tilt.evidence.find(", corrected"), std::string::npos) << tilt.evidence;
    EXPECT_EQ(verdictOf(flat, "waviness").grade, proc::Grade::Ok);
    EXPECT_NE(flat.info.budgetJson.find("tilt of the sample"), std::string::npos);
}

TEST(SamplePose, TiltAboveOneDegreeIsWarnedOf) {
    const auto flat = referredToItsNormal(seen(kPlastic, tilted(1.5_deg)), kLens);
    const proc::Verdict tilt = verdictOf(flat, "tilt");
    EXPECT_EQ(tilt.grade, proc::Grade::Warned);
    EXPECT_FALSE(tilt.next.empty());
}

TEST(SamplePose, FlatSampleIsLetBe) {
    const auto sample = seen(kPlastic, tilted(0_deg));
    const auto same = referredToItsNormal(sample, kLens);
    EXPECT_FALSE(corrected(same));
    EXPECT_EQ(same.leds[1].bands[0].f[100], sample.leds[1].bands[0].f[100]);
}

TEST(SamplePose, MattSamplesAreNeverWavyNorTilted) {
    for (const char* spec : {"lambert,albedo=0.5", "oren-nayar,albedo=0.8,sigma=0.3"}) {
        const auto sample = seen(spec, tilted(0.5_deg));
        const auto same = referredToItsNormal(sample, kLens);
        EXPECT_FALSE(corrected(same)) << spec;
        // Its seat changes cos(theta_o): 0.25 degrees about each axis are tan(theta_o) 0.0044.
        const proc::CellSamples& before = sample.leds[1].bands[0];
        const proc::CellSamples& after = same.leds[1].bands[0];
        for (const std::size_t cell : {std::size_t{100}, std::size_t{9000}}) {
            const double had = before.uSystematic[cell], has = after.uSystematic[cell];
            const double wanted = 0.0044 * tan(proc::CellGrid::centre(cell).theta());
            EXPECT_NEAR(std::sqrt(has * has - had * had) / after.f[cell], wanted, 0.02 * wanted);
        }
        EXPECT_EQ(verdictOf(same, "tilt").grade, proc::Grade::NotDetermined) << spec;
        EXPECT_EQ(verdictOf(same, "waviness").grade, proc::Grade::NotDetermined) << spec;
    }
}

TEST(SamplePose, LobeThatDoesNotTellItsTiltHasOneInItsUncertainties) {
    struct Ring : Scatterer {
        [[nodiscard]] Answer answer(const LightView& pair) const override {
            const double off = angleBetween({pair.out, mirrorOf(pair.in)}).degrees();
            Answer answer;
            answer.f = LedBands::all(0.01 + std::exp(-std::pow((off - 20) / 2, 2)));
            return answer;
        }
    };
    const auto sample = seen(Ring(), tilted(0.5_deg));
    const auto same = referredToItsNormal(sample, kLens);
    EXPECT_FALSE(corrected(same));
    EXPECT_NE(same.info.qcVerdicts.find("the lobe is none"), std::string::npos)
        << same.info.qcVerdicts;
    EXPECT_GT(same.leds[1].bands[0].uSystematic[300], sample.leds[1].bands[0].uSystematic[300]);
}

TEST(SamplePose, WavyOrSteepIsRefused) {
    const std::vector<Direction> waves{Direction::fromSpherical(0.5_deg, 0_deg),
                                       Direction::fromSpherical(0.5_deg, 90_deg),
                                       Direction::fromSpherical(0.5_deg, 180_deg),
                                       Direction::fromSpherical(0.5_deg, 270_deg)};
    const auto wavy = referredToItsNormal(seen(kPlastic, waves), kLens);
    EXPECT_EQ(verdictOf(wavy, "waviness").grade, proc::Grade::Refused);
    const auto steep = referredToItsNormal(seen(kPlastic, tilted(7_deg)), kLens);
    EXPECT_EQ(verdictOf(steep, "tilt").grade, proc::Grade::Refused);
}

TEST(SamplePose, VerdictsOfOtherChecksStay) {
    proc::SampleSet sample = seen("lambert,albedo=0.5", tilted(0_deg));
    sample.info.qcVerdicts = proc::verdictsText(std::vector{
        proc::Verdict{.name = "light", .figure = {}, .evidence = "steady", .next = {}}});
    const auto same = referredToItsNormal(std::move(sample), kLens);
    EXPECT_EQ(verdictOf(same, "light").evidence, "steady");
}

}  // namespace
}  // namespace gonio::daemon
