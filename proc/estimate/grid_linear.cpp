#include "proc/estimate/grid_linear.h"

#include <cmath>
#include <string>

#include "proc/core/coordinates.h"
#include "proc/core/parallel.h"
#include "proc/estimate/answer_blend.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr double kMostNodes = 20e6;
constexpr double kFewestWeight = 0.5;
constexpr double kOnNode = 1e-9;  ///< of a step: rounding of angles

/// Where a direction stands in the plane of its incidence.
struct GridPlace {
    Radians radial, azimuth;
};

class Grid : public Scatterer {
public:
    Grid(const Scatterer& inner, const GridLinearOptions& options);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return bands_; }

private:
    [[nodiscard]] GridPlace placeOf(const LightView& pair) const;
    [[nodiscard]] LightView pairAt(std::size_t node) const;
    [[nodiscard]] Radians rowStep() const;
    [[nodiscard]] Radians columnStep() const;
    /// Bilinear in one plane, times `weight`; the weight of the nodes that are there.
    double addPlane(AnswerBlend& blend,
                    std::size_t plane,
                    double weight,
                    const GridPlace& at) const;

    GridLinearOptions options_;
    BandCount bands_;
    std::vector<double> incidenceDeg_;
    std::vector<Answer> nodes_;  ///< plane > row > column
};

/// A step between two nodes, and how far from the first, in [0, 1).
struct Between {
    std::size_t low = 0;
    double t = 0;
};

Between between(double at) {
    const double nearest = std::round(at);
    if (std::abs(at - nearest) < kOnNode) return {static_cast<std::size_t>(nearest), 0};
    const double low = std::floor(at);
    return {static_cast<std::size_t>(low), at - low};
}

Grid::Grid(const Scatterer& inner, const GridLinearOptions& options)
    : options_(options), bands_(inner.bandCount()) {
    for (const Radians incidence : options_.incidences)
        incidenceDeg_.push_back(incidence.degrees());
    nodes_.assign(options_.incidences.size() * options_.rows * options_.columns,
                  Answer::none({}, Source::Interpolated));
    parallelFor(nodes_.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const LightView pair = pairAt(i);
            if (pair.out.aboveHorizon()) nodes_[i] = inner.answer(pair);
        }
    });
}

Radians Grid::rowStep() const {
    const Radians last = options_.origin == GridOrigin::Up ? 90_deg : 180_deg;
    return last / static_cast<double>(options_.rows - 1);
}

Radians Grid::columnStep() const { return 360_deg / static_cast<double>(options_.columns); }

GridPlace Grid::placeOf(const LightView& pair) const {
    const Radians phiIn = pair.in.phi();
    if (options_.origin == GridOrigin::Up) {
        return {pair.out.theta(), pair.out.turned(-phiIn).phi()};
    }
    const SpecularRelative at = toSpecularRelative(pair, phiIn);
    return {at.radial, at.azimuth};
}

LightView Grid::pairAt(std::size_t node) const {
    const Radians azimuth = columnStep() * static_cast<double>(node % options_.columns);
    node /= options_.columns;
    const Radians radial = rowStep() * static_cast<double>(node % options_.rows);
    const Radians incidence = options_.incidences[node / options_.rows];
    const Direction wi = Direction::fromSpherical(incidence, Radians(0));
    if (options_.origin == GridOrigin::Up) {
        return {.in = wi, .out = Direction::fromSpherical(radial, azimuth)};
    }
    return {.in = wi, .out = fromSpecularRelative(wi, {.radial = radial, .azimuth = azimuth})};
}

double Grid::addPlane(AnswerBlend& blend,
                      std::size_t plane,
                      double weight,
                      const GridPlace& at) const {
    const Between row = between(at.radial.value() / rowStep().value());
    const Between column = between(at.azimuth.value() / columnStep().value());
    double added = 0;
    const auto addNode = [&](std::size_t r, std::size_t c, double share) {
        if (share == 0 || r >= options_.rows) return;
        const Answer& node =
            nodes_[(plane * options_.rows + r) * options_.columns + c % options_.columns];
        if (!node.present()) return;
        blend.add(share, node);
        added += share;
    };
    addNode(row.low, column.low, weight * (1 - row.t) * (1 - column.t));
    addNode(row.low, column.low + 1, weight * (1 - row.t) * column.t);
    addNode(row.low + 1, column.low, weight * row.t * (1 - column.t));
    addNode(row.low + 1, column.low + 1, weight * row.t * column.t);
    return added;
}

Answer Grid::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const auto incidence = placeOn(incidenceDeg_, pair.in.theta().degrees());
    if (!incidence) return Answer::none({}, Source::Interpolated);
    const GridPlace at = placeOf(pair);
    AnswerBlend blend;
    double weight = addPlane(blend, incidence->low, 1 - incidence->t, at);
    if (!incidence->atNode()) weight += addPlane(blend, incidence->high, incidence->t, at);
    if (weight < kFewestWeight) return Answer::none({}, Source::Interpolated);
    return blend.mean(blend.isOneMeasurement() ? Source::Measured : Source::Interpolated);
}

/// What is wrong; empty where nothing is.
std::string complaint(const GridLinearOptions& options) {
    if (options.incidences.empty()) return "no planes of incidence";
    for (std::size_t i = 0; i < options.incidences.size(); ++i) {
        const double degrees = options.incidences[i].degrees();
        if (!(degrees >= 0 && degrees < 90)) return "a plane of incidence outside [0, 90) degrees";
        if (i > 0 && !(degrees - options.incidences[i - 1].degrees() > kOnNode)) {
            return "planes of incidence that do not ascend";
        }
    }
    if (options.rows < 2 || options.columns < 1) return "fewer than 2 rows or 1 column";
    const double nodes = static_cast<double>(options.incidences.size()) *
                         static_cast<double>(options.rows) * static_cast<double>(options.columns);
    return nodes > kMostNodes ? "more than 20 million nodes" : "";
}

}  // namespace

Result<std::unique_ptr<Scatterer>> makeGridLinear(const Scatterer& inner,
                                                  const GridLinearOptions& options) {
    if (const std::string wrong = complaint(options); !wrong.empty()) {
        return Error{ErrorKind::Usage, "grid-linear: " + wrong};
    }
    return std::unique_ptr<Scatterer>(std::make_unique<Grid>(inner, options));
}

}  // namespace gonio::proc
