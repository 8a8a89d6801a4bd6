#pragma once
// The forms of powers.h held against cos^n.
//
// A form is evaluated at c and t of its own number type, and the truth is (1 - t)^n of these (c^n
// where c <= 1/2) in extended precision: errors are the form's and its arithmetic's, not those of
// the input. The epicentre is theta in [0, atan(1 / sqrt(n - 1))], n > 1: out to where the curve
// cos^n(theta) turns.

#include <functional>
#include <span>
#include <vector>

#include "proc/core/units.h"
#include "proc/models/analytic.h"
#include "proc/models/powers.h"

namespace gonio::proc {

/// How finely n and theta are sampled.
struct PowerGrid {
    int powerStep = 1;     ///< of n = 8, 9 .. 1000; both ends always
    int otherPowers = 60;  ///< n in [1, 8) and as many in (1000, 1e6], geometric
    int epicentre = 200;
    int lobe = 600;  ///< angles with n t <= 40
    int rest = 60;   ///< and out to pi / 2

    [[nodiscard]] static PowerGrid quick();
};

/// At one n.
struct PowerError {
    double epicentre = 0;  ///< largest |f - cos^n| / cos^n there
    double absolute = 0;   ///< largest |f - cos^n| over [0, pi / 2]
};
[[nodiscard]] std::vector<PowerError> powerErrorsAt(double n,
                                                    std::span<const PowerForm> forms,
                                                    const PowerGrid& grid = {});
/// Largest relative error out to `theta`, in double.
[[nodiscard]] double relativeErrorWithin(PowerForm form, double n, Radians theta);

/// Over a range of n.
struct PowerErrors {
    PowerForm form = PowerForm::Pow;
    Precision precision = Precision::Double;
    double epicentre = 0;      ///< n in 8..1000
    double absolute = 0;       ///< n in 8..1000
    double belowEight = 0;     ///< absolute, n in [1, 8)
    double aboveThousand = 0;  ///< absolute, n in (1000, 1e6]
    double peak = 1;           ///< f at theta = 0, of those with n in 8..1000 the farthest from 1
    double least = 0;          ///< least value, n in 8..1000
    double residue = 0;        ///< largest error where cos^n < 1e-6, n in 8..1000

    [[nodiscard]] double anyPower() const;
    [[nodiscard]] double fromEight() const;
};

/// Told before each step: how many there will be, and how many are done.
using StudyProgress = std::function<void(std::size_t done, std::size_t steps)>;

/// n = 8, 9 .. 1000 by the grid's step, both ends included.
[[nodiscard]] std::vector<double> publishedPowers(const PowerGrid& grid);

/// All forms in both precisions, a step for each n.
[[nodiscard]] std::vector<PowerErrors> powerErrors(const PowerGrid& grid,
                                                   const StudyProgress& progress = {});

}  // namespace gonio::proc
