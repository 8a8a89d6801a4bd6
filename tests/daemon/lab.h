#pragma once
// A calibrated simulated rig in this process: the references taken, samples measured, the truth
// known. What a job of the daemon does, without store and daemon.

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "daemon/capture_goal.h"
#include "daemon/measurement.h"
#include "driver/steady_clock.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"

namespace gonio::daemon::test {

class Lab {
public:
    /// `rigErrors` as on the command line; `systematic`: none, random, ... (references). `frames`:
    /// of each exposure of a reference; a job takes 8. `kind`: the rig, but for its errors and
    /// seed.
    Lab(const std::string& rigErrors,
        const std::string& systematic,
        std::uint64_t seed,
        int frames = 8,
        sim::DeviceConfig kind = {});

    /// Takes the lens map.
    void calibrateMirror();
    /// What was seen of a placement, with the lens's glare taken off, and with it.
    struct Seen {
        PlacementSignals clean, glaring;
    };
    /// Of a reference, or of a sample by its model.
    [[nodiscard]] Seen seen(const std::string& what, const BracketPlan& plan);
    void calibrateBlack();
    void calibrateWhite();
    void calibrateZero();

    /// What the references say of a sample: with the zero reference or without it, with the glare
    /// of all pictures taken off or left in.
    enum class Lower {
        Black,
        Zero
    };
    enum class Glare {
        TakenOff,
        LeftIn
    };
    [[nodiscard]] proc::SampleSet calibrated(const Seen& sample,
                                             Lower lower,
                                             Glare glare = Glare::TakenOff) const;
    [[nodiscard]] RigReferences references(Lower lower, Glare glare = Glare::TakenOff) const;

    /// What a plan makes of a sample, always by the same plan steps, while `faults` are played
    /// (docs/fault-scripts.md). With a dark library of today, or without.
    enum class Darks {
        Held,
        None
    };
    struct Planned {
        Captured captured;
        std::vector<Setback> setbacks;
    };
    [[nodiscard]] Planned planned(const std::string& what,
                                  const CaptureGoal& goal,
                                  const std::string& faults,
                                  Darks darks = Darks::Held);

    /// The frames of a sample, state by state, before anything is made of them.
    struct Bracket {
        State state;
        std::vector<Frame> frames;
    };
    struct Frames {
        proc::DarkLibrary darks;
        std::vector<Bracket> brackets;
    };
    [[nodiscard]] Frames frames(const std::string& what, const BracketPlan& plan);

    [[nodiscard]] const RigProfile& profile() const { return profile_; }
    [[nodiscard]] const std::optional<LensRecord>& lens() const { return lens_; }
    [[nodiscard]] std::vector<Radians> ledAngles() const { return rig_->identify().ledAngles; }

private:
    [[nodiscard]] Bench bench();
    void place(const std::string& what);
    [[nodiscard]] std::vector<proc::DarkFrame> meanDarks();
    /// By Glare.
    using BothWays = std::array<ReferenceRecord, 2>;
    [[nodiscard]] BothWays reference(const std::string& what, const BracketPlan& plan);

    RigProfile profile_;
    std::optional<References> certified_;
    driver::SteadyClock computer_;
    std::unique_ptr<sim::InProcessDoor> door_;
    std::optional<driver::Rig> rig_;
    std::uint64_t nextPlanStep_ = 1;
    std::optional<LensRecord> lens_;
    BothWays white_, black_, zero_;
    int frames_;
};

}  // namespace gonio::daemon::test
