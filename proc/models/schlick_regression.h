#pragma once
// The regression by which a cubic of Schlick's form was proposed for cos^n [Zavalniuk2024], done
// again.

#include <cstddef>

namespace gonio::proc {

struct RegressionGrid {
    int powers = 1000;  ///< n = 1, 2 .. powers
    int angles = 1571;  ///< theta = 0, step .. step (angles - 1)
    double thetaStep = 0.001;
};

/// a s^3 + b s^2 + c s + d, s Schlick's form, nearest to cos^n by least squares.
struct SchlickRegression {
    double a = 0;
    double b = 0;
    double c = 0;
    double d = 0;
    double rms = 0;
    std::size_t rows = 0;
};

/// By orthogonal transformations, one n at a time: the sums of sixth powers that the paper inverts
/// lose half of the digits. At least four rows.
[[nodiscard]] SchlickRegression regressSchlick(const RegressionGrid& grid = {});

}  // namespace gonio::proc
