// The bad samples that a contact scatterometer meets, on the simulated rig in virtual time: each is
// caught by the verdict that is about it, and good samples on a rig with all its usual errors by
// none.

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "daemon/material.h"
#include "daemon/merging.h"
#include "daemon/references.h"
#include "daemon/sample_quality.h"
#include "daemon/score.h"
#include "driver/steady_clock.h"
#include "proc/core/number_text.h"
#include "proc/optics/binning.h"
#include "proc/quality/verdict.h"
#include "proc/radiance/merge.h"
#include "proc/table/rotations.h"
#include "proc/table/sample_lookup.h"
#include "sim/in_process.h"
#include "sim/optics.h"
#include "sim/rig_errors.h"
#include "tests/daemon/bracket_of.h"

namespace gonio::daemon {
namespace {

using proc::Grade;

constexpr int kDarkFrames = 2;
constexpr State kFirst{0, Band::R};
const sim::ImagePoint kMiddle{640, 512};

/// The lens map as a calibration with mirrors would find it: spots where the simulated lens puts
/// them.
proc::LensFit fittedLens(const RigProfile& profile, const driver::Rig& rig) {
    const std::vector<Radians> leds = rig.identify().ledAngles;
    const sim::Optics optics(rig.identify().serial, kMiddle);
    std::vector<proc::MirrorSpot> spots;
    for (const proc::Wedge& wedge : proc::mirrorWedges()) {
        for (const Radians led : leds) {
            const Direction light = Direction::fromSpherical(led, Radians(0));
            const Direction seen = proc::mirroredBy(wedge, light);
            if (seen.theta() > 75_deg) continue;
            const sim::ImagePoint at = optics.pixelOf(seen);
            spots.push_back({.wedge = wedge, .light = light, .at = {at.x, at.y}, .sigma = 0.02});
        }
    }
    auto fit = proc::fitLens(spots, {kMiddle.x, kMiddle.y}, 6.6, profile.wedgeTolerance);
    EXPECT_TRUE(fit) << fit.error().message;
    return std::move(*fit);
}

/// What lies under the rig, and how it is measured.
struct Placed {
    std::string what;
    sim::Wedge wedge{};
    sim::SampleErrors errors{};
    Radians turned{};
    BracketPlan plan{.frames = 1, .longest = 2};
};

/// A calibrated rig with some errors of its own.
class Lab {
public:
    explicit Lab(const std::string& rigErrors, std::uint64_t seed = 11) {
        profile_ = std::move(*readProfile(defaultProfile()));
        certified_ = *loadReferences(profile_);
        door_ = std::make_unique<sim::InProcessDoor>(
            sim::DeviceConfig{.serial = "SIM-" + std::to_string(1000 + seed),
                              .seed = seed,
                              .errors = *sim::ReferenceErrors::parse("random", seed),
                              .rig = *sim::parseRigErrors(rigErrors, {})});
        rig_.emplace(std::move(*driver::Rig::open(*door_, 7)));
        lens_ = LensRecord{.fit = fittedLens(profile_, *rig_), .spots = 33, .dateUtc = {}};
        black_ = tile(sim::Role::Black,
                      certified_.black,
                      {.frames = 2, .dim = false, .longest = -1, .first = 5});
        white_ = tile(sim::Role::White,
                      certified_.white,
                      {.frames = 2, .dim = false, .longest = 3, .first = 2});
    }

