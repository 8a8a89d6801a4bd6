#include "proc/quality/tilt.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

#include "proc/models/ggx.h"
#include "proc/models/spec.h"
#include "proc/quality/tilt_correction.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

constexpr Radians kLens = 0.01_deg;

std::unique_ptr<const Scatterer> model(const std::string& spec) {
    auto made = makeModel(spec);
    EXPECT_TRUE(made) << made.error().message;
    return made ? std::move(*made) : nullptr;
}

/// Lambert and a lobe of other facets than GGX's: Beckmann's, or GTR's with a longer tail.
struct OtherLobe : Scatterer {
    enum class Facets {
        Beckmann,
        Gtr15
    };
    Facets facets;
    double alpha, f0, albedo;
    OtherLobe(Facets of, double width, double reflectance, double diffuse)
        : facets(of), alpha(width), f0(reflectance), albedo(diffuse) {}

    [[nodiscard]] Answer answer(const LightView& pair) const override {
        const Eigen::Vector3d half = (pair.in.vector() + pair.out.vector()).normalized();
        const double c2 = half.z() * half.z(), a2 = alpha * alpha;
        double d = 0;
        if (facets == Facets::Beckmann) {
            d = std::exp((1 - 1 / c2) / a2) / (kPi * a2 * c2 * c2);
        } else {  // gamma = 1.5
            d = (a2 - 1) / (2 * kPi * (1 - 1 / alpha)) / std::pow(1 + (a2 - 1) * c2, 1.5);
        }
        const double v =
            ggxV(pairOf<double>(pair), Alpha<double>::isotropic(alpha), Masking::HeightCorrelated);
        const double fresnel = schlick(f0, 1.0, half.dot(pair.in.vector()));
        Answer answer;
        answer.f = LedBands::all(albedo / kPi + d * v * fresnel);
        return answer;
    }
};

Direction normalAt(Radians tilt, Radians toward) { return Direction::fromSpherical(tilt, toward); }

/// What the rig shows of a surface with this normal: turned directions, and the cosine of the view.
double shown(const Scatterer& surface, const Direction& normal, const LightView& pair) {
    const auto turn = Eigen::Quaterniond::FromTwoVectors(normal.vector(), Eigen::Vector3d::UnitZ());
    const LightView own{*Direction::fromVector(turn * pair.in.vector()),
                        *Direction::fromVector(turn * pair.out.vector())};
    return surface.answer(own).f[Band::G] * own.out.z() / pair.out.z();
}

/// One sample whose LEDs each see a normal of their own, with 1 % noise.
SampleSet seen(const Scatterer& surface, const std::vector<Direction>& normals) {
    SampleSet set;
    std::mt19937 random(7);
    std::normal_distribution<double> noise(1, 0.01);
    const Radians incidences[] = {0_deg, 20_deg, 40_deg, 60_deg};
    for (std::size_t led = 0; led < 4; ++led) {
        const Direction wi = Direction::fromSpherical(incidences[led], Radians(0));
        set.leds.push_back(
            test::ledTable(incidences[led], [&](Radians /*incidence*/, const Direction& wo) {
                return shown(surface, normals[led], {wi, wo}) * noise(random);
            }));
    }
    return set;
}

SampleSet seen(const Scatterer& surface, const Direction& normal) {
    return seen(surface, std::vector<Direction>(4, normal));
}

double degreesApart(const Direction& a, const Direction& b) {
    return angleBetween({a, b}).degrees();
}

/// Relative root mean square over the cells where the truth is above a tenth of its peak.
double lobeRms(const SampleSet& set, const Scatterer& truth) {
    double squares = 0;
    int count = 0;
    for (const LedTable& led : set.leds) {
        const Direction wi = Direction::fromSpherical(led.incidence, Radians(0));
        const double peak = truth.answer({wi, mirrorOf(wi)}).f[Band::G];
        const CellSamples& cells = led.bands[index(Band::R)];  // ledTable: R shows it once
        for (std::size_t cell = 0; cell < cells.size(); ++cell) {
            const double f = truth.answer({wi, CellGrid::centre(cell)}).f[Band::G];
            if (!cells.present(cell) || f < 0.1 * peak) continue;
            squares += std::pow(cells.f[cell] / f - 1, 2);
            ++count;
        }
    }
    return std::sqrt(squares / count);
}

