#include "proc/fit/brdf_data.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "proc/fit/budget_shares.h"
#include "proc/optics/cell_grid.h"
#include "proc/solve/quadrature.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 3> kNoBand{kNan, kNan, kNan};

bool usable(Flags flags) {
    return flags.has(Flag::Measured) && !flags.has(Flag::Saturated) && !flags.has(Flag::Blocked) &&
           !flags.has(Flag::BelowHorizon);
}

/// Gauss points per side of a cell, by its distance from the mirror direction.
std::size_t nodesPerSide(Radians fromMirror) {
    if (fromMirror < 3_deg) return 4;
    if (fromMirror < 6_deg) return 3;
    return fromMirror < 15_deg ? 2 : 1;
}

struct CellNode {
    Direction out;
    double weight;
};

/// Weights by solid angle, summing to 1.
std::vector<CellNode> nodesOf(std::size_t cell, std::size_t perSide) {
    if (perSide == 1) return {{CellGrid::centre(cell), 1}};
    const CellBounds bounds = CellGrid::bounds(cell);
    const std::vector<QuadratureNode> rule = gaussLegendre(perSide);
    const double theta = (bounds.thetaHigh - bounds.thetaLow).value();
    const double phi = (bounds.phiHigh - bounds.phiLow).value();
    std::vector<CellNode> nodes;
    double sum = 0;
    for (const QuadratureNode& a : rule) {
        const Radians thetaO(bounds.thetaLow.value() + a.x * theta);
        for (const QuadratureNode& b : rule) {
            const Radians phiO(bounds.phiLow.value() + b.x * phi);
            nodes.push_back({Direction::fromSpherical(thetaO, phiO),
                             a.weight * b.weight * std::sin(thetaO.value())});
            sum += nodes.back().weight;
        }
    }
    for (CellNode& node : nodes) node.weight /= sum;
    return nodes;
}

class DataMaker {
public:
    explicit DataMaker(const DataOptions& options) : options_(options) {
        data_.assumedRelative = options.assumedRelative;
    }

    /// A row whose bands the caller fills.
    FitRow& add(const LightView& pair) {
        data_.nodes.push_back({pairOf<double>(pair), 1});
        FitRow row;
        row.firstNode = static_cast<std::uint32_t>(data_.nodes.size() - 1);
        row.cosThetaO = pair.out.z();
        row.f = row.uRandom = row.uSystematic = kNoBand;
        data_.rows.push_back(row);
        return data_.rows.back();
    }
    FitRow& addCell(const Direction& wi, std::size_t cell) {
        const Direction centre = CellGrid::centre(cell);
        FitRow row;
        row.firstNode = static_cast<std::uint32_t>(data_.nodes.size());
        const Radians away = angleBetween({.in = mirrorOf(wi), .out = centre});
        const std::vector<CellNode> nodes = nodesOf(cell, nodesPerSide(away));
        for (const CellNode& node : nodes) {
            data_.nodes.push_back({pairOf<double>({.in = wi, .out = node.out}), node.weight});
        }
        row.nodeCount = static_cast<std::uint16_t>(nodes.size());
        row.cell = static_cast<std::int32_t>(cell);
        row.solidAngle = CellGrid::solidAngle(cell);
        row.cosThetaO = centre.z();
        row.f = row.uRandom = row.uSystematic = kNoBand;
        data_.rows.push_back(row);
        return data_.rows.back();
    }
    void leaveOut() { ++data_.leftOut; }
    BrdfData& data() { return data_; }

