#pragma once
// A calibrated simulated rig in this process: the references taken, samples measured, the truth
// known. What a job of the daemon does, without store and daemon.

#include <memory>
#include <optional>
#include <string>

#include "daemon/measurement.h"
#include "driver/steady_clock.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"

namespace gonio::daemon::test {

class Lab {
public:
    /// `rigErrors` as on the command line; `systematic`: none, random, ... (references).
    Lab(const std::string& rigErrors, const std::string& systematic, std::uint64_t seed);

    /// Takes the lens map.
    void calibrateMirror();
    /// The signals of a reference, or of a sample by its model.
    [[nodiscard]] Captured captured(const std::string& what, const BracketPlan& plan);
    void calibrateBlack() { black_ = reference("black", {.frames = 8, .dim = false, .first = 5}); }
    void calibrateWhite() {
        white_ = reference("white", {.frames = 8, .dim = false, .longest = 3, .first = 2});
    }
    void calibrateZero() { zero_ = reference("zero", {.frames = 8, .dim = false, .first = 5}); }

    /// What the references say of these signals; with the zero reference if `zero`.
    [[nodiscard]] proc::SampleSet calibrated(const PlacementSignals& signals, bool zero) const;
    [[nodiscard]] RigReferences references(bool zero) const;

    [[nodiscard]] const std::optional<LensRecord>& lens() const { return lens_; }
    [[nodiscard]] LensRecord& lens() { return *lens_; }
    [[nodiscard]] std::vector<Radians> ledAngles() const { return rig_->identify().ledAngles; }

private:
    [[nodiscard]] Bench bench();
    [[nodiscard]] ReferenceRecord reference(const std::string& what, const BracketPlan& plan);

    RigProfile profile_;
    std::optional<References> certified_;
    driver::SteadyClock computer_;
    std::unique_ptr<sim::InProcessDoor> door_;
    std::optional<driver::Rig> rig_;
    std::uint64_t nextPlanStep_ = 1;
    std::optional<LensRecord> lens_;
    ReferenceRecord white_, black_, zero_;
};

}  // namespace gonio::daemon::test
