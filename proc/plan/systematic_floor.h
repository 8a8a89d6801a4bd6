#pragma once
// The uncertainty that no more frames of the sample take away, as a function of f. Its components
// are those of the calibration's budget (proc/calibrate/budget.h, with the same names), each with
// a part in proportion to f and one that is the same for every f, added in quadrature:
//     u(f)^2 = sum (r_i f)^2 + a_i^2.
// As f -> 0: the absolute parts alone, so that u / f grows without bound.

#include <string>
#include <vector>

#include "proc/calibrate/budget.h"

namespace gonio::proc {

struct FloorComponent {
    std::string name;
    Correlation correlation = Correlation::Common;
    double relative = 0;  ///< r, of f, k = 1
    double absolute = 0;  ///< a, 1/sr, k = 1
};

/// What holds f = 0: the black reference that the chain subtracts.
enum class Zero {
    BlackTile,      ///< 0.1 % reflectance, known to 10 % of itself: 3.2e-5 / sr
    ZeroReference,  ///< a light trap, known to 1e-5 / sr
};

class SystematicFloor {
public:
    SystematicFloor() = default;
    explicit SystematicFloor(std::vector<FloorComponent> components)
        : components_(std::move(components)) {}

    /// As radiometry.md 5.1 and the rig profiles have it: white 0.5 % and 0.3 % per direction, LED
    /// drift 0.2 % of each of two captures, exposure ratio 0.2 %, linearity 0.3 %, and the zero.
    [[nodiscard]] static SystematicFloor typical(Zero zero);

    /// k = 1, 1/sr.
    [[nodiscard]] double at(double f) const;
    [[nodiscard]] const std::vector<FloorComponent>& components() const { return components_; }

private:
    std::vector<FloorComponent> components_;
};

}  // namespace gonio::proc
