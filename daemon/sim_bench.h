#pragma once
// The simulated rig of a store: what it is and what lies under it is kept in sim.json, so that it
// is still there when the daemon comes back, as a rig on a table would be.
//
// Its systematic errors are those of the references and the drift of the LEDs: with "none" there
// are neither, with "random" and "stratum:K" the LEDs drift by 0.2 % (standard size), as the rig
// profiles say. All else that is wrong is what its rig errors say (sim/rig_errors.h), which may
// change the drift too, and what is wrong with the sample (sim/sample_errors.h); none at first.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "daemon/store.h"
#include "proc/core/scatterer.h"
#include "proc/table/sample_set.h"
#include "sim/faults/fault_script.h"
#include "sim/in_process.h"

namespace gonio::daemon {

struct SimState {
    std::string serial = "SIM-0001";
    std::uint64_t seed = 1;
    std::string systematic = "random";  ///< errors: none, random, stratum:K
    std::string placed = "nothing";     ///< nothing, black, white, zero, mirror, or F
    sim::Wedge wedge;
    std::string rigErrors = "none";  ///< as on the command line: sim/rig_errors.h
    sim::SampleErrors sampleErrors;
    Radians turned{};  ///< the white or the sample, about its normal
};

/// What is no sample: nothing, black, white, zero or mirror.
[[nodiscard]] bool isReference(const std::string& placed);

/// The defaults when there is no sim.json yet.
[[nodiscard]] Result<SimState> readSimState(const Store& store);
Result<void> writeSimState(const Store& store, const SimState& state);

/// What `placed` names, ready to be put under the rig. Black and white are the certified references
/// of the rig profile; their errors are the simulator's.
[[nodiscard]] Result<sim::Placement> makePlacement(const SimState& state, const Store& store);

/// What a measurement says of the rig and the sample that it was made of.
void describe(const SimState& state, proc::SampleInfo& info);

/// What a perfect measurement of a described sample gives: what was placed, flat, opaque, relaxed
/// and in the dark, in the mixture of its bands that the rig's cross-talk makes. Usage error where
/// it is no sample of a simulated rig; `store` as in openMaterial.
[[nodiscard]] Result<std::shared_ptr<const Scatterer>> truthOf(const proc::SampleInfo& info,
                                                               const std::filesystem::path& store);

/// The rig that the state says. `cameraUsb` is 2 or 3, as the rig profile says.
[[nodiscard]] Result<sim::DeviceConfig> simDevice(const SimState& state, int cameraUsb = 2);

/// A fault script (docs/fault-scripts.md); errors name the file and the line.
[[nodiscard]] Result<sim::FaultScript> readFaults(const std::filesystem::path& file);

/// A rig as the state says, with its placement under it and a camera of this USB (2 or 3, as the
/// rig profile says).
[[nodiscard]] Result<std::unique_ptr<sim::InProcessDoor>> openSim(const SimState& state,
                                                                  const Store& store,
                                                                  int cameraUsb = 2);

}  // namespace gonio::daemon
