#pragma once
// The black reference as a witness of the zero reference: measured with white and zero like a
// sample, it must show the f of its certificate. Where both hold, the two agree within what the
// certificates say; where not, one of them is dirty, or was not what lay under the rig.

#include <optional>
#include <string>
#include <vector>

#include "daemon/measurement.h"

namespace gonio::daemon {

struct BlackCheck {
    double measured =
        0;  ///< f of the black, 1/sr: the median over all cells, under every LED's green
    double certified = 0;  ///< 1/sr, likewise
    double u = 0;  ///< of their difference, k = 1: the certificates of both, common to all cells

    /// Within k = 2.
    [[nodiscard]] bool agrees() const;
    /// "black shows f = 3.1e-04 / sr (k = 1: 3.3e-05), its certificate says 3.2e-04 / sr".
    [[nodiscard]] std::string described() const;
};

/// Empty without a zero reference, or where no cell is seen in all three.
[[nodiscard]] std::optional<BlackCheck> checkBlack(const RigReferences& references,
                                                   const std::vector<Radians>& ledAngles);

/// Says in a sample's information what came of it, "black_check", or takes out what stood there; a
/// warning where they do not agree.
void noteBlackCheck(const std::optional<BlackCheck>& check, proc::SampleInfo& info);

}  // namespace gonio::daemon
