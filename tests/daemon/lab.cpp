#include "tests/daemon/lab.h"

#include <gtest/gtest.h>

#include "daemon/planned_run.h"
#include "sim/reference_errors.h"
#include "sim/rig_errors.h"

namespace gonio::daemon::test {
namespace {

constexpr int kDarkFrames = 4;

}  // namespace

Lab::Lab(const std::string& rigErrors,
         const std::string& systematic,
         std::uint64_t seed,
         int frames,
         sim::DeviceConfig kind)
    : frames_(frames) {
    auto profile = readProfile(defaultProfile());
    EXPECT_TRUE(profile) << profile.error().message;
    profile_ = std::move(*profile);
    auto certified = loadReferences(profile_);
    EXPECT_TRUE(certified) << certified.error().message;
    certified_ = std::move(*certified);
    const auto rig = sim::parseRigErrors(rigErrors, {});
    EXPECT_TRUE(rig) << rig.error().message;
    const auto errors = sim::ReferenceErrors::parse(systematic, seed);
    EXPECT_TRUE(errors) << errors.error().message;
    kind.seed = seed;
    kind.errors = *errors;
    kind.rig = *rig;
    door_ = std::make_unique<sim::InProcessDoor>(kind);
    auto opened = driver::Rig::open(*door_, seed);
    EXPECT_TRUE(opened) << opened.error().message;
    rig_.emplace(std::move(*opened));
}

Bench Lab::bench() {
    return {.rig = *rig_,
            .profile = profile_,
            .nextPlanStep = nextPlanStep_,
            .clock = computer_,
            .step = [](const std::string&) { return Result<void>(); }};
}

void Lab::calibrateMirror() {
    auto lens = measureLens(bench(), [&](const proc::Wedge& wedge) -> Result<void> {
        door_->device().place(
            {.role = sim::Role::Mirror, .surface = nullptr, .wedge = {wedge.aboutX, wedge.aboutY}});
        return {};
    });
    ASSERT_TRUE(lens) << lens.error().message;
    lens_ = std::move(*lens);
}

void Lab::place(const std::string& what) {
    sim::Placement placement{.role = sim::Role::Sample, .surface = nullptr, .wedge = {}};
    if (what == "zero") {
        placement.role = sim::Role::Zero;
    } else if (what == "white" || what == "black") {
        placement.role = what == "white" ? sim::Role::White : sim::Role::Black;
        placement.surface = what == "white" ? certified_->white : certified_->black;
    } else {
        auto model = proc::makeModel(what);
        EXPECT_TRUE(model) << model.error().message;
        placement.surface = std::move(*model);
    }
    door_->device().place(std::move(placement));
}

std::vector<proc::DarkFrame> Lab::meanDarks() {
    std::vector<proc::DarkFrame> darks;
    for (const Microseconds exposure : profile_.exposures) {
        const auto taken = rig_->capture(
            {.planStep = nextPlanStep_++, .exposure = exposure, .frames = kDarkFrames});
        EXPECT_TRUE(taken) << taken.error().message;
        auto mean = proc::averageDark(taken->frames, profile_.noise);
        EXPECT_TRUE(mean) << mean.error().message;
        darks.push_back(std::move(*mean));
    }
    return darks;
}

Lab::Planned Lab::planned(const std::string& what,
                          const CaptureGoal& goal,
                          const std::string& faults,
                          Darks darks) {
    constexpr std::uint64_t kFirstStep = 1'000'000;  // behind whatever was taken before
    place(what);
    EXPECT_TRUE(configureWindow(*rig_));
    nextPlanStep_ = kFirstStep;
    Planned made;
    Bench here = bench();
    if (darks == Darks::Held) here.darks = meanDarks();
    here.glare = lens_->glare;
    here.attendance.setback = [&](const Setback& one) { made.setbacks.push_back(one); };
    const RigReferences references = this->references(Lower::Black);
    PlannedRun run(here, references, goal.plan());
    auto script = sim::FaultScript::parse(faults);
    EXPECT_TRUE(script) << script.error().message;
    door_->usb().play(std::move(*script));
    const auto plan = run.plan();
    EXPECT_TRUE(plan) << plan.error().message;
    auto captured = run.capture();
    EXPECT_TRUE(captured) << captured.error().message;
    door_->usb().play({});
    made.captured = std::move(*captured);
    return made;
}

Lab::Frames Lab::frames(const std::string& what, const BracketPlan& plan) {
    place(what);
    EXPECT_TRUE(configureWindow(*rig_));
    Sequencer sequencer(*rig_, profile_, nextPlanStep_);
    Frames frames;
    auto darks = sequencer.darks(kDarkFrames, [] { return Result<void>(); });
    EXPECT_TRUE(darks) << darks.error().message;
    frames.darks = std::move(*darks);
    for (const State state : sequencer.states()) {
        Bracket& bracket = frames.brackets.emplace_back();
        bracket.state = state;
        const auto taken =
            sequencer.bracket(state, plan, {.frame = [&](const Frame& frame) -> Result<void> {
                                  bracket.frames.push_back(frame);
                                  return {};
                              }});
        EXPECT_TRUE(taken) << taken.error().message;
    }
    return frames;
}

Lab::Seen Lab::seen(const std::string& what, const BracketPlan& plan) {
    place(what);
    Bench here = bench();
    here.glare = lens_->glare;
    auto captured = measurePlacement(here, lens_->fit.map, plan, kDarkFrames);
    EXPECT_TRUE(captured) << captured.error().message;
    Seen seen{.clean = std::move(captured->signals), .glaring = {}};
    seen.glaring.resize(seen.clean.size());
    const Window& window = captured->raw.states.front().merged.window;
    const proc::Binning binning(lens_->fit.map, window, kField);
    for (const proc::RawState& state : captured->raw.states) {
        seen.glaring[static_cast<std::size_t>(state.merged.led)][index(state.merged.band)] =
            binning.bin(state.merged);
    }
    return seen;
}

Lab::BothWays Lab::reference(const std::string& what, const BracketPlan& plan) {
    Seen both = seen(what, plan);
    return {ReferenceRecord{.info = {.name = what}, .signals = std::move(both.clean)},
            ReferenceRecord{.info = {.name = what}, .signals = std::move(both.glaring)}};
}

void Lab::calibrateBlack() {
    black_ = reference("black", {.frames = frames_, .dim = false, .first = 5});
}

void Lab::calibrateWhite() {
    white_ = reference("white", {.frames = frames_, .dim = false, .longest = 3, .first = 2});
}

void Lab::calibrateZero() {
    zero_ = reference("zero", {.frames = frames_, .dim = false, .first = 5});
}

RigReferences Lab::references(Lower lower, Glare glare) const {
    const auto way = static_cast<std::size_t>(glare);
    return {.lens = *lens_,
            .white = white_[way],
            .black = black_[way],
            .certified = *certified_,
            .profile = profile_,
            .zero = lower == Lower::Zero ? &zero_[way] : nullptr};
}

proc::SampleSet Lab::calibrated(const Seen& sample, Lower lower, Glare glare) const {
    return calibrateSample(glare == Glare::TakenOff ? sample.clean : sample.glaring,
                           ledAngles(),
                           references(lower, glare),
                           {.name = "x"});
}

}  // namespace gonio::daemon::test