    BrdfData finished() && {
        if (!data_.uKnown) assumeUncertainty();
        const double floor = options_.relativeFloor;
        for (FitRow& row : data_.rows) {
            for (std::size_t b = 0; b < 3; ++b) {
                if (floor > 0) row.uRandom[b] = std::hypot(row.uRandom[b], floor * row.f[b]);
                if (!std::isfinite(row.uSystematic[b])) row.uSystematic[b] = 0;
                const bool good =
                    std::isfinite(row.f[b]) && std::isfinite(row.uRandom[b]) && row.uRandom[b] > 0;
                if (!good) row.f[b] = kNan;
            }
        }
        const std::size_t before = data_.rows.size();
        std::erase_if(data_.rows, [](const FitRow& row) {
            return std::none_of(
                row.f.begin(), row.f.end(), [](double f) { return std::isfinite(f); });
        });
        data_.leftOut += before - data_.rows.size();
        return std::move(data_);
    }

private:
    void assumeUncertainty() {
        std::vector<std::vector<double>> sizes(data_.incidences.size());
        for (const FitRow& row : data_.rows) {
            for (const double f : row.f) {
                if (std::isfinite(f)) sizes[row.group].push_back(std::abs(f));
            }
        }
        std::vector<double> floor;
        floor.reserve(sizes.size());
        for (std::vector<double>& all : sizes) {
            floor.push_back(all.empty() ? 0 : 0.01 * medianOf(std::move(all)));
        }
        for (FitRow& row : data_.rows) {
            for (std::size_t b = 0; b < 3; ++b) {
                const double size = std::abs(row.f[b]) + floor[row.group];
                row.uRandom[b] = options_.assumedRelative * size;
            }
        }
    }
    static double medianOf(std::vector<double> values) {
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    }

    DataOptions options_;
    BrdfData data_;
};

/// The light at an incidence; the isotropic sample's is at phi = 0.
Direction lightAt(Radians incidence) { return Direction::fromSpherical(incidence, Radians(0)); }

/// Groups of scattered incidences: cut where two neighbours are more than half a degree apart; as
/// quantiles where that makes more than kMostGroups.
void groupByIncidence(BrdfData& data) {
    constexpr std::size_t kMostGroups = 12;
    const std::size_t count = data.rows.size();
    std::vector<double> theta(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec<double>& in = data.nodes[data.rows[i].firstNode].pair.in;
        theta[i] = std::atan2(std::hypot(in.x, in.y), in.z);
    }
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return theta[a] < theta[b];
    });
    std::vector<std::size_t> begins{0};
    for (std::size_t i = 1; i < count; ++i) {
        if (theta[order[i]] - theta[order[i - 1]] > (0.5_deg).value()) begins.push_back(i);
    }
    if (begins.size() > kMostGroups) {
        begins.clear();
        for (std::size_t g = 0; g < kMostGroups; ++g) begins.push_back(g * count / kMostGroups);
    }
    for (std::size_t g = 0; g < begins.size() && count > 0; ++g) {
        const std::size_t end = g + 1 < begins.size() ? begins[g + 1] : count;
        double sum = 0;
        for (std::size_t i = begins[g]; i < end; ++i) {
            data.rows[order[i]].group = static_cast<std::uint16_t>(g);
            sum += theta[order[i]];
        }
        data.incidences.emplace_back(sum / static_cast<double>(end - begins[g]));
    }
}

bool hasColumn(const Points& points, const std::string& name) {
    return std::find(points.columns.begin(), points.columns.end(), name) != points.columns.end();
}

/// The columns NAME or NAME_r, NAME_g, NAME_b; empty where they are not there.
Result<std::vector<std::vector<double>>> bandColumns(const Points& points,
                                                     const std::string& name,
                                                     BandCount bands) {
    std::vector<std::string> names{name};
    if (bands == BandCount::Three) names = {name + "_r", name + "_g", name + "_b"};
    std::vector<std::vector<double>> columns;
    for (const std::string& one : names) {
        if (!hasColumn(points, one)) return std::vector<std::vector<double>>{};
        Result<std::vector<double>> numbers = numbersOf(points, one);
        if (!numbers) return numbers.error();
        columns.push_back(std::move(*numbers));
    }
    return columns;
}

