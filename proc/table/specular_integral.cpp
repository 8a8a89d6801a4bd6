#include "proc/table/specular_integral.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

/// Panes of a cell are at most this wide, degrees.
constexpr double kPane = 1;

/// One cell between neighbouring nodes, the whole of it or what lies above the horizon.
class Cell {
public:
    Cell(const SpecularTable& table, std::size_t plane, const TableNode& low, std::size_t azimuth)
        : table_(table), low_(low), nextAzimuth_(azimuth) {
        const auto at = [&](std::size_t a, std::size_t r) {
            TableNode node = low;
            node.azimuth = a;
            node.radial = r;
            return table.hasData(plane, node) ? table.planes[plane].f[table.index(node)] : 0.0;
        };
        f_[0] = at(low.azimuth, low.radial);
        f_[1] = at(low.azimuth, low.radial + 1);
        f_[2] = at(nextAzimuth_, low.radial);
        f_[3] = at(nextAzimuth_, low.radial + 1);
    }

    [[nodiscard]] double integral() const {
        if (f_[0] == 0 && f_[1] == 0 && f_[2] == 0 && f_[3] == 0) return 0;
        const double azimuthStep = sweep();
        const double radialStep = table_.radialDeg[low_.radial + 1] - table_.radialDeg[low_.radial];
        const double as = std::max(1.0, std::ceil(azimuthStep / kPane));
        const double rs = std::max(1.0, std::ceil(radialStep / kPane));
        double sum = 0;
        for (double a = 0.5; a < as; ++a) {
            for (double r = 0.5; r < rs; ++r) sum += pane(a / as, r / rs);
        }
        const double da = Radians::fromDegrees(azimuthStep / as).value();
        const double dr = Radians::fromDegrees(radialStep / rs).value();
        return sum * da * dr;
    }

private:
    [[nodiscard]] double sweep() const {
        const double step = table_.azimuthDeg[nextAzimuth_] - table_.azimuthDeg[low_.azimuth];
        return step > 0 ? step : step + 360;
    }
    /// f cos(theta_o) sin(radial) at a share of the way along both sides.
    [[nodiscard]] double pane(double a, double r) const {
        const double from = table_.radialDeg[low_.radial];
        const double to = table_.radialDeg[low_.radial + 1];
        const Radians radial = Radians::fromDegrees(from + r * (to - from));
        const Radians azimuth = Radians::fromDegrees(table_.azimuthDeg[low_.azimuth] + a * sweep());
        const Radians theta = Radians::fromDegrees(table_.incidenceDeg[low_.incidence]);
        const double z = cos(radial) * cos(theta) + sin(radial) * cos(azimuth) * sin(theta);
        if (z <= 0) return 0;
        const double f =
            (1 - a) * ((1 - r) * f_[0] + r * f_[1]) + a * ((1 - r) * f_[2] + r * f_[3]);
        return f * z * sin(radial);
    }

    const SpecularTable& table_;
    TableNode low_;
    std::size_t nextAzimuth_;
    double f_[4] = {};
};

}  // namespace

double specularIntegral(const SpecularTable& table, std::size_t plane, const TableNode& light) {
    const std::size_t azimuths = table.azimuthDeg.size();
    const bool half = table.symmetry == TableSymmetry::PlaneSymmetrical;
    const bool closes = !half && table.azimuthDeg.back() - table.azimuthDeg.front() < 360;
    double total = 0;
    for (std::size_t a = 0; a < azimuths; ++a) {
        if (a + 1 == azimuths && (!closes || azimuths == 1)) break;
        for (std::size_t r = 0; r + 1 < table.radialDeg.size(); ++r) {
            const TableNode low{light.rotation, light.incidence, a, r};
            total += Cell(table, plane, low, (a + 1) % azimuths).integral();
        }
    }
    return half ? 2 * total : total;
}

}  // namespace gonio::proc
