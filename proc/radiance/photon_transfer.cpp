#include "proc/radiance/photon_transfer.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "proc/radiance/saturation.h"

namespace gonio::proc {
namespace {

constexpr double kLeastPixels = 1000;
constexpr double kRounding = 1.0 / 12;  // DN^2
constexpr int kReweightings = 4;

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "photon transfer: " + what};
}

struct Point {
    double mean = 0;      ///< DN
    double variance = 0;  ///< DN^2
    double pixels = 0;
};

bool alike(const Frame& a, const Frame& b) {
    return a.pixels.size() == b.pixels.size() && a.window == b.window && a.gainDb == b.gainDb &&
           a.exposure.granted == b.exposure.granted && a.led == b.led && a.levels == b.levels;
}

/// Mean and variance over the pixels that are usable in both.
Point pointOf(const Frame& a, const Frame& b, const SensorNoise& noise) {
    const auto width = static_cast<std::size_t>(a.pixels.width());
    std::vector<std::uint8_t> inA(width), inB(width);
    double n = 0, sum = 0, difference = 0, squares = 0;
    for (int y = 0; y < a.pixels.height(); ++y) {
        markUsable(a.pixels, y, noise, inA);
        markUsable(b.pixels, y, noise, inB);
        const auto rowA = a.pixels.row(y);
        const auto rowB = b.pixels.row(y);
        for (std::size_t x = 0; x < width; ++x) {
            if ((inA[x] & inB[x]) == 0) continue;
            const double d = rowA[x] - rowB[x];
            n += 1;
            sum += rowA[x] + rowB[x];
            difference += d;
            squares += d * d;
        }
    }
    if (n < kLeastPixels) return {.pixels = n};
    return {.mean = sum / (2 * n),
            .variance = (squares - difference * difference / n) / (2 * (n - 1)),
            .pixels = n};
}

bool dark(const Frame& frame) { return !frame.led || frame.levels.dark(); }

/// The mean of the shortest dark pair, else the black level that the frames have.
double blackOf(std::span<const FlatPair> pairs, const SensorNoise& noise) {
    std::optional<Nanoseconds> shortest;
    double black = pairs.front().first->blackLevel;
    for (const FlatPair& pair : pairs) {
        const Nanoseconds exposure = pair.first->exposure.granted;
        if (!dark(*pair.first) || (shortest && *shortest <= exposure)) continue;
        const Point point = pointOf(*pair.first, *pair.second, noise);
        if (point.pixels < kLeastPixels) continue;
        shortest = exposure;
        black = point.mean;
    }
    return black;
}

/// variance = line(0) + line(1) mean, and its covariance.
struct Line {
    Eigen::Vector2d values{1, 1};
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    double chiSquare = 0;

    [[nodiscard]] double at(double mean) const {
        return std::max(values(0) + values(1) * mean, kRounding);
    }
};

/// The variance of a variance v from n pixels is 2 v^2 / n.
Line fitted(const std::vector<Point>& points) {
    Line line;
    line.values = {points.front().variance, 1};  // a first guess for the weights
    for (int i = 0; i < kReweightings; ++i) {
        Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
        Eigen::Vector2d right = Eigen::Vector2d::Zero();
        for (const Point& p : points) {
            const Eigen::Vector2d row(1, p.mean);
            const double weight = p.pixels / (2 * line.at(p.mean) * line.at(p.mean));
            normal += weight * row * row.transpose();
            right += weight * p.variance * row;
        }
        line.covariance = normal.inverse();
        line.values = line.covariance * right;
    }
    for (const Point& p : points) {
        const double rest = p.variance - line.values(0) - line.values(1) * p.mean;
        line.chiSquare += p.pixels * rest * rest / (2 * line.at(p.mean) * line.at(p.mean));
    }
    return line;
}

/// K = 1 / slope, s_r = K sqrt(start - 1/12), their uncertainties by first order.
PhotonTransfer transferOf(const Line& line) {
    const double k = 1 / line.values(1);
    const double variance = line.values(0) - kRounding;
    PhotonTransfer found;
    found.electronsPerDn = k;
    found.uElectronsPerDn = k * k * std::sqrt(line.covariance(1, 1));
    found.chiSquare = line.chiSquare;
    const double uVariance = std::sqrt(line.covariance(0, 0));
    if (variance <= 0) {
        found.uReadNoiseElectrons = k * std::sqrt(uVariance);
        return found;
    }
    const double read = std::sqrt(variance);
    found.readNoiseElectrons = k * read;
    const Eigen::Vector2d slope(k / (2 * read), -k * k * read);
    found.uReadNoiseElectrons = std::sqrt(slope.dot(line.covariance * slope));
    return found;
}

/// Means less than this apart are of one light: dark pairs, and pairs taken alike.
constexpr double kOneLight = 1;  // DN

/// A line has two ends, and something between them that can be off it.
bool tellsALine(const std::vector<Point>& points) {
    std::vector<double> means;
    for (const Point& point : points) means.push_back(point.mean);
    std::sort(means.begin(), means.end());
    int lights = 0;
    double last = 0;
    for (const double mean : means) {
        if (lights > 0 && mean <= last + kOneLight) continue;
        ++lights;
        last = mean;
    }
    return lights >= 3;
}

}  // namespace

Result<PhotonTransfer> photonTransfer(std::span<const FlatPair> pairs, const SensorNoise& noise) {
    for (const FlatPair& pair : pairs) {
        if (pair.first == nullptr || pair.second == nullptr || pair.first->pixels.empty())
            return refused("a pair without frames");
        if (!alike(*pair.first, *pair.second)) {
            return refused("frames " + std::to_string(pair.first->number) + " and " +
                           std::to_string(pair.second->number) + " were not taken alike");
        }
    }
    std::vector<Point> points;
    if (!pairs.empty()) {
        const double black = blackOf(pairs, noise);
        for (const FlatPair& pair : pairs) {
            Point point = pointOf(*pair.first, *pair.second, noise);
            if (point.pixels < kLeastPixels) continue;
            point.mean -= black;
            points.push_back(point);
        }
    }
    if (points.empty() || !tellsALine(points)) {
        return refused(std::to_string(points.size()) + " usable pairs of " +
                       std::to_string(pairs.size()) +
                       "; at least three of different light are needed");
    }
    const Line line = fitted(points);
    if (!line.values.allFinite() || line.values(1) < 3 * std::sqrt(line.covariance(1, 1)))
        return refused("the variance does not rise with the mean");
    PhotonTransfer found = transferOf(line);
    found.pairs = static_cast<int>(points.size());
    found.freedom = points.size() - 2;
    return found;
}

}  // namespace gonio::proc
