#include "tests/daemon/lab.h"

#include <gtest/gtest.h>

#include "sim/reference_errors.h"
#include "sim/rig_errors.h"

namespace gonio::daemon::test {

Lab::Lab(const std::string& rigErrors, const std::string& systematic, std::uint64_t seed) {
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
    door_ = std::make_unique<sim::InProcessDoor>(
        sim::DeviceConfig{.serial = "SIM-0001", .seed = seed, .errors = *errors, .rig = *rig});
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

Captured Lab::captured(const std::string& what, const BracketPlan& plan) {
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
    constexpr int kDarkFrames = 4;
    Bench here = bench();
    auto seen = measurePlacement(here, lens_->fit.map, plan, kDarkFrames);
    EXPECT_TRUE(seen) << seen.error().message;
    return std::move(*seen);
}

ReferenceRecord Lab::reference(const std::string& what, const BracketPlan& plan) {
    return {.info = {.name = what}, .signals = captured(what, plan).signals};
}

RigReferences Lab::references(bool zero) const {
    return {.lens = *lens_,
            .white = white_,
            .black = black_,
            .certified = *certified_,
            .profile = profile_,
            .zero = zero ? &zero_ : nullptr};
}

proc::SampleSet Lab::calibrated(const PlacementSignals& signals, bool zero) const {
    constexpr bool kForce = true;
    auto set = calibrateSample(signals, ledAngles(), references(zero), {.name = "x"}, kForce);
    EXPECT_TRUE(set) << set.error().message;
    return std::move(*set);
}

}  // namespace gonio::daemon::test
