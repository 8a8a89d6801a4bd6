#pragma once
// Rotations of a sample on the rig's stage, and the parts of a set that were measured at each.
// Rotation r turns the sample by +r about its normal (counter-clockwise seen from above) under a
// fixed light. Two rotations within 0.01 degrees of each other, over the full turn, are the same.

#include <vector>

#include "proc/table/sample_set.h"

namespace gonio::proc {

/// In [0, 2 pi), from degrees of a file or a person: -90 and 270 are the same to the bit, 360 is 0.
/// `degrees` is finite; what is below 1e-9 degrees is rounded off.
[[nodiscard]] Radians rotationOf(double degrees);

[[nodiscard]] bool sameRotation(Radians a, Radians b);

/// To half a degree: the same LED.
[[nodiscard]] bool sameIncidence(Radians a, Radians b);
/// The same LED at the same rotation.
[[nodiscard]] bool sameLight(const LedTable& a, const LedTable& b);

/// Of the LEDs, ascending, each once.
[[nodiscard]] std::vector<Radians> rotationsOf(const SampleSet& set);

/// Gives all tables of a set this rotation.
void turnTo(SampleSet& set, Radians rotation);
/// The set in the rig's frame: as an isotropic sample, which does not feel how it lies.
[[nodiscard]] SampleSet unturned(SampleSet set);

/// Tables by ascending rotation, then incidence.
void sortTables(SampleSet& set);

}  // namespace gonio::proc
