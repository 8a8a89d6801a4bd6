#pragma once
// Gain and read noise of a sensor from pairs of frames of the same steady light, at several
// exposures or levels [EMVA2021, sec. 2]. Of a pair, half the variance of the difference is the
// variance of one frame, free of what each pixel sees of its own (non-uniformity, a scene that is
// not flat); of shot noise and read noise it is linear in the mean m above the black level:
//     variance = m / K + s_r^2 / K^2 + 1 / 12      (DN^2; K electrons per DN, s_r electrons)
// K comes from the slope, s_r from what is left at m = 0. The line is fitted with weights from the
// line itself, never from the noisy variances, which would pull it down.
//
// Saturated pixels are left out by the mask of saturation.h; a pair with fewer than 1000 usable
// pixels says nothing. Where a dark pair is given, the one of the shortest exposure has m = 0 as
// its black level; else the frames' own black level has. A change of the light between the two
// frames of a pair cancels but for its square.

#include <cstddef>
#include <span>

#include "proc/core/frame.h"
#include "proc/core/result.h"
#include "proc/radiance/noise.h"

namespace gonio::proc {

/// Two frames taken alike, lit or dark.
struct FlatPair {
    const Frame* first = nullptr;
    const Frame* second = nullptr;
};

struct PhotonTransfer {
    double electronsPerDn = 0, uElectronsPerDn = 0;          ///< K
    double readNoiseElectrons = 0, uReadNoiseElectrons = 0;  ///< s_r; 0 where rounding explains all
    double chiSquare = 0;                                    ///< of the variances about the line
    std::size_t freedom = 0;
    int pairs = 0;  ///< that were used
};

/// `noise` gives full scale only. Quality error when the frames of a pair are not alike, fewer than
/// three pairs of different light (means 1 DN apart) are usable, or the variance does not rise with
/// the mean.
[[nodiscard]] Result<PhotonTransfer> photonTransfer(std::span<const FlatPair> pairs,
                                                    const SensorNoise& noise);

}  // namespace gonio::proc
