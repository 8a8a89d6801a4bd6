#pragma once
// What a planner must know of a rig: how its sensor answers light, which LED levels and exposures
// it may use, and how long captures take as they really run (docs/decisions/0002: the next exposure
// runs while the last picture is sent). All times are those of the rig; a computer that is too slow
// counts as `planning`.
//
// A frame of exposure e occupies max(P, e + r), P the shortest frame period that the USB carries, r
// the sensor's readout. The last frame of a capture occupies at least e + h + s: h is the hand-over
// to the next capture (the frame's first chunk, then its commands), s the settling of the LED,
// which is counted whether or not the next capture changes the light. With a transfer time of at
// most P this bounds the real sequence from above: after each capture h + s lie between the end of
// its exposure and the next start, so that no picture waits for the one before the last. Dark
// frames need no settling.

#include <span>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/units.h"
#include "proc/radiance/noise.h"

namespace gonio::proc {

/// The sensor as it is during the run. Electrons and DN of one pixel.
struct SensorModel {
    SensorNoise noise;  ///< dark current at 25 degC
    double blackDn = 60;
    double fullWellElectrons = 10500;
    double celsius = 25;
    double darkDoublingKelvin = 7;
    /// Share of the usable range that the planner fills: what a cell's brightest pixel may stand
    /// above its mean.
    double headroom = 0.95;

    /// The noise with the dark current of `celsius`.
    [[nodiscard]] SensorNoise noiseNow() const;
    /// Electrons of light and dark current up to which a cell's mean counts as unsaturated.
    [[nodiscard]] double usableElectrons() const;
};

struct RigTiming {
    Seconds framePeriod{0.040};  ///< P
    Seconds readout{0.001};      ///< r
    Seconds handover{0.003};     ///< h
    Seconds ledSettle{0.005};    ///< s
    Seconds transfer{0.0394};    ///< of one picture, at most P
    Seconds planning{0.100};     ///< of the host: the last state's pilots merged, and the plan made

    /// A 1024 x 1024 picture of 12 bit, 25 a second.
    [[nodiscard]] static RigTiming usb2();
    /// The same, 60 a second.
    [[nodiscard]] static RigTiming usb3();
};

/// One kind of shot: which LED level, how long.
struct ShotKind {
    double level = 1;     ///< fraction of full
    Seconds exposure{0};  ///< granted
    bool operator==(const ShotKind&) const = default;
};

struct RigModel {
    SensorModel sensor;
    RigTiming timing;
    std::vector<double> levels;      ///< fractions of full, descending, in (0, 1]
    std::vector<Seconds> exposures;  ///< granted, ascending
    /// Dark frames of each exposure that a valid library holds; 0: the run takes its own.
    int darkFramesHeld = 0;
    /// Frames of one capture at most.
    int maxFrames = 256;
    /// The longest exposure that a pilot may have.
    Seconds longestPilot{0.050};

    /// Usage error that names the value that is out of its domain. At most 8 levels and 12
    /// exposures.
    [[nodiscard]] Result<void> check() const;
    /// One frame of each, in every state: the shortest exposure at the dimmest level (saturates
    /// last), at full level, and the longest at full level. Between the reach of one and the noise
    /// of the next there is no gap for levels and exposures as real rigs have.
    [[nodiscard]] std::vector<ShotKind> pilotShots() const;
};

/// What the captures of a run take, rounded to nanoseconds.
class ShotCost {
public:
    explicit ShotCost(const RigTiming& timing) : timing_(timing) {}

    /// A frame that another of its capture follows.
    [[nodiscard]] Nanoseconds frame(Seconds exposure) const;
    /// The last frame of a capture.
    [[nodiscard]] Nanoseconds lastFrame(Seconds exposure) const;
    /// Of `frames` frames, 0 for none.
    [[nodiscard]] Nanoseconds capture(Seconds exposure, int frames) const;
    [[nodiscard]] Nanoseconds darkCapture(Seconds exposure, int frames) const;

private:
    RigTiming timing_;
};

}  // namespace gonio::proc