    /// Measured and judged as the daemon does, with the first bracket repeated at the end.
    proc::SampleSet measured(const Placed& placed, const BackingEvidence& backing = {}) {
        auto material = openMaterial(placed.what, {});
        EXPECT_TRUE(material) << material.error().message;
        door_->device().place({.role = sim::Role::Sample,
                               .surface = std::move(material->scatterer),
                               .wedge = placed.wedge,
                               .turned = placed.turned,
                               .errors = placed.errors});
        const std::vector<Frame> before = firstBracket(placed.plan);
        Captured captured = taken(placed.plan);
        captured.repeat = {.state = kFirst,
                           .first = signalOf(before, captured.darks),
                           .last = signalOf(firstBracket(placed.plan), captured.darks)};
        const RigReferences references{*lens_, white_, black_, certified_, profile_};
        proc::SampleSet sample = calibrateSample(captured.signals, leds(), references, {});
        proc::turnTo(sample, placed.turned);
        judgeCapture(sample, captured, references);
        judgeTable(sample, {});
        judgeBacking(sample, backing, {});
        return sample;
    }

private:
    [[nodiscard]] std::vector<Radians> leds() const { return rig_->identify().ledAngles; }

    Captured taken(const BracketPlan& plan) {
        auto captured =
            measurePlacement({.rig = *rig_,
                              .profile = profile_,
                              .nextPlanStep = nextPlanStep_,
                              .clock = computer_,
                              .step = [](const std::string&) { return Result<void>(); }},
                             lens_->fit.map,
                             plan,
                             kDarkFrames);
        EXPECT_TRUE(captured) << captured.error().message;
        return std::move(*captured);
    }

    ReferenceRecord tile(sim::Role role,
                         std::shared_ptr<const Scatterer> surface,
                         const BracketPlan& plan) {
        door_->device().place({.role = role, .surface = std::move(surface), .wedge = {}});
        return {.info = {}, .signals = taken(plan).signals};
    }

    std::vector<Frame> firstBracket(const BracketPlan& plan) {
        EXPECT_TRUE(configureWindow(*rig_));
        Sequencer sequencer(*rig_, profile_, nextPlanStep_);
        auto frames = test::bracketOf(sequencer, kFirst, plan);
        EXPECT_TRUE(frames) << frames.error().message;
        return std::move(*frames);
    }
    [[nodiscard]] proc::CellSignal signalOf(const std::vector<Frame>& frames,
                                            const proc::DarkLibrary& darks) const {
        const auto merged = proc::merge(frames, kFirst.band, darks, profile_.noise);
        EXPECT_TRUE(merged) << merged.error().message;
        return proc::Binning(lens_->fit.map, frames.front().window, kField).bin(*merged);
    }

