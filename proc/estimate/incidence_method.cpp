#include "proc/estimate/incidence_method.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/estimate/coverage.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr double kLogFloor = 1e-5;    ///< 1/sr
constexpr double kRatioFloor = 1e-6;  ///< 1/sr
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The quantity of one pair as a function of f, and back.
class AtPair {
public:
    AtPair(SheetQuantity quantity, double cosines, double model)
        : quantity_(quantity),
          scale_(quantity == SheetQuantity::LogFCosines ? cosines : 1),
          model_(model + kRatioFloor) {}

    [[nodiscard]] double of(double f) const {
        switch (quantity_) {
            case SheetQuantity::F: break;
            case SheetQuantity::LogF:
            case SheetQuantity::LogFCosines: return std::asinh(f * scale_ / (2 * kLogFloor));
            case SheetQuantity::RatioToModel: return (f + kRatioFloor) / model_;
        }
        return f;
    }
    [[nodiscard]] double f(double q) const {
        switch (quantity_) {
            case SheetQuantity::F: break;
            case SheetQuantity::LogF:
            case SheetQuantity::LogFCosines: return 2 * kLogFloor * std::sinh(q) / scale_;
            case SheetQuantity::RatioToModel: return q * model_ - kRatioFloor;
        }
        return q;
    }
    /// d of / d f, at f.
    [[nodiscard]] double slope(double f) const {
        switch (quantity_) {
            case SheetQuantity::F: break;
            case SheetQuantity::LogF:
            case SheetQuantity::LogFCosines: return scale_ / std::hypot(f * scale_, 2 * kLogFloor);
            case SheetQuantity::RatioToModel: return 1 / model_;
        }
        return 1;
    }

private:
    SheetQuantity quantity_;
    double scale_;
    double model_;
};

/// What one incidence weighs in an answer.
struct IncidenceWeight {
    std::size_t sheet;
    double weight;
};
using IncidenceWeights = std::vector<IncidenceWeight>;

/// Cubic Hermite weights between nodes b and c with slopes by divided differences over the
/// neighbours, one-sided at the ends.
IncidenceWeights catmullRom(const std::vector<double>& at, const AxisPlace& place) {
    const std::size_t b = place.low;
    const std::size_t c = place.high;
    const double t = place.t;
    const double width = at[c] - at[b];
    const double slopeB = t * (1 - t) * (1 - t) * width;
    const double slopeC = -t * t * (1 - t) * width;
    std::vector<double> weight(at.size(), 0.0);
    weight[b] += (1 + 2 * t) * (1 - t) * (1 - t);
    weight[c] += t * t * (3 - 2 * t);
    const auto addSlope = [&](std::size_t node, double slope) {
        const std::size_t before = node == 0 ? 0 : node - 1;
        const std::size_t behind = std::min(node + 1, at.size() - 1);
        weight[behind] += slope / (at[behind] - at[before]);
        weight[before] -= slope / (at[behind] - at[before]);
    };
    addSlope(b, slopeB);
    addSlope(c, slopeC);
    IncidenceWeights weights;
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (weight[i] != 0) weights.push_back({i, weight[i]});
    }
    return weights;
}

IncidenceWeights weightsAt(const std::vector<double>& deg, double atDeg, IncidenceCurve curve) {
    const double inside = std::clamp(atDeg, deg.front(), deg.back());
    const AxisPlace place = placeOn(deg, inside).value_or(AxisPlace{});
    if (place.atNode()) return {{place.low, 1}};
    if (curve == IncidenceCurve::CatmullRom) return catmullRom(deg, place);
    return {{place.low, 1 - place.t}, {place.high, place.t}};
}

/// Of one incidence and band.
struct CellMeans {
    Sheet::Cells cells;
    std::vector<double> count;  ///< values per cell; empty: none at all

    void add(std::size_t cell, double value, double uRandom, double uSystematic) {
        if (count.empty()) {
            cells = Sheet::Cells::missing();
            count.assign(cells.value.size(), 0.0);
        }
        const double n = ++count[cell];
        const auto mean = [n](double& to, double add) { to = n == 1 ? add : to + (add - to) / n; };
        mean(cells.value[cell], value);
        mean(cells.uRandom[cell], uRandom);
        mean(cells.uSystematic[cell], uSystematic);
    }
};

class SheetMethod final : public IncidenceMethod {
public:
    SheetMethod(const BrdfData& data, const std::vector<bool>& groups, SheetMethodOptions options)
        : options_(std::move(options)) {
        addSheets(data, groups);
    }

    [[nodiscard]] std::string name() const override { return options_.name; }

    [[nodiscard]] MethodAnswer at(const LightView& pair) const override {
        const LedBands model = modelAt(pair);
        MethodAnswer answer;
        for (const Band band : kBands) {
            const BandSheets& sheets = bands_[index(band)];
            if (sheets.deg.empty()) {
                answer.f[band] = answer.uRandom[band] = answer.uSystematic[band] = kNan;
                continue;
            }
            const AtPair quantity(options_.quantity, pair.in.z() * pair.out.z(), model[band]);
            const SheetValue q = blended(sheets, pair);
            const double f = quantity.f(q.value);
            const double slope = quantity.slope(f);
            answer.f[band] = f;
            answer.uRandom[band] = q.uRandom / slope;
            answer.uSystematic[band] = q.uSystematic / slope;
        }
        return answer;
    }

private:
    /// Ascending incidences; what has no value in the band is not there.
    struct BandSheets {
        std::vector<double> deg;
        std::vector<Sheet> sheets;
    };

