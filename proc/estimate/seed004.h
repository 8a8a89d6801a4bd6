#pragma once
// The estimators of the thesis [Cezner2023, 6.1.3 and 6.2] under their own names, as the baselines
// that ours are measured against, in their usual chain: an interpolator over the data, an
// extrapolator beyond an outgoing angle, and one beyond an angle of incidence.
//
// Measured and interpolated answers come from the interpolator, whatever flags its samples have;
// answers beyond an edge are extrapolated. Where the thesis says 0 for what it cannot know, there
// is no answer here.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "proc/estimate/axis_linear.h"
#include "proc/estimate/bezier_extrapolator.h"
#include "proc/estimate/gradient_extrapolator.h"
#include "proc/estimate/grid_linear.h"
#include "proc/estimate/shepard.h"

namespace gonio::proc {

enum class SeedInterpolator {
    Shepard,     ///< NeighborsInterpolator
    AxisLinear,  ///< LinearAxisInterpolator
    GridLinear   ///< GridInterpolator
};

enum class SeedExtrapolator {
    None,
    Linear,
    Constant,  ///< ClampExtrapolator
    Bezier,
    Gradient  ///< GradientExtrapolator
};

struct SampleSet;
struct SpecularTable;

struct Seed004Options {
    SeedInterpolator interpolator = SeedInterpolator::Shepard;
    ShepardOptions shepard;
    AxisReach axisLinear;
    GridLinearOptions gridLinear;  ///< without incidences: those of the data
    SeedInterpolator gridFilledBy = SeedInterpolator::AxisLinear;  ///< not the grid again

    SeedExtrapolator beyondOutgoing = SeedExtrapolator::Constant;
    SeedExtrapolator beyondIncoming = SeedExtrapolator::Constant;
    std::optional<Radians> outgoingEdge;  ///< empty: the data's largest theta_o
    std::optional<Radians> incomingEdge;  ///< empty: the data's largest theta_i
    BezierOptions bezier;
    GradientOptions gradient;
};

/// "grid-linear", or with what is beyond both edges: "grid-linear:bezier".
[[nodiscard]] std::optional<Seed004Options> seed004Named(std::string_view name);
/// "shepard, axis-linear, grid-linear, each alone or with :none, :linear, ...".
[[nodiscard]] std::string seed004Names();

/// The chain over these data. A Usage error for options out of their domain, and for a grid over
/// data of more than 256 incidences when no planes are given; a Quality error for no data.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeSeed004(const ScatteredSet& data,
                                                             const Seed004Options& options = {});
/// Over the usable cells of a measured sample: of all bands at once where all were measured in the
/// same cells, else band by band. A band without any has no answer.
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeSeed004(const SampleSet& sample,
                                                             const Seed004Options& options = {});
/// Over the nodes of a table; also a Usage error as scatteredOf().
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeSeed004(const SpecularTable& table,
                                                             const Seed004Options& options = {});

}  // namespace gonio::proc
