#pragma once
// From a rig and its calibrations to what a planner must know (proc/plan), and from what was
// captured to what a plan had promised.

#include <array>
#include <vector>

#include "daemon/measurement.h"
#include "proc/plan/planner.h"

namespace gonio::daemon {

/// Exposures as they are asked for: what the sensor grants differs by less than a line.
[[nodiscard]] proc::RigModel rigModel(const driver::RigInfo& rig,
                                      const RigProfile& profile,
                                      double sensorCelsius);

/// What the references and the rig's drift leave however many frames are taken: the components of
/// the calibration's budget (proc/calibrate/two_point.h) that the profile knows.
[[nodiscard]] proc::SystematicFloor floorOf(const RigReferences& references);

/// By white, and black or zero, what the signal of each cell means.
class Responsivities {
public:
    struct Cells {
        std::vector<double> signalPerF, dark;  ///< NaN: not known
    };
    Responsivities(const RigReferences& references, const std::vector<Radians>& ledAngles);
    [[nodiscard]] proc::Responsivity of(State state) const;

private:
    std::vector<std::array<Cells, 3>> leds_;
};

/// What was achieved, as a plan predicts it: random by the variances of the signals, systematic by
/// the floor, over the cells with f >= fMin. The Cramer-Rao part is that of no plan: NaN.
[[nodiscard]] proc::Prediction achieved(const PlacementSignals& signals,
                                        const Responsivities& responsivities,
                                        const proc::SystematicFloor& floor,
                                        double fMin);

}  // namespace gonio::daemon
