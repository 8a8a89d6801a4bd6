#pragma once
// How well it is known where a cell lies against the lobe of its LED, once the sample's tilt was
// found from the lobes and taken off. An error e of the lens map's parameters shows the cell at w
// by S(w) e off, and the lobes, at m_l, by S(m_l) e; the normal that is fitted to them takes up
// what it can of that,
//     rho = - (sum_l w_l D_l^T D_l)^-1 sum_l w_l D_l^T S(m_l) e,   D_l = d m_l / d rho,
// w_l = 1 / u_l^2 of each LED's own normal. What is left of it is S(w) e + D_l rho. A lens map
// whose middle is off moves lobes and cells alike, and does no harm.

#include <Eigen/Core>
#include <vector>

#include "proc/optics/lens_fit.h"
#include "proc/quality/tilt.h"

namespace gonio::proc {

class SeenDirection {
public:
    /// `incidences`: of the LEDs, at phi = 0; `estimate` is of a sample that they lit.
    SeenDirection(const LensFit& lens,
                  const std::vector<Radians>& incidences,
                  const TiltEstimate& estimate);

    /// Of an LED's cell at wo. Half a turn where the map gives none.
    [[nodiscard]] DirectionSpread uncertainty(std::size_t led, const Direction& wo) const;

    /// What is left of the waves that an estimate found when the lens map's error, which shows
    /// lobes apart as waves do, is taken off: that is in `uncertainty`.
    [[nodiscard]] TurnUncertainty wavesBeyondTheMap(const TiltEstimate& estimate) const;

private:
    DirectionUncertainty lens_;
    struct Lobe {
        Eigen::Vector3d at = Eigen::Vector3d::UnitZ();    ///< m_l
        DirectionSlopes taken = DirectionSlopes::Zero();  ///< D_l rho, per unit of each parameter
    };
    std::vector<Lobe> lobes_;  ///< by LED
};

}  // namespace gonio::proc
