#pragma once
// Two-reference calibration (radiometry.md 2.3). With S, S_w, S_b the binned signals of sample,
// white and black, and f_w, f_b what the certificates say:
//     f = f_b + (f_w - f_b) q,   q = (S - S_b) / (S_w - S_b).
// With a zero reference (a light trap, f_z = 0 known to an absolute u_z) that takes the black's
// place:
//     f = f_w q,   q = (S - S_z) / (S_w - S_z),   and (1 - q) u_z stands where (1 - q) u(f_b)
//     stood.
// The black is then no input. Weighted in by inverse variance it would take 5 % off u_z at best
// (3.2e-5 against 1e-5 / sr), and give up the one independent witness of the trap (radiometry.md
// 0.4, 5.1). Uncertainties are first order. Random: the noise of the three signals. Systematic:
// white, common and per direction, by q f_w; black or zero by (1 - q) u(f_b); the lens map's angle
// by the local slope of f; the glare that the three signals were put right by, known to g, h and k,
// by |df/dS| sqrt(g^2 + (q h)^2 + ((1 - q) k)^2); and the drift of the LED. Each of the three
// captures was lit with a relative error of its own, independent, of the size d that the rig is
// known for, and a signal is as wrong as its light:
//     u = d |df/dS| sqrt(S^2 + (q S_w)^2 + ((1 - q) S_b)^2),
// sqrt(2) d f where sample and white are far brighter than black; all cells of a state share it.
// A pixel shows the mean over its side p, and is shared out to cells as if alike all over: two
// boxes, each of variance p^2 / 12 along either axis, add p^2 / 12 times the Laplacian of f. So
// much is taken as a standard uncertainty and not put right: it is 0.3 % of the top of a lobe of
// one degree, and less than noise makes of second differences elsewhere. What is left of the
// sensor's non-linearity and of the exposures' ratios changes with brightness: each capture has a
// relative error of its own of these, and they go in as drift does.
//
// Where first order is wrong (monte_carlo.h), and in all cells on request, the uncertainties are
// those of a propagation of distributions instead; f stays.
//
// A cell that is missing in any of the three is missing here, with the flags of all. Where white is
// not brighter than black by 5 sigma the cell is missing and BelowNoise: nothing can be said there.
// Negative f survives; |f| < 2 u_random is flagged BelowNoise.

#include <cstddef>
#include <optional>
#include <span>

#include "proc/calibrate/budget.h"
#include "proc/calibrate/cell_samples.h"
#include "proc/calibrate/monte_carlo.h"
#include "proc/calibrate/reference.h"
#include "proc/optics/binning.h"

namespace gonio::proc {

/// What one state's signal is held against: the white, and the black or the zero reference, after
/// whose certificate's name the budget calls it.
struct References {
    const CellSignal& whiteSignal;
    const CellSignal& blackSignal;
    const ReferenceTable& white;
    const ReferenceTable& black;
};

/// Standard uncertainty of the direction of each cell of CellGrid.
using AngleUncertainty = std::span<const DirectionSpread>;

/// What the rig adds to the uncertainty by itself.
struct RigUncertainty {
    AngleUncertainty angle;
    double ledDrift = 0;                   ///< d: relative standard size, k = 1
    double exposureRatio = 0;              ///< relative, k = 1: of an effective exposure time
    double linearity = 0;                  ///< relative, k = 1: what is left of the non-linearity
    std::optional<double> angleFreedom{};  ///< degrees of freedom of `angle`
};

struct Calibrated {
    CellSamples samples;
    Budget budget;
    std::size_t propagated = 0;  ///< cells whose uncertainty is that of Monte Carlo
};

/// All signals run over CellGrid. `wi` has phi = 0.
[[nodiscard]] Calibrated calibrate(const CellSignal& sample,
                                   const References& references,
                                   const Direction& wi,
                                   Band band,
                                   const RigUncertainty& rig,
                                   const MonteCarlo& monteCarlo = {});

}  // namespace gonio::proc
