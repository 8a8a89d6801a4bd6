#include "proc/export/tensor_normals.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/core/parallel.h"
#include "proc/table/tensor_table.h"

namespace gonio::proc {
namespace {

constexpr int kIterations = 4;
constexpr double kLeastDensity = 1e-3 / kPi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// f(w, w), the mean of the bands; NaN without an answer.
double retroReflection(const Scatterer& from, const Direction& w) {
    const Answer answer = from.answer({.in = w, .out = w});
    if (!answer.present()) return kNan;
    return std::max(0.0, (answer.f[Band::R] + answer.f[Band::G] + answer.f[Band::B]) / 3);
}

/// One azimuth's values; those that are missing take the next toward the normal.
std::size_t fillMissing(std::vector<double>& row) {
    const auto present = [](double value) { return !std::isnan(value); };
    const auto first = std::find_if(row.begin(), row.end(), present);
    double last = first == row.end() ? 1 : *first;
    std::size_t filled = 0;
    for (double& value : row) {
        if (!present(value)) {
            ++filled;
            value = last;
        }
        last = value;
    }
    return filled;
}

/// Points of the hemisphere, evenly on the square, with the solid angle that each stands for.
struct Quadrature {
    std::vector<Eigen::Vector3d> points;
    std::vector<SquarePoint> places;
    std::vector<double> weights;

    Quadrature(std::size_t thetas, std::size_t phis) {
        for (std::size_t p = 0; p < phis; ++p) {
            for (std::size_t t = 0; t < thetas; ++t) {
                const auto edge = [&](std::size_t at) {
                    const double x = static_cast<double>(at) / static_cast<double>(thetas);
                    return std::cos(x * x * kPi / 2);
                };
                const SquarePoint at{
                    .x = (static_cast<double>(t) + 0.5) / static_cast<double>(thetas),
                    .y = (static_cast<double>(p) + 0.5) / static_cast<double>(phis)};
                places.push_back(at);
                points.push_back(directionOf(at).vector());
                weights.push_back((edge(t) - edge(t + 1)) * 2 * kPi / static_cast<double>(phis));
            }
        }
    }
};

/// The area that the normals show to each node of `grid`; of isotropic ones the first row's.
std::vector<double> shownAreas(const GridStack& grid,
                               const Quadrature& over,
                               const std::vector<double>& density) {
    std::vector<double> areas(grid.width * grid.height);
    const std::size_t asked = grid.height == 2 ? grid.width : areas.size();
    parallelFor(asked, [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const Eigen::Vector3d w = directionOf(nodeOf(grid, i)).vector();
            double sum = 0;
            for (std::size_t k = 0; k < density.size(); ++k) {
                sum += density[k] * std::max(0.0, w.dot(over.points[k]));
            }
            areas[i] = sum;
        }
    });
    for (std::size_t i = asked; i < areas.size(); ++i) areas[i] = areas[i - asked];
    return areas;
}

/// Times the solid angle of each point.
std::vector<double> densityAt(const GridStack& ndf, const Quadrature& over) {
    std::vector<double> density;
    for (std::size_t k = 0; k < over.places.size(); ++k) {
        density.push_back(bilinear(ndf, 0, over.places[k]) * over.weights[k]);
    }
    return density;
}

void setValues(GridStack& grid, const std::vector<double>& values, double scale) {
    grid.values.clear();
    for (const double value : values) grid.values.push_back(static_cast<float>(value * scale));
}

/// f(w, w) cos(theta) at the nodes; the row of phi = pi is that of -pi.
std::vector<double> retroTable(const Scatterer& from, FittedNormals& fitted) {
    const GridStack& grid = fitted.ndf;
    const std::size_t rows = grid.height - 1;
    std::vector<double> all;
    for (std::size_t y = 0; y < rows; ++y) {
        std::vector<double> row(grid.width);
        parallelFor(row.size(), [&](IndexRange range) {
            for (std::size_t x = range.begin; x < range.end; ++x) {
                row[x] = retroReflection(from, directionOf(nodeOf(grid, y * grid.width + x)));
            }
        });
        fitted.asked += row.size();
        fitted.filled += fillMissing(row);
        for (std::size_t x = 0; x < row.size(); ++x) {
            const double z = directionOf(nodeOf(grid, y * grid.width + x)).z();
            all.push_back(row[x] * std::max(0.0, z));
        }
    }
    for (std::size_t x = 0; x < grid.width; ++x) all.push_back(all[x]);
    return all;
}

}  // namespace

FittedNormals fitNormals(const Scatterer& from, const NormalGrid& grid) {
    FittedNormals fitted;
    fitted.ndf = {.width = grid.width, .height = grid.height, .values = {}};
    fitted.sigma = fitted.ndf;
    const std::vector<double> retro = retroTable(from, fitted);
    const Quadrature over(2 * grid.width, grid.height == 2 ? 64 : 2 * grid.height);
    std::vector<double> normals(retro.size(), 1.0);
    std::vector<double> areas;
    for (int i = 0; i <= kIterations; ++i) {
        setValues(fitted.ndf, normals, 1);
        areas = shownAreas(fitted.ndf, over, densityAt(fitted.ndf, over));
        const double toNormal = areas[0];  // the area shown to the normal is to be 1
        for (std::size_t k = 0; k < normals.size(); ++k) {
            areas[k] /= toNormal;
            normals[k] = std::max(normals[k] / toNormal, kLeastDensity);
        }
        if (i == kIterations) break;
        for (std::size_t k = 0; k < normals.size(); ++k) normals[k] = retro[k] * areas[k];
        if (*std::max_element(normals.begin(), normals.end()) <= 0) {
            std::fill(normals.begin(), normals.end(), 1.0);  // nothing comes back: any will do
        }
    }
    setValues(fitted.ndf, normals, 1);
    setValues(fitted.sigma, areas, 1);
    return fitted;
}

}  // namespace gonio::proc