    [[nodiscard]] LedBands modelAt(const LightView& pair) const {
        return options_.quantity == SheetQuantity::RatioToModel ? options_.carrier.at(pair)
                                                                : LedBands{};
    }

    /// By group and band; rows that are no cells count for the cell that they lie in, as their
    /// mean.
    void addSheets(const BrdfData& data, const std::vector<bool>& groups) {
        std::vector<std::array<CellMeans, 3>> means(data.incidences.size());
        for (const FitRow& row : data.rows) {
            if (!groups[row.group]) continue;
            if (const auto cell = cellOf(data, row)) addRow(data, row, *cell, means[row.group]);
        }
        for (std::size_t g = 0; g < means.size(); ++g) {
            for (std::size_t b = 0; b < 3; ++b) {
                if (means[g][b].count.empty()) continue;
                auto sheet = Sheet::over(std::move(means[g][b].cells));
                if (!sheet) continue;
                bands_[b].deg.push_back(data.incidences[g].degrees());
                bands_[b].sheets.push_back(std::move(*sheet));
            }
        }
    }

    void addRow(const BrdfData& data,
                const FitRow& row,
                std::size_t cell,
                std::array<CellMeans, 3>& means) const {
        LedBands model;
        if (options_.quantity == SheetQuantity::RatioToModel) {
            model = options_.carrier.family->f(options_.carrier.point, data.nodesOf(row));
        }
        const double cosines = cos(data.incidences[row.group]) * row.cosThetaO;
        for (std::size_t b = 0; b < 3; ++b) {
            const double f = row.f[b];
            if (std::isnan(f)) continue;
            const AtPair quantity(options_.quantity, cosines, model.value[b]);
            const double slope = data.uKnown ? quantity.slope(f) : 0;  // else u is assumed: none
            const BudgetShare share = data.shareOf(row, b);
            const double common =
                std::hypot(row.uSystematic[b], f * std::hypot(share.patch, share.state));
            means[b].add(cell, quantity.of(f), slope * row.uRandom[b], slope * common);
        }
    }

    [[nodiscard]] SheetValue blended(const BandSheets& sheets, const LightView& pair) const {
        SheetValue sum;
        double variance = 0;
        for (const auto& [sheet, weight] :
             weightsAt(sheets.deg, pair.in.theta().degrees(), options_.curve)) {
            const Radians incidence = Radians::fromDegrees(sheets.deg[sheet]);
            const SheetValue one =
                sheets.sheets[sheet].at(onSheet(options_.frame, pair, incidence));
            sum.value += weight * one.value;
            variance += weight * weight * one.uRandom * one.uRandom;
            sum.uSystematic += weight * one.uSystematic;
        }
        sum.uRandom = std::sqrt(variance);
        return sum;
    }

    SheetMethodOptions options_;
    std::array<BandSheets, 3> bands_;
};

class ModelMethod final : public IncidenceMethod {
public:
    explicit ModelMethod(Carrier carrier) : carrier_(std::move(carrier)) {}
    [[nodiscard]] std::string name() const override { return "model:" + carrier_.family->name(); }
    [[nodiscard]] bool anchored() const override { return false; }
    [[nodiscard]] MethodAnswer at(const LightView& pair) const override {
        const LedBands f = carrier_.at(pair);
        return {.f = f,
                .uRandom = carrier_.uAt(pair),
                .uSystematic = f * LedBands{carrier_.commonRelative}};
    }

private:
    Carrier carrier_;
};

}  // namespace

LedBands Carrier::at(const LightView& pair) const {
    const WeightedNode node{pairOf<double>(pair), 1};
    return family->f(point, std::span(&node, 1));
}

LedBands Carrier::uAt(const LightView& pair) const {
    const WeightedNode node{pairOf<double>(pair), 1};
    const std::array<BandSlopes, 3> slopes = family->slopes(point, std::span(&node, 1));
    LedBands u;
    for (std::size_t b = 0; b < 3; ++b) {
        const Eigen::Index n = covariance[b].rows();
        const Eigen::Map<const Eigen::VectorXd> slope(slopes[b].slope.data(), n);
        u.value[b] = std::sqrt(std::max(0.0, slope.dot(covariance[b] * slope)));
    }
    return u;
}

std::unique_ptr<const IncidenceMethod> sheetMethod(const BrdfData& data,
                                                   const std::vector<bool>& groups,
                                                   SheetMethodOptions options) {
    return std::make_unique<SheetMethod>(data, groups, std::move(options));
}

std::unique_ptr<const IncidenceMethod> modelMethod(Carrier carrier) {
    return std::make_unique<ModelMethod>(std::move(carrier));
}

}  // namespace gonio::proc
