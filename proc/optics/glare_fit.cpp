#include "proc/optics/glare_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "proc/optics/spot.h"
#include "proc/solve/least_squares.h"

namespace gonio::proc {
namespace {

constexpr int kSquare = 16;          // pixels
constexpr double kSpotReach = 24;    // pixels: the spot and its near tails
constexpr double kClearOfSpot = 40;  // pixels: from here on it is glare
constexpr double kSignificant = 3;   // standard uncertainties
constexpr double kLeastRelative = 0.25;
constexpr std::size_t kFewestSquares = 100;
// Where the search of the halo's shape begins, and its bounds. A halo narrower than the grid of
// glare.h could not be taken off by it.
constexpr double kSmallestRadius = 16, kLargestRadius = 400;
constexpr double kLowestExponent = 0.5, kHighestExponent = 3;

struct Square {
    double x = 0, y = 0;  ///< of its middle, pixels of the window
    double pixels = 0;    ///< of it, in the field
    double difference = 0, unlit = 0;
    double sigma = 0;  ///< of the difference
    std::size_t pair = 0;
    double distance = 0;  ///< from the spot
};

/// One pair: the light of its spot, and what lies around.
struct Scene {
    double light = 0;  ///< of the spot, over all its pixels
    double spotX = 0, spotY = 0;
    std::vector<Square> squares;  ///< all of the field
};

Square squareAt(const MirrorPair& pair, const FieldPixels& field, int left, int top) {
    Square square;
    double variance = 0;
    const Size size = field.size();
    for (int y = top; y < std::min(top + kSquare, size.height); ++y) {
        const auto [begin, end] = field.inRow(y);
        for (int x = std::max(left, begin); x < std::min({left + kSquare, end, size.width}); ++x) {
            const double lit = double{pair.lit.radiance.at(x, y)};
            const double unlit = double{pair.unlit.radiance.at(x, y)};
            if (!std::isfinite(lit) || !std::isfinite(unlit)) continue;
            square.x += x + 0.5;
            square.y += y + 0.5;
            square.difference += lit - unlit;
            square.unlit += unlit;
            variance += double{pair.lit.variance.at(x, y)} + double{pair.unlit.variance.at(x, y)};
            ++square.pixels;
        }
    }
    if (square.pixels == 0) return square;
    for (double* sum : {&square.x, &square.y, &square.difference, &square.unlit}) {
        *sum /= square.pixels;
    }
    square.sigma = std::sqrt(variance) / square.pixels;
    return square;
}

Result<Scene> sceneOf(const MirrorPair& pair, const FieldPixels& field) {
    const Result<Spot> spot = findSpot(pair.lit);
    if (!spot) return spot.error();
    const Window& window = pair.lit.window;
    Scene scene{.spotX = (spot->at.x - window.x) / window.binning,
                .spotY = (spot->at.y - window.y) / window.binning};
    const Size size = field.size();
    for (int top = 0; top < size.height; top += kSquare) {
        for (int left = 0; left < size.width; left += kSquare) {
            Square square = squareAt(pair, field, left, top);
            if (square.pixels == 0) continue;
            square.distance = std::hypot(square.x - scene.spotX, square.y - scene.spotY);
            scene.squares.push_back(square);
        }
    }
    const double reach = kSpotReach / window.binning;
    for (int y = 0; y < size.height; ++y) {
        const auto [begin, end] = field.inRow(y);
        for (int x = begin; x < end; ++x) {
            if (std::hypot(x + 0.5 - scene.spotX, y + 0.5 - scene.spotY) > reach) continue;
            const double light =
                double{pair.lit.radiance.at(x, y)} - double{pair.unlit.radiance.at(x, y)};
            if (std::isfinite(light)) scene.light += light;
        }
    }
    return scene;
}

/// The squares that are held against the model, of all scenes.
class GlareData {
public:
    GlareData(std::vector<Scene> scenes, double fieldPixels, double binning, double lightDrift)
        : scenes_(std::move(scenes)), fieldPixels_(fieldPixels), drift_(lightDrift) {
        for (std::size_t i = 0; i < scenes_.size(); ++i) {
            for (Square square : scenes_[i].squares) {
                if (square.distance < kClearOfSpot / binning) continue;
                if (square.pixels < kSquare * kSquare) continue;  // the rim
                square.pair = i;
                squares_.push_back(square);
            }
        }
    }
    [[nodiscard]] std::size_t count() const { return squares_.size(); }
    [[nodiscard]] std::size_t pairs() const { return scenes_.size(); }
    [[nodiscard]] const Square& square(std::size_t i) const { return squares_[i]; }
    [[nodiscard]] double drift() const { return drift_; }
    /// What a share of 1 that goes everywhere gives to a square.
    [[nodiscard]] double even(const Square& square) const {
        return scenes_[square.pair].light / fieldPixels_;
    }
    /// What a halo of share 1 gives to each square.
    [[nodiscard]] std::vector<double> halo(double radius, double exponent) const {
        std::vector<double> perLanding;
        for (const Scene& scene : scenes_) {
            double landing = 0;
            for (const Square& square : scene.squares)
                landing += square.pixels * haloShape(square.distance, radius, exponent);
            perLanding.push_back(scene.light / landing);
        }
        std::vector<double> values;
        values.reserve(squares_.size());
        for (const Square& square : squares_) {
            values.push_back(perLanding[square.pair] *
                             haloShape(square.distance, radius, exponent));
        }
        return values;
    }

private:
    std::vector<Scene> scenes_;
    std::vector<Square> squares_;
    double fieldPixels_;
    double drift_;
};

/// Weighted linear least squares for the shares, one drift per pair drawn to 0 by its size, and
/// whatever further columns the model has.
struct Linear {
    Eigen::VectorXd found;
    Eigen::MatrixXd covariance;
    double chiSquare = 0;
};

using Columns = std::vector<std::vector<double>>;  // by column, by square

Linear solved(const GlareData& data, const Columns& columns) {
    const auto free = static_cast<Eigen::Index>(columns.size());
    const auto n = free + static_cast<Eigen::Index>(data.pairs());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd row(n);
    double squares = 0;
    for (std::size_t i = 0; i < data.count(); ++i) {
        const Square& square = data.square(i);
        row.setZero();
        for (std::size_t c = 0; c < columns.size(); ++c)
            row[static_cast<Eigen::Index>(c)] = columns[c][i] / square.sigma;
        row[free + static_cast<Eigen::Index>(square.pair)] =
            square.unlit * data.drift() / square.sigma;
        const double seen = square.difference / square.sigma;
        normal += row * row.transpose();
        right += row * seen;
        squares += seen * seen;
    }
    // Drifts are drawn to 0 by their size. What shape there is of a halo that is not there is free,
    // and drawn to 0 by a size of 1, which is that of any shape.
    for (Eigen::Index i = 2; i < n; ++i) normal(i, i) += 1;
    // Shares are small: the columns are brought to one size before they are solved.
    const Eigen::VectorXd scale = normal.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
    const Eigen::LDLT<Eigen::MatrixXd> solver(scaled);
    const Eigen::VectorXd scaledRight = scale.asDiagonal() * right;
    const Eigen::MatrixXd inverse = solver.solve(Eigen::MatrixXd::Identity(n, n));
    Linear linear{.found = scale.asDiagonal() * Eigen::VectorXd(solver.solve(scaledRight)),
                  .covariance = scale.asDiagonal() * inverse * scale.asDiagonal()};
    linear.chiSquare = squares - linear.found.dot(right);
    return linear;
}

Columns sharesOf(const GlareData& data, double radius, double exponent) {
    Columns columns(1);
    for (std::size_t i = 0; i < data.count(); ++i) columns[0].push_back(data.even(data.square(i)));
    columns.push_back(data.halo(radius, exponent));
    return columns;
}

/// The best shares for a given shape of the halo.
struct Shares {
    double everywhere = 0, halo = 0;
    std::vector<double> drifts;  ///< relative, by pair
    double chiSquare = 0;
};

Shares sharesFor(const GlareData& data, double radius, double exponent) {
    const Linear linear = solved(data, sharesOf(data, radius, exponent));
    Shares shares{.everywhere = linear.found[0],
                  .halo = linear.found[1],
                  .drifts = {},
                  .chiSquare = linear.chiSquare};
    for (Eigen::Index i = 2; i < linear.found.size(); ++i)
        shares.drifts.push_back(linear.found[i] * data.drift());
    return shares;
}

/// Of each square: what the glare is, and how far what was seen is from that, drift taken off.
struct Comparison {
    std::vector<double> glare, beside;
};

Comparison compared(const GlareData& data, const Shares& shares, double radius, double exponent) {
    Comparison result{.glare = data.halo(radius, exponent), .beside = {}};
    for (std::size_t i = 0; i < data.count(); ++i) {
        const Square& square = data.square(i);
        double& glare = result.glare[i];
        glare = shares.everywhere * data.even(square) + shares.halo * glare;
        const double drift = shares.drifts[square.pair] * square.unlit;
        result.beside.push_back(square.difference - drift - glare);
    }
    return result;
}

/// Of the sum of the shares, with what the halo's shape is unknown by; widened where the squares
/// scatter more than their noise.
double uncertaintyOfShare(const GlareData& data, const GlareSpread& spread) {
    constexpr double kStep = 0.01;  // of the radius' logarithm, and of the exponent
    Columns columns = sharesOf(data, spread.radius, spread.exponent);
    const auto slope = [&](double factor, double added) {
        std::vector<double> up = data.halo(spread.radius * factor, spread.exponent + added);
        const std::vector<double> down = data.halo(spread.radius / factor, spread.exponent - added);
        for (std::size_t i = 0; i < up.size(); ++i)
            up[i] = spread.halo * (up[i] - down[i]) / (2 * kStep);
        return up;
    };
    columns.push_back(slope(std::exp(kStep), 0));
    columns.push_back(slope(1, kStep));
    const Linear linear = solved(data, columns);
    const Eigen::MatrixXd& c = linear.covariance;
    const double scatter = std::max(1.0, linear.chiSquare / static_cast<double>(data.count()));
    return std::sqrt(std::max(0.0, c(0, 0) + c(1, 1) + 2 * c(0, 1)) * scatter);
}

struct Shape {
    double radius = 64, exponent = 1;
};

/// The shape with the least chi-square: the best of a coarse list, then bounded least squares on
/// the two logarithms, with the shares solved for at each step.
Shape shapeFor(const GlareData& data) {
    Shape best;
    double least = sharesFor(data, best.radius, best.exponent).chiSquare;
    for (double radius = 20; radius < kLargestRadius; radius *= 1.5) {
        const double chiSquare = sharesFor(data, radius, 1).chiSquare;
        if (chiSquare >= least) continue;
        least = chiSquare;
        best = {radius, 1};
    }
    FitProblem problem;
    problem.start = {std::log(best.radius), best.exponent};
    problem.lower = {std::log(kSmallestRadius), kLowestExponent};
    problem.upper = {std::log(kLargestRadius), kHighestExponent};
    problem.residualCount = data.count();
    problem.maxIterations = 20;
    problem.residuals = [&](std::span<const double> p, std::span<double> out) {
        const double radius = std::exp(p[0]);
        const Comparison seen = compared(data, sharesFor(data, radius, p[1]), radius, p[1]);
        for (std::size_t i = 0; i < data.count(); ++i)
            out[i] = seen.beside[i] / data.square(i).sigma;
        return true;
    };
    const FitReport report = fit(problem);
    const bool useful = report.ok() || report.status == FitStatus::NotConverged;
    if (!useful || report.params.size() != 2 || !std::isfinite(report.params[0])) return best;
    const Shape fitted{std::exp(report.params[0]), report.params[1]};
    const bool better = sharesFor(data, fitted.radius, fitted.exponent).chiSquare <= least;
    return better ? fitted : best;
}

/// How far the model is beside the squares, as a share of it, noise taken off.
double misfit(const GlareData& data, const Shares& shares, const GlareSpread& spread) {
    const Comparison seen = compared(data, shares, spread.radius, spread.exponent);
    double beside = 0, all = 0;
    for (std::size_t i = 0; i < data.count(); ++i) {
        const double sigma = data.square(i).sigma;
        beside += seen.beside[i] * seen.beside[i] - sigma * sigma;
        all += seen.glare[i] * seen.glare[i];
    }
    return all > 0 ? std::sqrt(std::max(0.0, beside) / all) : 0;
}

}  // namespace

Result<GlareSpread> fitGlare(std::span<const MirrorPair> pairs,
                             const LensMap& map,
                             Radians field,
                             double lightDrift) {
    if (pairs.empty()) {
        return Error{ErrorKind::Quality,
                     "glare: no mirror placement shows an LED in the field and another the same "
                     "LED out of it"};
    }
    const Window& window = pairs.front().lit.window;
    const FieldPixels seen(map, window, field);
    std::vector<Scene> scenes;
    for (const MirrorPair& pair : pairs) {
        Result<Scene> scene = sceneOf(pair, seen);
        if (!scene) return scene.error().in("glare");
        scenes.push_back(std::move(*scene));
    }
    const GlareData data(std::move(scenes), seen.count(), window.binning, lightDrift);
    if (data.count() < kFewestSquares) {
        return Error{ErrorKind::Quality, "glare: too little of the field is seen about the spot"};
    }
    const Shape shape = shapeFor(data);
    const Shares shares = sharesFor(data, shape.radius, shape.exponent);
    GlareSpread spread{.everywhere = std::max(0.0, shares.everywhere),
                       .halo = std::max(0.0, shares.halo),
                       .radius = shape.radius,  // in the window's pixels so far
                       .exponent = shape.exponent};
    spread.uShare = uncertaintyOfShare(data, spread);
    if (spread.share() < kSignificant * spread.uShare) {
        return GlareSpread{.uShare = std::max(spread.uShare, spread.share())};
    }
    spread.uRelative =
        std::max({kLeastRelative, spread.uShare / spread.share(), misfit(data, shares, spread)});
    spread.radius *= window.binning;
    return spread;
}

}  // namespace gonio::proc
