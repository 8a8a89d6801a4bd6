#include "proc/models/tabulated.h"

#include <algorithm>
#include <string>

#include "proc/core/number_table.h"
#include "proc/solve/quadrature.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kAreas = 181;  // half a degree apart

Error malformed(const std::string& what) { return {ErrorKind::File, "table of normals: " + what}; }

/// int max(0, w.m) dphi / 2 of a facet at theta_m: a = mu cos(theta_m), b = sin sin >= 0.
double facing(double a, double b) {
    if (a >= b) return kPi * a;
    const double turn = std::acos(std::clamp(-a / b, -1.0, 1.0));
    return a * turn + b * std::sin(turn);
}

}  // namespace

NormalTable::NormalTable(std::vector<NormalTableRow> rows) : rows_(std::move(rows)) {
    scale_ = 1 / projectedArea(1);
    for (std::size_t i = 0; i < kAreas; ++i) {
        const double theta = kPi / 2 * static_cast<double>(i) / (kAreas - 1);
        areas_.push_back(scale_ * projectedArea(std::cos(theta)));
    }
}

Result<NormalTable> NormalTable::make(std::vector<NormalTableRow> rows) {
    constexpr std::size_t kMostRows = 10000;
    if (rows.size() < 2 || rows.size() > kMostRows) return malformed("wanted 2 to 10000 rows");
    if (rows.front().thetaH != Radians(0)) return malformed("theta_h must begin at 0");
    if (rows.back().thetaH > Radians(kPi / 2 + 1e-12)) {
        return malformed("theta_h must end at 90 degrees at most");
    }
    bool any = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (i > 0 && rows[i].thetaH <= rows[i - 1].thetaH) {
            return malformed("theta_h must rise, row " + std::to_string(i + 1) + " does not");
        }
        if (!(rows[i].d >= 0) || !std::isfinite(rows[i].d)) {
            return malformed("row " + std::to_string(i + 1) + ": d must be a number of 0 or more");
        }
        any = any || rows[i].d > 0;
    }
    if (!any) return malformed("all values are 0");
    NormalTable table(std::move(rows));
    if (!std::isfinite(table.scale_)) return malformed("the values do not add up to a number");
    return table;
}

Result<NormalTable> NormalTable::read(const std::filesystem::path& file) {
    const Result<NumberTable> numbers = readNumberTable(file);
    if (!numbers) return numbers.error();
    const std::string name = "'" + file.string() + "'";
    if (numbers->names != std::vector<std::string>{"theta_h", "d"}) {
        return malformed("wanted the header theta_h,d").in(name);
    }
    std::vector<NormalTableRow> rows;
    for (const std::vector<double>& row : numbers->rows) {
        rows.push_back({Radians::fromDegrees(row[0]), row[1]});
    }
    Result<NormalTable> table = make(std::move(rows));
    if (!table) return table.error().in(name);
    return table;
}

double NormalTable::raw(double thetaH) const {
    if (thetaH > rows_.back().thetaH.value()) return 0;
    const auto above = std::upper_bound(
        rows_.begin(), rows_.end(), thetaH, [](double angle, const NormalTableRow& row) {
            return angle < row.thetaH.value();
        });
    if (above == rows_.end()) return rows_.back().d;
    const NormalTableRow& high = *above;
    const NormalTableRow& low = *(above - 1);
    const double share = (thetaH - low.thetaH.value()) / (high.thetaH.value() - low.thetaH.value());
    if (low.d > 0 && high.d > 0) return low.d * std::pow(high.d / low.d, share);
    return low.d + (high.d - low.d) * share;
}

double NormalTable::d(double thetaH) const { return scale_ * raw(thetaH); }

/// int D(m) max(0, w.m) dm, interval by interval of the table.
double NormalTable::projectedArea(double mu) const {
    static const std::vector<QuadratureNode> nodes = gaussLegendre(8);
    const double sine = std::sqrt((1 - mu) * (1 + mu));
    double sum = 0;
    for (std::size_t i = 1; i < rows_.size(); ++i) {
        const double from = rows_[i - 1].thetaH.value();
        const double span = rows_[i].thetaH.value() - from;
        for (const QuadratureNode& node : nodes) {
            const double theta = from + span * node.x;
            const double facets = raw(theta) * std::sin(theta) * node.weight * span;
            sum += facets * 2 * facing(mu * std::cos(theta), sine * std::sin(theta));
        }
    }
    return sum;
}

double NormalTable::maskedInverseMu(double mu) const {
    const double x = std::acos(std::clamp(mu, 0.0, 1.0)) / (kPi / 2) * (kAreas - 1);
    const auto i = std::min(static_cast<std::size_t>(x), kAreas - 2);
    const double share = x - static_cast<double>(i);
    // Both the area and mu itself bound what is seen: the projected area is at least mu.
    return 1 / std::max(mu, areas_[i] + (areas_[i + 1] - areas_[i]) * share);
}

}  // namespace gonio::proc