TEST(Tilt, IsFoundToAHundredthOfADegreeAndItsUncertaintyIsHonest) {
    for (const auto& [alpha, limit] : {std::pair(0.05, 0.01), {0.1, 0.01}, {0.3, 0.05}}) {
        const auto surface =
            model("lambert,albedo=0.1+ggx,alpha=" + std::to_string(alpha) + ",f0=0.04");
        const Direction normal = normalAt(0.5_deg, 70_deg);
        const auto found = estimateTilt(seen(*surface, normal), kLens);
        ASSERT_TRUE(found) << alpha;
        const double wrong = degreesApart(found->joint.direction, normal);
        EXPECT_LT(wrong, limit) << alpha;
        EXPECT_LT(wrong, 3 * found->joint.u.degrees()) << alpha;
        EXPECT_LT(found->joint.u.degrees(), 0.12) << alpha;
        EXPECT_NEAR(found->lobes[1].alpha, alpha, 0.05 * alpha);
        EXPECT_LT(found->waviness.degrees(), 0.02) << alpha;
    }
}

TEST(Tilt, OfALobeThatIsNoGgxIsFoundToATenthOfADegree) {
    for (const std::string spec : {"ggx,alpha=0.06,f0=0.03+ggx,alpha=0.3,f0=0.1+oren-nayar,"
                                   "albedo=0.2,sigma=0.4",
                                   "ggx,alpha=0.2,f0=0.9"}) {
        const auto surface = model(spec);
        const Direction normal = normalAt(0.8_deg, 200_deg);
        const auto found = estimateTilt(seen(*surface, normal), kLens);
        ASSERT_TRUE(found) << spec;
        EXPECT_LT(degreesApart(found->joint.direction, normal), 0.1) << spec;
        EXPECT_LT(degreesApart(found->joint.direction, normal), 3 * found->joint.u.degrees())
            << spec;
    }
}

using Facets = OtherLobe::Facets;

const std::vector<OtherLobe> kSharp{{Facets::Beckmann, 0.1, 0.9, 0},
                                    {Facets::Beckmann, 0.1, 0.04, 0.1},
                                    {Facets::Gtr15, 0.05, 0.9, 0},
                                    {Facets::Gtr15, 0.1, 0.04, 0.3}};
const OtherLobe kWide{Facets::Beckmann, 0.3, 0.5, 0.1};

const std::vector<Direction> kWaves{normalAt(0.5_deg, 0_deg),
                                    normalAt(0.5_deg, 90_deg),
                                    normalAt(0.5_deg, 180_deg),
                                    normalAt(0.5_deg, 270_deg)};

std::string named(const OtherLobe& lobe) {
    return (lobe.facets == Facets::Beckmann ? "Beckmann " : "GTR ") + std::to_string(lobe.alpha);
}

TEST(Tilt, OfBeckmannAndGtrLobesIsFoundWellEnoughToBeCorrected) {
    for (const OtherLobe& lobe : kSharp) {
        SCOPED_TRACE(named(lobe));
        const Direction normal = normalAt(0.5_deg, 70_deg);
        const auto found = estimateTilt(seen(lobe, normal), kLens);
        ASSERT_TRUE(found);
        EXPECT_TRUE(found->determined);
        const double wrong = degreesApart(found->joint.direction, normal);
        EXPECT_LT(wrong, 0.02);
        EXPECT_LT(wrong, 3 * found->joint.u.degrees());
        EXPECT_LT(found->joint.u.degrees(), 0.1);
        EXPECT_LT(found->waviness.degrees(), 0.05) << "it is tilted, not wavy";
    }
}

TEST(Tilt, OfAWideLobeThatIsNoGgxIsWithinItsUncertaintyAndNoWave) {
    const Direction normal = normalAt(0.5_deg, 70_deg);
    const auto found = estimateTilt(seen(kWide, normal), kLens);
    ASSERT_TRUE(found);
    EXPECT_LT(degreesApart(found->joint.direction, normal), 3 * found->joint.u.degrees());
    EXPECT_LT(found->joint.u.degrees(), 0.5);
    EXPECT_LT(found->waviness.degrees(), 0.1);
}

