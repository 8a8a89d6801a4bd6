#include "proc/table/specular_integral.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

/// Panes of a cell are at most this wide, degrees.
constexpr double kPane = 1;
constexpr std::size_t kPole = std::numeric_limits<std::size_t>::max();  ///< of radials

/// What lies between two nodes of an axis.
struct Span {
    std::size_t low = 0, high = 0;
    double from = 0, to = 0;  ///< degrees

    [[nodiscard]] double width() const { return to - from; }
    [[nodiscard]] double panes() const { return std::max(1.0, std::ceil(width() / kPane)); }
};

std::vector<Span> spansOf(const std::vector<double>& axis) {
    std::vector<Span> spans;
    for (std::size_t i = 1; i < axis.size(); ++i) spans.push_back({i - 1, i, axis[i - 1], axis[i]});
    return spans;
}

std::vector<Span> radialsOf(const SpecularTable& table) {
    std::vector<Span> spans = spansOf(table.radialDeg);
    if (table.hasOpenPole()) spans.push_back({kPole, 0, 0, table.radialDeg.front()});
    return spans;
}

std::vector<Span> azimuthsOf(const SpecularTable& table) {
    const std::vector<double>& axis = table.azimuthDeg;
    std::vector<Span> spans = spansOf(axis);
    if (spans.empty()) return spans;
    const std::size_t last = axis.size() - 1;
    if (table.symmetry != TableSymmetry::PlaneSymmetrical) {
        const double next = axis.front() + 360;
        if (closesCircle(axis) && next > axis[last]) spans.push_back({last, 0, axis[last], next});
        return spans;
    }
    if (endsInACell(axis[0], spans.front().width())) spans.push_back({0, 0, 0, axis[0]});
    if (endsInACell(180 - axis[last], axis[last] - axis[last - 1])) {
        spans.push_back({last, last, axis[last], 180});
    }
    return spans;
}

/// The values of one light.
class Values {
public:
    Values(const SpecularTable& table, std::size_t plane, const TableNode& light)
        : table_(table), plane_(plane), light_(light) {
        double count = 0;
        for (std::size_t a = 0; a < table.azimuthDeg.size() && table.hasOpenPole(); ++a) {
            if (const double f = at(a, 0); f != 0) pole_ += (f - pole_) / ++count;
        }
    }
    /// 0 where there is no data.
    [[nodiscard]] double at(std::size_t azimuth, std::size_t radial) const {
        if (radial == kPole) return pole_;
        const TableNode node{light_.rotation, light_.incidence, azimuth, radial};
        return table_.hasData(plane_, node) ? table_.planes[plane_].f[table_.index(node)] : 0.0;
    }
    [[nodiscard]] Radians incidence() const {
        return Radians::fromDegrees(table_.incidenceDeg[light_.incidence]);
    }

private:
    const SpecularTable& table_;
    std::size_t plane_;
    TableNode light_;
    double pole_ = 0;
};

/// One cell between neighbouring nodes, the whole of it or what lies above the horizon.
class Cell {
public:
    Cell(const Values& values, const Span& azimuth, const Span& radial)
        : incidence_(values.incidence()),
          azimuth_(azimuth),
          radial_(radial),
          f_{values.at(azimuth.low, radial.low),
             values.at(azimuth.low, radial.high),
             values.at(azimuth.high, radial.low),
             values.at(azimuth.high, radial.high)} {}

    [[nodiscard]] double integral() const {
        if (f_[0] == 0 && f_[1] == 0 && f_[2] == 0 && f_[3] == 0) return 0;
        const double as = azimuth_.panes();
        const double rs = radial_.panes();
        double sum = 0;
        for (double a = 0.5; a < as; ++a) {
            for (double r = 0.5; r < rs; ++r) sum += pane(a / as, r / rs);
        }
        const double da = Radians::fromDegrees(azimuth_.width() / as).value();
        const double dr = Radians::fromDegrees(radial_.width() / rs).value();
        return sum * da * dr;
    }

private:
    /// f cos(theta_o) sin(radial) at a share of the way along both sides.
    [[nodiscard]] double pane(double a, double r) const {
        const Radians radial = Radians::fromDegrees(radial_.from + r * radial_.width());
        const Radians azimuth = Radians::fromDegrees(azimuth_.from + a * azimuth_.width());
        const double z =
            cos(radial) * cos(incidence_) + sin(radial) * cos(azimuth) * sin(incidence_);
        if (z <= 0) return 0;
        const double f =
            (1 - a) * ((1 - r) * f_[0] + r * f_[1]) + a * ((1 - r) * f_[2] + r * f_[3]);
        return f * z * sin(radial);
    }

    Radians incidence_;
    Span azimuth_, radial_;
    double f_[4] = {};
};

}  // namespace

double specularIntegral(const SpecularTable& table, std::size_t plane, const TableNode& light) {
    const Values values(table, plane, light);
    const std::vector<Span> radials = radialsOf(table);
    double total = 0;
    for (const Span& azimuth : azimuthsOf(table)) {
        for (const Span& radial : radials) total += Cell(values, azimuth, radial).integral();
    }
    return table.symmetry == TableSymmetry::PlaneSymmetrical ? 2 * total : total;
}

}  // namespace gonio::proc
