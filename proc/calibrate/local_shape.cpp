#include "proc/calibrate/local_shape.h"

#include <cmath>
#include <optional>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr double kAboveNoise = 5;  // u_random
constexpr Radians kRowStep = 1_deg;

/// f one step before and behind a cell, and how far that is.
struct Beside {
    std::optional<double> before, behind;
    double step = 1;  // radians
};

class Neighbours {
public:
    explicit Neighbours(const CellSamples& cells) : cells_(cells) {}

    /// Empty where the row ends or a cell is missing there.
    [[nodiscard]] std::optional<double> inRow(int row, Radians phi) {
        if (row < 0 || row >= CellGrid::kRows) return std::nullopt;
        const int sectors = CellGrid::sectors(row);
        const double at = phi.value() / (2 * kPi) * sectors - 0.5;
        const double low = std::floor(at);
        const auto here = of({row, wrapped(static_cast<int>(low), sectors)});
        const auto next = of({row, wrapped(static_cast<int>(low) + 1, sectors)});
        if (!here || !next) return std::nullopt;
        return *here + (at - low) * (*next - *here);
    }
    [[nodiscard]] std::optional<double> beside(CellPlace place, int step) {
        return of({place.row, wrapped(place.sector + step, CellGrid::sectors(place.row))});
    }
    /// All that was read so far stands above its noise.
    [[nodiscard]] bool clear() const { return clear_; }
    void read(std::size_t cell) {
        clear_ = clear_ && cells_.f[cell] > kAboveNoise * cells_.uRandom[cell];
    }

private:
    static int wrapped(int sector, int sectors) { return (sector % sectors + sectors) % sectors; }
    std::optional<double> of(CellPlace place) {
        const std::size_t cell = CellGrid::index(place);
        if (!cells_.present(cell)) return std::nullopt;
        read(cell);
        return cells_.f[cell];
    }
    const CellSamples& cells_;
    bool clear_ = true;
};

LocalCurve curve(double here, const Beside& beside, bool logarithmic) {
    const auto g = [&](double f) { return logarithmic ? std::log(f) : f; };
    if (beside.before && beside.behind) {
        const double before = g(*beside.before), behind = g(*beside.behind);
        return {.slope = (behind - before) / (2 * beside.step),
                .curvature = (behind - 2 * g(here) + before) / (beside.step * beside.step)};
    }
    if (beside.behind) return {.slope = (g(*beside.behind) - g(here)) / beside.step};
    if (beside.before) return {.slope = (g(here) - g(*beside.before)) / beside.step};
    return {};
}

}  // namespace

double LocalShape::slope(double f) const {
    return std::hypot(theta.slope, phi.slope) * (logarithmic ? std::abs(f) : 1);
}

double LocalShape::firstOrder(double f, const DirectionSpread& u) const {
    return std::hypot(theta.slope * u.alongTheta.value(), phi.slope * u.alongPhi.value()) *
           (logarithmic ? std::abs(f) : 1);
}

double LocalShape::at(double f, double alongTheta, double alongPhi) const {
    const double change = (theta.slope + theta.curvature / 2 * alongTheta) * alongTheta +
                          (phi.slope + phi.curvature / 2 * alongPhi) * alongPhi;
    return logarithmic ? f * std::exp(change) : f + change;
}

// Of f itself: (ln f)'' + (ln f)'^2 in units of f.
double LocalShape::second(double f, const LocalCurve& along) const {
    return logarithmic ? f * (along.curvature + along.slope * along.slope) : along.curvature;
}

double LocalShape::laplacian(double f) const { return second(f, theta) + second(f, phi); }

// For independent normal x and y: <((a x^2 + b y^2) / 2)^2>.
double LocalShape::secondOrder(double f, const DirectionSpread& u) const {
    const double a = second(f, theta) * u.alongTheta.value() * u.alongTheta.value();
    const double b = second(f, phi) * u.alongPhi.value() * u.alongPhi.value();
    return std::sqrt((a + b) * (a + b) / 4 + (a * a + b * b) / 2);
}

LocalShape localShape(const CellSamples& cells, std::size_t cell) {
    const CellPlace place = CellGrid::place(cell);
    const Direction centre = CellGrid::centre(cell);
    Neighbours neighbours(cells);
    neighbours.read(cell);
    const Beside alongTheta{.before = neighbours.inRow(place.row - 1, centre.phi()),
                            .behind = neighbours.inRow(place.row + 1, centre.phi()),
                            .step = kRowStep.value()};
    const double width = 2 * kPi / CellGrid::sectors(place.row);
    const Beside alongPhi{.before = neighbours.beside(place, -1),
                          .behind = neighbours.beside(place, 1),
                          .step = width * sin(centre.theta())};
    LocalShape shape{.logarithmic = neighbours.clear(), .theta = {}, .phi = {}};
    shape.theta = curve(cells.f[cell], alongTheta, shape.logarithmic);
    shape.phi = curve(cells.f[cell], alongPhi, shape.logarithmic);
    return shape;
}

}  // namespace gonio::proc