/// Whose lobes lean in the plane of incidence, by up to 2 degrees under 60, as no GGX lobe does.
TEST(Tilt, OfLobesThatLeanIsFoundWhereTheyCannotAndTheyAreNoWaves) {
    for (const std::string spec : {"lambert,albedo=0.2+beckmann,alpha=0.25,f0=0.05",
                                   "lambert,albedo=0.244+ward,alpha=0.162,ks=0.0295",
                                   "lambert,albedo=0.05+ward,alpha=0.1,ks=0.1",
                                   "phong,kd=0.3,ks=0.2,n=40",
                                   "blinn-phong,kd=0.3,ks=0.1,n=80",
                                   "lambert,albedo=0.1+low,roughness=0.3,eta=1.5,ks=0.1"}) {
        for (const Direction& normal : {Direction(), normalAt(0.5_deg, 30_deg)}) {
            const auto found = estimateTilt(seen(*model(spec), normal), kLens);
            ASSERT_TRUE(found) << spec;
            EXPECT_TRUE(found->determined) << spec;
            const double wrong = degreesApart(found->joint.direction, normal);
            EXPECT_LT(wrong, 0.06) << spec;
            EXPECT_LT(wrong, 3 * found->joint.u.degrees()) << spec;
            EXPECT_LT(found->waviness.degrees(), 0.1) << spec;
        }
    }
}

TEST(Tilt, WavesOfLobesThatAreNoGgxAreNotHiddenByTheMisfit) {
    std::vector<OtherLobe> all = kSharp;
    all.push_back(kWide);
    for (const OtherLobe& lobe : all) {
        SCOPED_TRACE(named(lobe));
        const auto wavy = estimateTilt(seen(lobe, kWaves), kLens);
        ASSERT_TRUE(wavy);
        EXPECT_NEAR(wavy->waviness.degrees(), 0.5, 0.1);
    }
}

TEST(Tilt, OfALobeThatIsNotToBeFittedIsNotDeterminedWhichIsNotNothing) {
    // A ring: bright where no distribution of facets about one normal puts it.
    struct Ring : Scatterer {
        [[nodiscard]] Answer answer(const LightView& pair) const override {
            const double off = angleBetween({pair.out, mirrorOf(pair.in)}).degrees();
            Answer answer;
            answer.f = LedBands::all(0.01 + std::exp(-std::pow((off - 20) / 2, 2)));
            return answer;
        }
    };
    const auto found = estimateTilt(seen(Ring(), Direction()), kLens);
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->determined);
    EXPECT_EQ(found->joint.tilt().value(), 0);
    EXPECT_DOUBLE_EQ(found->joint.u.value(), 0.0044);
    EXPECT_EQ(found->waviness.value(), 0);
    ASSERT_EQ(found->leds.size(), 4U);
    EXPECT_FALSE(found->leds[0]);
    ASSERT_EQ(found->lobes.size(), 4U);
}

TEST(Tilt, OfAMattSampleIsNotDetermined) {
    EXPECT_FALSE(estimateTilt(seen(*model("lambert,albedo=0.5"), Direction()), kLens));
}

TEST(Tilt, OfNothingIsNotDetermined) {
    EXPECT_FALSE(estimateTilt({}, kLens));
    SampleSet missing;
    missing.leds.push_back({.incidence = 20_deg, .bands = {}});
    EXPECT_FALSE(estimateTilt(missing, kLens));
    for (CellSamples& band : missing.leds.front().bands) {
        band = CellSamples::missing(CellGrid::count());
    }
    EXPECT_FALSE(estimateTilt(missing, kLens));
}

TEST(Tilt, WavesAreSeenWhereTheLedsDisagree) {
    const auto surface = model("lambert,albedo=0.1+ggx,alpha=0.1,f0=0.04");
    const auto wavy = estimateTilt(seen(*surface, kWaves), kLens);
    ASSERT_TRUE(wavy);
    EXPECT_NEAR(wavy->waviness.degrees(), 0.5, 0.1);
}

TEST(TiltCorrection, LeavesLessThanOnePercentOfTheLobe) {
    const auto surface = model("lambert,albedo=0.1+ggx,alpha=0.1,f0=0.04");
    const SampleSet tilted = seen(*surface, normalAt(0.5_deg, 70_deg));
    EXPECT_GT(lobeRms(tilted, *surface), 0.04) << "the tilt does harm";
    const auto found = estimateTilt(tilted, kLens);
    ASSERT_TRUE(found);
    const SampleSet corrected = tiltCorrected(tilted, *found);
    EXPECT_LT(lobeRms(corrected, *surface), 0.01);
    const CellSamples& cells = corrected.leds[1].bands[0];
    EXPECT_TRUE(cells.flags[1000].has(Flag::TiltCorrected));
    EXPECT_GT(cells.uSystematic[1000], 0);
}

