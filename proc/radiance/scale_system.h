#pragma once
// How much brighter than its nominal scale each of several pictures of the same scene is. Node i (a
// frame, or a group of frames) sees pixel p at the rate z_ip = (1 + d_i) x_p + noise of variance
// 1 / w_ip; x_p is not known. For small d the least squares over all x_p leaves linear equations,
//     H d = b,   H_ij = sum_p y_p zbar_p P_ij,   b_i = sum_p y_p w_ip (z_ip - zbar_p),
//     P_ij = w_ip (i = j) - w_ip w_jp / sum_k w_kp,   zbar_p = sum w_ip z_ip / sum w_ip,
// and the covariance of b is G_ij = sum_p y_p^2 P_ij. y_p is the light of the pixel's surroundings:
// with its own noise in y, b would not be zero on average where nothing differs, as noise would be
// multiplied with itself. Terms of d^2 are left out: 5 % is found as 5 % to 0.25 %. Where nodes
// share noise, W_ij (shared_noise.h) takes the place of w_i (i = j), and its row sums that of w_i.
//
// The common factor of all nodes is not in the pictures: H (1, 1, ..) = 0. Either a direction of d
// is asked for (`along`), or the nominal scales have uncertainties of their own (`solve`).

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "proc/core/image.h"
#include "proc/radiance/scale_blocks.h"
#include "proc/radiance/shared_noise.h"

namespace gonio::proc {

/// A relative difference in brightness and its standard uncertainty.
struct BrightnessOffset {
    double size = 0;
    double u = 0;
    /// In standard uncertainties, with its sign.
    [[nodiscard]] double significance() const { return size / u; }
};

class ScaleSystem {
public:
    explicit ScaleSystem(std::size_t nodes);

    /// One pixel. `light` is y_p > 0; `rate` and `weight` have one z and w per node, w = 0 where
    /// the node has none. A pixel that less than two nodes see says nothing.
    void add(double light, std::span<const double> rate, std::span<const double> weight);
    void add(double light, std::span<const double> rate, const SharedWeights& weights);
    /// A block of them, one node for each of the system's. Its slow twin is the first `add`, but
    /// for `addedAlong`, which these pixels say nothing of.
    void add(const BlockOfPixels& light, std::span<const NodeBlock* const> nodes);
    ScaleSystem& operator+=(const ScaleSystem& other);

    /// The factor s of d = s pattern that fits best; a pattern of 1 and 0 asks by how much the ones
    /// are brighter than the zeros. Empty where no pixel tells.
    [[nodiscard]] std::optional<BrightnessOffset> along(const Eigen::VectorXd& pattern) const;
    /// What `along(pattern)` finds where the nodes are brighter by `off`.
    [[nodiscard]] double seenAlong(const Eigen::VectorXd& pattern,
                                   const Eigen::VectorXd& off) const;
    /// What `along(pattern)` finds where the nodes see `added` at every pixel besides its light.
    [[nodiscard]] double addedAlong(const Eigen::VectorXd& pattern,
                                    const Eigen::VectorXd& added) const;

    /// All d, where the nominal scale of each node is known to `uNominal` (relative, > 0).
    [[nodiscard]] std::vector<BrightnessOffset> solve(std::span<const double> uNominal) const;

private:
    Eigen::MatrixXd h_, g_;
    Eigen::MatrixXd a_;  ///< sum_p y_p P_ij: what adds to the rates
    Eigen::VectorXd b_;
};

/// The mean of a pixel's four neighbours, 0 at the least. Empty at the edge of the picture, and
/// where one of them is not a number.
[[nodiscard]] std::optional<double> lightAround(const Image<float>& radiance, int x, int y);

}  // namespace gonio::proc