    RigProfile profile_;
    References certified_;
    driver::SteadyClock computer_;
    std::unique_ptr<sim::InProcessDoor> door_;
    std::optional<driver::Rig> rig_;
    std::uint64_t nextPlanStep_ = 1;
    std::optional<LensRecord> lens_;
    ReferenceRecord white_, black_;
};

proc::Verdict verdictOf(const proc::SampleSet& sample, const std::string& name) {
    for (const proc::Verdict& one : proc::readVerdicts(sample.info.qcVerdicts)) {
        if (one.name == name) return one;
    }
    ADD_FAILURE() << "no verdict '" << name << "'";
    return {};
}

void print(const std::string& what, const proc::SampleSet& sample) {
    std::cout << what << "\n";
    for (const proc::Verdict& one : proc::readVerdicts(sample.info.qcVerdicts)) {
        std::cout << "  " << proc::described(one) << std::endl;
    }
}

void expectAllGood(Lab& lab) {
    for (const std::string& what :
         {std::string(GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf"),
          std::string("model:oren-nayar,albedo=0.8,sigma=0.3"),
          std::string("model:lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04"),
          std::string("model:ggx,alpha=0.05,f0=0.9/0.7/0.4")}) {
        const proc::SampleSet sample = lab.measured({.what = what});
        print(what, sample);
        for (const proc::Verdict& one : proc::readVerdicts(sample.info.qcVerdicts)) {
            // The scans of the real black are not reciprocal themselves.
            if (one.name == "reciprocity" && what.ends_with(".bsdf")) continue;
            EXPECT_TRUE(one.grade == Grade::Ok || one.grade == Grade::NotDetermined)
                << what << ": " << proc::described(one);
        }
        EXPECT_TRUE(accepted(sample, false));
    }
}

/// What is cheap to simulate of all that is usual.
const std::string kQuickErrors = "drift,offset_us,column_e,inl";

/// With GONIO_NIGHTLY, for the rate of false alarms: ten rigs with all that is usually wrong.
/// MeasureRun measures the same samples in any case, and none may be refused there.
TEST(QualityRun, GoodSamplesPassEachVerdict) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "a nightly study of ten rigs";
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("rig " + std::to_string(seed));
        Lab lab("typical", seed);
        expectAllGood(lab);
    }
}

struct Bad {
    const char* why;
    Placed placed;
    std::string verdict;
    Grade grade;
};

const std::string kFabric = "model:oren-nayar,albedo=0.2,sigma=0.3+ggx,alpha=0.2,f0=0.08";
const std::string kWood = "model:lambert,albedo=0.4/0.25/0.12+ggx,alpha=0.3,f0=0.05";
const std::string kPlaster = "model:lambert,albedo=0.4+ggx,alpha=0.3,f0=0.1";
const std::string kPlastic = "model:lambert,albedo=0.3+ggx,alpha=0.1,f0=0.04";

const std::vector<Bad> kBad{
    {"fabric with coarse threads",
     {.what = kFabric, .errors = {.waviness = 2_deg}},
     "waviness",
     Grade::Refused},
    {"wood with pronounced rings",
     {.what = kWood, .errors = {.waviness = 2_deg}},
     "waviness",
     Grade::Refused},
    {"polished plaster with waves",
     {.what = kPlaster, .errors = {.waviness = 2_deg}},
     "waviness",
     Grade::Refused},
    {"tilted", {.what = kPlastic, .wedge = {.aboutX = 1.5_deg}}, "tilt", Grade::Warned},
    {"softshell that yields",
     {.what = kFabric, .errors = {.softness = 0.6}},
     "softness",
     Grade::Refused},
    {"light from the room",
     {.what = kPlastic, .errors = {.ambient = 1e-4}},
     "ambient",
     Grade::Warned},
    {"a lamp beside it",
     {.what = kPlastic, .errors = {.ambient = 0.002}},
     "ambient",
     Grade::Refused},
    {"polished metal, without dimmer LEDs",
     {.what = "model:ggx,alpha=0.01,f0=0.9", .plan = {.frames = 1, .dim = false, .longest = 2}},
     "saturation",
     Grade::Warned},
};

/// A brushed metal, turned on the stage, becomes one sample that holds the truth within its
/// uncertainty and answers for the light's azimuth. Taken as isotropic it is warned of; across the
/// plane of incidence it is skew where the grain is.
void expectBrushedMerges(Lab& lab) {
    const std::string brushed =
        "model:lambert,albedo=0.2/0.1/0.05+ggx,alpha_x=0.2,alpha_y=0.35,f0=0.5";
    std::vector<MergeInput> turned;
    for (const Radians rotation : {0_deg, 45_deg, 90_deg}) {
        turned.push_back(
            {.file = fixed(rotation.degrees(), 0),
             .sample = lab.measured({.what = brushed,
                                     .turned = rotation,
                                     .plan = {.frames = 1, .dim = false, .longest = 1}}),
             .values = {},
             .band = {}});
        const auto skew = verdictOf(*turned.back().sample, "plane symmetry");
        EXPECT_EQ(skew.grade, rotation == 45_deg ? Grade::Warned : Grade::Ok)
            << proc::described(skew);
    }
    const Result<Merged> whole = merged(turned, {});
    ASSERT_TRUE(whole) << whole.error().message;
    print("brushed", whole->sample);
    EXPECT_EQ(verdictOf(whole->sample, "isotropy").grade, Grade::Warned);
    const auto truth = openMaterial(brushed, {});
    const Score held = score(whole->sample, *truth->scatterer);
    std::cout << "  " << held.cells << " cells, median error " << held.medianRelativeError
              << ", within 2 u " << held.within2u << std::endl;
    EXPECT_GT(held.cells, 500'000);
    EXPECT_GE(held.within2u, 0.95);
    EXPECT_LE(held.medianRelativeError, 0.01);

    // Light from azimuth -45 was there at rotation 45; from 0 the same view is another pair.
    const proc::SampleLookup lookup(whole->sample);
    const auto at = [](double phi) {
        return LightView{
            .in = Direction::fromSpherical(40_deg, Radians::fromDegrees(phi)),
            .out = Direction::fromSpherical(50.5_deg, Radians::fromDegrees(phi + 195))};
    };
    double before = 0;
    for (const double phi : {-45.0, 0.0}) {
        const Answer found = lookup.answer(at(phi)), wanted = truth->scatterer->answer(at(phi));
        for (const Band band : kBands)
            EXPECT_NEAR(found.f[band], wanted.f[band], 3 * *found.u(band)) << phi;
        EXPECT_GT(std::abs(wanted.f[Band::G] - before), 0.1 * wanted.f[Band::G]);
        before = wanted.f[Band::G];
    }
}

/// A matt plaster would show no lobe, and so neither waves nor harm by them.
TEST(QualityRun, EachBadSampleIsCaughtByTheVerdictThatIsAboutIt) {
    Lab lab(kQuickErrors);
    for (const Bad& bad : kBad) {
        SCOPED_TRACE(bad.why);
        const proc::SampleSet sample = lab.measured(bad.placed);
        print(bad.why, sample);
        const proc::Verdict verdict = verdictOf(sample, bad.verdict);
        EXPECT_EQ(verdict.grade, bad.grade) << proc::described(verdict);
        EXPECT_FALSE(verdict.next.empty());
        const Result<void> passed = accepted(sample, false);
        EXPECT_EQ(static_cast<bool>(passed), bad.grade != Grade::Refused);
        if (!passed) {
            EXPECT_EQ(passed.error().kind, ErrorKind::Quality);
            EXPECT_NE(passed.error().message.find(verdict.evidence), std::string::npos);
        }
        EXPECT_TRUE(accepted(sample, true)) << "forced";
    }
    expectBrushedMerges(lab);
}

TEST(QualityRun, TranslucentSamplesAreCaughtByTheOtherBacking) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "a nightly study of a minute";
    using proc::Backing;
    Lab lab(kQuickErrors);
    const auto on = [&](Backing backing, double t, std::optional<proc::SampleSet> other) {
        const auto below = backing == Backing::White ? sim::Backing::White : sim::Backing::Black;
        return lab.measured(
            {.what = "model:lambert,albedo=0.5", .errors = {.translucency = t, .backing = below}},
            {.backing = backing, .other = std::move(other)});
    };
    const proc::SampleSet onBlack = on(Backing::Black, 0.1, {});
    EXPECT_EQ(verdictOf(onBlack, "translucency").grade, Grade::NotDetermined);
    const proc::SampleSet onWhite = on(Backing::White, 0.1, onBlack);
    print("translucent, on white", onWhite);
    const proc::Verdict refused = verdictOf(onWhite, "translucency");
    EXPECT_EQ(refused.grade, Grade::Refused) << proc::described(refused);
    ASSERT_TRUE(refused.figure && refused.figure->u);
    // The share of red that a white backing of 0.9 sends back, and a black one of 0.03.
    EXPECT_NEAR(refused.figure->value, 0.1 * (0.9 - 0.03), 3 * *refused.figure->u);
    EXPECT_EQ(refused.evidence.find("not most in red"), std::string::npos);
    EXPECT_EQ(verdictOf(on(Backing::Black, 0.1, onWhite), "translucency").grade, Grade::Warned);
    EXPECT_EQ(verdictOf(on(Backing::White, 0, onBlack), "translucency").grade, Grade::Ok);
    EXPECT_TRUE(checkOther({.backing = Backing::White, .other = onBlack}));
    EXPECT_EQ(checkOther({.backing = Backing::Black, .other = onBlack}).error().kind,
              ErrorKind::Usage);
}

}  // namespace
}  // namespace gonio::daemon