struct ScatteredColumns {
    BandCount bands = BandCount::Three;
    std::vector<std::vector<double>> f, uRandom, uSystematic;
    std::vector<double> flags;
};

Result<ScatteredColumns> columnsOf(const Points& points) {
    ScatteredColumns all;
    all.bands = hasColumn(points, "f_r") ? BandCount::Three : BandCount::One;
    const auto take = [&](const std::string& name, auto& into) -> Result<void> {
        auto columns = bandColumns(points, name, all.bands);
        if (!columns) return columns.error();
        into = std::move(*columns);
        return {};
    };
    if (auto done = take("f", all.f); !done) return done.error();
    if (all.f.empty()) {
        return Error{ErrorKind::File, "csv: no columns of values, wanted f or f_r,f_g,f_b"};
    }
    if (auto done = take("u_random", all.uRandom); !done) return done.error();
    if (all.uRandom.empty()) {
        if (auto done = take("u", all.uRandom); !done) return done.error();
    } else if (auto done = take("u_systematic", all.uSystematic); !done) {
        return done.error();
    }
    if (hasColumn(points, "flags")) {
        auto flags = numbersOf(points, "flags");
        if (!flags) return flags.error();
        all.flags = std::move(*flags);
    }
    return all;
}

/// A direction that stands in the table twice: the pole of an incidence, the last azimuth.
bool repeats(const SpecularTable& table, const TableNode& node) {
    const bool pole = table.radialDeg[node.radial] == 0 && node.azimuth > 0;
    return pole || table.azimuthDeg[node.azimuth] - table.azimuthDeg.front() >= 360;
}

bool flaggedOut(double mask) {
    if (!(mask > 0 && mask < 1 << kFlagCount)) return false;
    const Flags flags = Flags::fromMask(static_cast<std::uint32_t>(mask));
    return flags.has(Flag::Saturated) || flags.has(Flag::Blocked) || flags.has(Flag::BelowHorizon);
}

}  // namespace

std::size_t BrdfData::valueCount() const {
    std::size_t count = 0;
    for (const FitRow& row : rows) {
        for (std::size_t b = 0; b < bandsUsed(); ++b) count += std::isfinite(row.f[b]) ? 1U : 0U;
    }
    return count;
}

BrdfData fitDataOf(const SampleSet& set, const DataOptions& options) {
    DataMaker maker(options);
    const BudgetShares shares = budgetShares(set);
    for (std::size_t l = 0; l < set.leds.size(); ++l) {
        const LedTable& led = set.leds[l];
        const auto group = static_cast<std::uint16_t>(maker.data().incidences.size());
        maker.data().incidences.push_back(led.incidence);
        const Direction wi = lightAt(led.incidence);
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            const auto present = [&](const CellSamples& cells) {
                return cell < cells.size() && usable(cells.flags[cell]);
            };
            if (std::none_of(led.bands.begin(), led.bands.end(), present)) {
                maker.leaveOut();
                continue;
            }
            FitRow& row = maker.addCell(wi, cell);
            row.group = group;
            for (std::size_t b = 0; b < 3; ++b) {
                const CellSamples& cells = led.bands[b];
                if (!present(cells)) continue;
                row.f[b] = cells.f[cell];
                const BudgetShare& share = shares[l][b];
                const double perCell = share.perCell * row.f[b];
                const double perState = share.perState * row.f[b];
                row.uState[b] = share.perState;
                row.uRandom[b] = std::hypot(cells.uRandom[cell], perCell);
                const double systematic = cells.uSystematic[cell];
                row.uSystematic[b] = std::sqrt(std::max(
                    0.0, systematic * systematic - perCell * perCell - perState * perState));
            }
        }
    }
    return std::move(maker).finished();
}

