#include "proc/radiance/linearity.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "proc/core/number_text.h"
#include "proc/radiance/exposure_groups.h"
#include "proc/radiance/saturation.h"

namespace gonio::proc {
namespace {

// Of a sweep's pixels, relative: what bends the mean of readings is the bend of their mean then, to
// a hundredth.
constexpr double kUneven = 0.05;

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

/// The pixels that all frames of a sweep can use: were more of the dim ones in the mean of a bright
/// exposure, that would be taken for a bend.
class CommonPixels {
public:
    CommonPixels(std::span<const Frame> sweep, const SensorNoise& noise)
        : usable_(sweep.front().pixels.size(), 1) {
        std::vector<std::uint8_t> marks(static_cast<std::size_t>(usable_.width()));
        for (const Frame& frame : sweep) {
            for (int y = 0; y < usable_.height(); ++y) {
                markUsable(frame.pixels, y, noise, marks);
                for (std::size_t x = 0; x < marks.size(); ++x) usable_.row(y)[x] &= marks[x];
            }
        }
        for (const std::uint8_t one : usable_.pixels()) count_ += one;
    }

    [[nodiscard]] bool fewerThan99PerCent() const {
        return count_ < 0.99 * static_cast<double>(usable_.pixels().size()) || count_ == 0;
    }

    [[nodiscard]] SweepPoint point(const ExposureGroup& group, const SensorNoise& noise) const {
        double sum = 0;
        forEach(group, [&](double mean) { sum += mean; });
        SweepPoint point{.tau = group.tau, .meanDn = sum / count_, .u = 0};
        point.u = std::sqrt(noiseOf(group, point.meanDn, noise) / count_);
        return point;
    }

    /// Standard deviation between the pixels over their mean, beyond the noise.
    [[nodiscard]] double unevenness(const ExposureGroup& group, const SensorNoise& noise) const {
        const double mean = point(group, noise).meanDn;
        double squares = 0;
        forEach(group, [&](double own) { squares += (own - mean) * (own - mean); });
        const double variance = squares / count_ - noiseOf(group, mean, noise);
        return std::sqrt(std::max(0.0, variance)) / std::abs(mean);
    }

private:
    /// DN^2, of the mean of a pixel over the frames of a group, less the dark.
    static double noiseOf(const ExposureGroup& group, double meanDn, const SensorNoise& noise) {
        const double k = noise.electronsPerDn;
        const double single = noise.variance(meanDn * k, group.seconds) / (k * k);
        return single / static_cast<double>(group.frames.size()) + group.dark->varianceOfMean;
    }

    /// Calls with the mean of each pixel over the frames of a group, less the dark.
    template <class Call>
    void forEach(const ExposureGroup& group, const Call& call) const {
        const auto frames = static_cast<double>(group.frames.size());
        for (int y = 0; y < usable_.height(); ++y) {
            for (int x = 0; x < usable_.width(); ++x) {
                if (usable_.at(x, y) == 0) continue;
                double sum = 0;
                for (const Frame* frame : group.frames) sum += frame->pixels.at(x, y);
                call(sum / frames - static_cast<double>(group.dark->mean.at(x, y)));
            }
        }
    }

    Image<std::uint8_t> usable_;
    double count_ = 0;
};

}  // namespace

double Linearity::correction(double dn) const {
    if (identity()) return 0;
    const double m = std::min((dn - blackDn) / rangeDn, 1.0);
    if (m < 0) return rangeDn * coefficients.front() * m;
    double sum = 0;
    for (auto a = coefficients.rbegin(); a != coefficients.rend(); ++a) sum = (sum + *a) * m;
    return rangeDn * sum;
}

Result<std::vector<SweepPoint>> sweepPoints(std::span<const Frame> sweep,
                                            Band band,
                                            const DarkLibrary& darks,
                                            const SensorNoise& noise) {
    const Result<std::vector<ExposureGroup>> groups = exposureGroups(sweep, band, darks);
    if (!groups) return groups.error().in("linearity");
    const CommonPixels common(sweep, noise);
    if (common.fewerThan99PerCent())
        return refused("one pixel in a hundred is saturated; leave the longest exposures out");
    const auto brightest =
        std::max_element(groups->begin(), groups->end(), [](const auto& one, const auto& other) {
            return one.tau < other.tau;
        });
    const double uneven = common.unevenness(*brightest, noise);
    if (uneven > kUneven) {
        return refused("the pixels of a sweep differ by " + fixed(100 * uneven, 1) +
                       " % rms, at most " + fixed(100 * kUneven, 0) +
                       " % is good; choose a window that is lit evenly");
    }
    std::vector<SweepPoint> points;
    for (const ExposureGroup& group : *groups) points.push_back(common.point(group, noise));
    return points;
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
