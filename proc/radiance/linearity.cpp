#include "proc/radiance/linearity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "proc/radiance/exposure_groups.h"
#include "proc/radiance/saturation.h"

namespace gonio::proc {
namespace {

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "linearity: " + what};
}

/// By what m + a_2 m^2 + ... is multiplied, so that the integral of m times the correction over
/// 0..1 is zero: the best line through zero has slope 1.
double toUnitSlope(std::span<const double> higher) {
    double sum = 0;
    for (std::size_t i = 0; i < higher.size(); ++i) sum += higher[i] / static_cast<double>(i + 4);
    return 1 / (1 + 3 * sum);
}

/// Largest distance of the response M(L) from its best line over the range, in per cent of it.
double inlPercent(const Linearity& linearity) {
    constexpr int kSteps = 200;
    double sumM = 0, sumMm = 0, sumC = 0, sumMc = 0;
    const auto at = [&](int i) { return static_cast<double>(i) / kSteps; };
    const auto c = [&](int i) {
        return linearity.correction(linearity.blackDn + at(i) * linearity.rangeDn) /
               linearity.rangeDn;
    };
    for (int i = 0; i <= kSteps; ++i) {
        sumM += at(i);
        sumMm += at(i) * at(i);
        sumC += c(i);
        sumMc += at(i) * c(i);
    }
    const double n = kSteps + 1;
    const double slope = (n * sumMc - sumM * sumC) / (n * sumMm - sumM * sumM);
    const double start = (sumC - slope * sumM) / n;
    double largest = 0;
    for (int i = 0; i <= kSteps; ++i)
        largest = std::max(largest, std::abs(c(i) - start - slope * at(i)));
    return 100 * largest;
}

/// Each row divided by its point's uncertainty: tau / largest tau, 1, and -range m^k.
Eigen::MatrixXd design(std::span<const SweepPoint> sweep,
                       double range,
                       double longest,
                       int degree) {
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(sweep.size()), degree + 1);
    for (Eigen::Index j = 0; j < rows.rows(); ++j) {
        const SweepPoint& point = sweep[static_cast<std::size_t>(j)];
        rows(j, 0) = point.tau / longest / point.u;
        rows(j, 1) = 1 / point.u;
        for (int k = 2; k <= degree; ++k)
            rows(j, k) = -range * std::pow(point.meanDn / range, k) / point.u;
    }
    return rows;
}

std::string misfit(std::span<const SweepPoint> sweep, int degree) {
    if (degree < 2 || degree > 6) return "a polynomial of degree " + std::to_string(degree);
    if (sweep.size() < static_cast<std::size_t>(degree) + 2) {
        return std::to_string(sweep.size()) + " exposures for a polynomial of degree " +
               std::to_string(degree) + ", at least " + std::to_string(degree + 2) + " are needed";
    }
    const auto good = [](const SweepPoint& p) {
        return std::isfinite(p.meanDn) && std::isfinite(p.tau) && p.tau > 0 && std::isfinite(p.u) &&
               p.u > 0;
    };
    if (!std::all_of(sweep.begin(), sweep.end(), good))
        return "an exposure without a time, a mean or an uncertainty";
    return {};
}

}  // namespace

double Linearity::correction(double dn) const {
    if (identity()) return 0;
    const double m = std::min((dn - blackDn) / rangeDn, 1.0);
    if (m < 0) return rangeDn * coefficients.front() * m;
    double sum = 0;
    for (auto a = coefficients.rbegin(); a != coefficients.rend(); ++a) sum = (sum + *a) * m;
    return rangeDn * sum;
}

Result<SweepPoint> sweepPoint(std::span<const Frame> frames,
                              Band band,
                              const DarkLibrary& darks,
                              const SensorNoise& noise) {
    const Result<std::vector<ExposureGroup>> groups = exposureGroups(frames, band, darks);
    if (!groups) return groups.error().in("linearity");
    if (groups->size() != 1) return refused("frames of different exposures in one point");
    const ExposureGroup& group = groups->front();
    double sum = 0;
    std::size_t used = 0, all = 0;
    const Image<float>& dark = group.dark->mean;
    std::vector<std::uint8_t> usable(static_cast<std::size_t>(dark.width()));
    for (const Frame& frame : frames) {
        for (int y = 0; y < dark.height(); ++y) {
            markUsable(frame.pixels, y, noise, usable);
            const auto row = frame.pixels.row(y);
            for (std::size_t x = 0; x < usable.size(); ++x) {
                used += usable[x];
                sum += usable[x] * (row[x] - static_cast<double>(dark.row(y)[x]));
            }
        }
        all += dark.pixels().size();
    }
    if (100 * (all - used) >= all) {
        return refused("one pixel in a hundred is saturated at " +
                       std::to_string(group.dark->exposure.granted.count()) + " ns");
    }
    const auto n = static_cast<double>(used);
    const double k = noise.electronsPerDn;
    SweepPoint point{.tau = group.tau, .meanDn = sum / n, .u = 0};
    const double single = noise.variance(point.meanDn * k, group.seconds) / (k * k);
    const auto pixels = static_cast<double>(dark.pixels().size());
    point.u = std::sqrt(single / n + group.dark->varianceOfMean / pixels);
    return point;
}

Result<LinearityFit> fitLinearity(std::span<const SweepPoint> sweep, double blackDn, int degree) {
    if (std::string why = misfit(sweep, degree); !why.empty()) return refused(why);
    double range = 0, longest = 0;
    for (const SweepPoint& point : sweep) {
        range = std::max(range, point.meanDn);
        longest = std::max(longest, point.tau);
    }
    if (range <= 0) return refused("no light in any exposure");
    const Eigen::MatrixXd a = design(sweep, range, longest, degree);
    Eigen::VectorXd seen(a.rows());
    for (Eigen::Index j = 0; j < a.rows(); ++j) {
        const SweepPoint& point = sweep[static_cast<std::size_t>(j)];
        seen(j) = point.meanDn / point.u;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
    const Eigen::VectorXd found = qr.solve(seen);
    if (qr.rank() < a.cols() || !found.allFinite())
        return refused("the exposures are too much alike to tell the terms apart");
    const Eigen::VectorXd rest = seen - a * found;
    const double scale = toUnitSlope({found.data() + 2, static_cast<std::size_t>(degree) - 1});
    LinearityFit fit;
    fit.linearity = {.blackDn = blackDn, .rangeDn = range, .coefficients = {scale - 1}};
    for (int k = 2; k <= degree; ++k) fit.linearity.coefficients.push_back(scale * found(k));
    fit.inlPercent = inlPercent(fit.linearity);
    fit.offsetDn = scale * found(1);
    fit.uOffsetDn = scale * std::sqrt((a.transpose() * a).inverse()(1, 1));
    fit.rate = scale * found(0) / longest;
    fit.chiSquare = rest.squaredNorm();
    fit.freedom = sweep.size() - static_cast<std::size_t>(degree) - 1;
    for (Eigen::Index j = 0; j < rest.size(); ++j) {
        const double dn = std::abs(rest(j)) * sweep[static_cast<std::size_t>(j)].u;
        fit.largestResidualDn = std::max(fit.largestResidualDn, dn);
    }
    return fit;
}

}  // namespace gonio::proc