Result<BrdfData> fitDataOf(const SpecularTable& table, const DataOptions& options) {
    if (table.colour == TableColour::Xyz || table.kind == ScatterKind::Btdf) {
        return Error{ErrorKind::Usage, "fit: a table of reflection in one band is wanted"};
    }
    DataMaker maker(options);
    maker.data().bands = BandCount::One;
    maker.data().uKnown = false;
    for (std::size_t i = 0; i < table.incidenceDeg.size(); ++i) {
        maker.data().incidences.push_back(Radians::fromDegrees(table.incidenceDeg[i]));
        for (std::size_t a = 0; a < table.azimuthDeg.size(); ++a) {
            for (std::size_t r = 0; r < table.radialDeg.size(); ++r) {
                const TableNode node{.rotation = 0, .incidence = i, .azimuth = a, .radial = r};
                if (repeats(table, node)) continue;
                const LightView pair = table.pairAt(node);
                if (!table.hasData(0, node) || !pair.in.aboveHorizon()) {
                    maker.leaveOut();
                    continue;
                }
                FitRow& row = maker.add(pair);
                row.group = static_cast<std::uint16_t>(i);
                row.f[0] = table.planes[0].f[table.index(node)];
                row.solidAngle = std::sin(table.radialDeg[r] * kPi / 180) + 1e-3;
            }
        }
    }
    return std::move(maker).finished();
}

Result<BrdfData> fitDataOf(const Points& points, const DataOptions& options) {
    const Result<ScatteredColumns> columns = columnsOf(points);
    if (!columns) return columns.error();
    DataMaker maker(options);
    maker.data().bands = columns->bands;
    maker.data().uKnown = !columns->uRandom.empty();
    for (std::size_t i = 0; i < points.pairs.size(); ++i) {
        const LightView& pair = points.pairs[i];
        const bool below = !pair.in.aboveHorizon() || !pair.out.aboveHorizon();
        if (below || (!columns->flags.empty() && flaggedOut(columns->flags[i]))) {
            maker.leaveOut();
            continue;
        }
        FitRow& row = maker.add(pair);
        for (std::size_t b = 0; b < columns->f.size(); ++b) {
            row.f[b] = columns->f[b][i];
            if (!columns->uRandom.empty()) row.uRandom[b] = columns->uRandom[b][i];
            if (!columns->uSystematic.empty()) row.uSystematic[b] = columns->uSystematic[b][i];
        }
    }
    groupByIncidence(maker.data());
    return std::move(maker).finished();
}

std::vector<std::uint32_t> thinnedRows(const BrdfData& data,
                                       const std::vector<bool>& groups,
                                       std::size_t count) {
    std::vector<std::vector<std::uint32_t>> byGroup(data.incidences.size());
    std::size_t total = 0;
    for (std::size_t i = 0; i < data.rows.size(); ++i) {
        const FitRow& row = data.rows[i];
        if (!groups[row.group]) continue;
        byGroup[row.group].push_back(static_cast<std::uint32_t>(i));
        ++total;
    }
    std::vector<std::uint32_t> kept;
    const auto brightness = [&](std::uint32_t i) {
        double most = -std::numeric_limits<double>::infinity();
        for (const double f : data.rows[i].f) most = f > most ? f : most;
        return most;
    };
    for (std::vector<std::uint32_t>& rows : byGroup) {
        const std::size_t share =
            total <= count ? rows.size() : std::min(rows.size(), count * rows.size() / total + 1);
        const std::size_t bright = total <= count ? 0 : share / 4;
        std::stable_sort(rows.begin(), rows.end(), [&](std::uint32_t a, std::uint32_t b) {
            return brightness(a) > brightness(b);
        });
        for (std::size_t i = 0; i < bright; ++i) kept.push_back(rows[i]);
        const std::size_t left = rows.size() - bright;
        const std::size_t even = share - bright;
        std::sort(rows.begin() + static_cast<std::ptrdiff_t>(bright), rows.end());
        for (std::size_t k = 0; k < even; ++k) kept.push_back(rows[bright + k * left / even]);
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

}  // namespace gonio::proc