TEST(TiltCorrection, BeyondTheFieldIsMissingAndNotZero) {
    const auto surface = model("lambert,albedo=0.1+ggx,alpha=0.1,f0=0.04");
    const SampleSet tilted = seen(*surface, normalAt(3_deg, 0_deg));
    const auto found = estimateTilt(tilted, kLens);
    ASSERT_TRUE(found);
    const SampleSet corrected = tiltCorrected(tilted, *found);
    int lost = 0;
    for (const LedTable& led : corrected.leds) {
        const CellSamples& cells = led.bands[0];
        for (std::size_t cell = 0; cell < cells.size(); ++cell) {
            EXPECT_EQ(std::isnan(cells.f[cell]), !cells.present(cell));
            lost += CellGrid::place(cell).row < 75 && !cells.present(cell) ? 1 : 0;
        }
    }
    EXPECT_GT(lost, 0);
}

TEST(TiltCorrection, UncertaintyOfTheTiltIsTheSlopeOfTheLobe) {
    const auto surface = model("ggx,alpha=0.1,f0=0.5");
    SampleSet flat = seen(*surface, Direction());
    const TiltEstimate estimate{
        .joint = {.direction = Direction(), .u = 0.1_deg, .uSeen = TurnUncertainty::even(0.1_deg)},
        .leds = {},
        .lobes = std::vector<TiltLobe>(4, {.diffuse = 0, .alpha = 0.1, .f0 = 0.5}),
        .waviness = {}};
    const SampleSet widened = withTiltUncertainty(flat, estimate);
    // On the flank, 4 degrees off the mirror direction at normal incidence.
    const auto cell = *CellGrid::cellAt(Direction::fromSpherical(4.5_deg, 10_deg));
    const CellSamples& before = flat.leds[0].bands[0];
    const CellSamples& after = widened.leds[0].bands[0];
    const double added =
        std::sqrt(std::pow(after.uSystematic[cell], 2) - std::pow(before.uSystematic[cell], 2));
    const Direction wo = CellGrid::centre(cell);
    const double moved = shown(*surface, normalAt(0.1_deg, wo.phi()), {Direction(), wo}) /
                             shown(*surface, Direction(), {Direction(), wo}) -
                         1;
    EXPECT_NEAR(added / before.f[cell], std::abs(moved), 0.1 * std::abs(moved));
}

/// What `change` adds to u_systematic of a cell on the flank of a lobe, relative to f.
template <class Change>
double addedOnTheFlank(const SampleSet& sample, const Change& change) {
    const auto cell = *CellGrid::cellAt(Direction::fromSpherical(4.5_deg, 10_deg));
    const SampleSet after = change(sample);
    const double before =
        sample.leds[0].bands[0].uSystematic[cell] / sample.leds[0].bands[0].f[cell];
    const CellSamples& cells = after.leds[0].bands[0];
    return std::sqrt(std::pow(cells.uSystematic[cell] / cells.f[cell], 2) - before * before);
}

TEST(TiltCorrection, WavesAddAsMuchAsAnUncertaintyOfThatSize) {
    const SampleSet flat = seen(*model("ggx,alpha=0.1,f0=0.5"), Direction());
    TiltEstimate unsure{.joint = {Direction(), 0.1_deg, TurnUncertainty::even(0.1_deg)},
                        .leds = {},
                        .lobes = std::vector<TiltLobe>(4, {.diffuse = 0, .alpha = 0.1, .f0 = 0.5}),
                        .waviness = {}};
    TiltEstimate wavy = unsure;
    wavy.joint.u = Radians(0);
    wavy.joint.uSeen = {};
    wavy.waves = TurnUncertainty::even(0.1_deg);
    using Change = std::function<SampleSet(const SampleSet&, const TiltEstimate&)>;
    for (const Change& change : {Change(withTiltUncertainty), Change(tiltCorrected)}) {
        const auto with = [&](const TiltEstimate& estimate) {
            return addedOnTheFlank(flat,
                                   [&](const SampleSet& set) { return change(set, estimate); });
        };
        EXPECT_GT(with(wavy), 0.01);
        EXPECT_NEAR(with(wavy), with(unsure), 1e-9);
    }
}

}  // namespace
}  // namespace gonio::proc
