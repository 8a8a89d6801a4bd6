#pragma once
// Makes a BakedTable of anything isotropic that answers. Nodes at the horizon, which have no
// answer, are asked for just above it: at (1 - q) = 1e-3 of their cosines' mean, and cos(theta_d) =
// 1e-3.

#include "proc/core/result.h"
#include "proc/estimate/baked_table.h"

namespace gonio::proc {

struct BakeOptions {
    BoxResolution resolution;
    TableStorage storage = TableStorage::Float;
    /// Spacing of the nodes of tan(theta_h) at the peak; 0: three quarters of halfWidthTangent.
    double t0 = 0;
};

/// tan(theta_h) at which f, the mean of its bands at theta_d = 30 degrees, has fallen half way from
/// its peak to its floor; 1 where the peak is less than half above the floor, as of a diffuse
/// surface, and where nothing answers.
[[nodiscard]] double halfWidthTangent(const Scatterer& of);

/// A carrier must be positive wherever `truth` answers: a node where it is not has no answer. Usage
/// error: an axis with less than 2 or more than 512 nodes.
[[nodiscard]] Result<BakedTable> bakeTable(const Scatterer& truth,
                                           std::unique_ptr<const AnalyticModel> carrier,
                                           const BakeOptions& options = {});

}  // namespace gonio::proc
