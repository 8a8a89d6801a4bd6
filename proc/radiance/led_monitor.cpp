#include "proc/radiance/led_monitor.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kLeastPoints = 8;
constexpr double kLeastKelvin = 0.2;
constexpr double kFinestMatters = 5e-4, kFullLevel = 65535;

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "warm-up of the LED: " + what};
}

}  // namespace

Result<WarmUpFit> fitWarmUp(std::span<const WarmUpPoint> points) {
    if (points.size() < kLeastPoints) {
        return refused(std::to_string(points.size()) + " frames, wanted " +
                       std::to_string(kLeastPoints) + " at least");
    }
    double celsius = 0, time = 0, coldest = points.front().celsius, warmest = coldest;
    const auto count = static_cast<double>(points.size());
    for (const WarmUpPoint& p : points) {
        if (!(p.u > 0) || !(p.signal > 0) || !(p.current > 0) || !std::isfinite(p.celsius)) {
            return refused("a frame without light, uncertainty or temperature");
        }
        celsius += p.celsius / count;
        time += p.time / count;
        coldest = std::min(coldest, p.celsius);
        warmest = std::max(warmest, p.celsius);
    }
    if (warmest - coldest < kLeastKelvin) {
        return refused("the LED board warmed by " + fixed(warmest - coldest, 2) +
                       " K only, wanted " + fixed(kLeastKelvin, 1) +
                       "; let the rig cool for a minute, and try again");
    }
    Eigen::MatrixX3d rows(std::ssize(points), 3);  // 1, T - T_0, t, each over its point's u
    Eigen::VectorXd seen(rows.rows());
    for (Eigen::Index j = 0; j < rows.rows(); ++j) {
        const WarmUpPoint& p = points[static_cast<std::size_t>(j)];
        const double weight = p.current / p.u;
        rows.row(j) << weight, weight * (p.celsius - celsius), weight * (p.time - time);
        seen(j) = weight * p.signal / p.current;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixX3d> qr(rows);
    if (qr.rank() < rows.cols()) {
        return refused("temperature and time went together; let the LED cool in between");
    }
    const Eigen::Vector3d found = qr.solve(seen);
    WarmUpFit fit{.perKelvin = found(1) / found(0),
                  .celsius = celsius,
                  .chiSquare = (seen - rows * found).squaredNorm(),
                  .freedom = points.size() - 3};
    // What wanders otherwise than straight makes the slope less certain.
    const double widened = std::max(1.0, fit.chiSquare / static_cast<double>(fit.freedom));
    const Eigen::Matrix3d covariance = (rows.transpose() * rows).inverse();
    fit.uPerKelvin = std::sqrt(widened * covariance(1, 1)) / found(0);
    return fit;
}

double LedMonitor::relativeCurrent(Band band, const LedDrive& drive) const {
    const double nominal = fullMilliamp[index(band)] * drive.level / kFullLevel;
    const double uniform = milliampStep / std::sqrt(12.0);
    const bool tells = drive.milliamp > 0 && uniform < kFinestMatters * nominal;
    return tells ? drive.milliamp / nominal : 1;
}

double LedMonitor::light(Band band, const LedDrive& drive) const {
    const WarmUpFit& fit = bands[index(band)];
    return relativeCurrent(band, drive) * (1 + fit.perKelvin * (drive.celsius - fit.celsius));
}

}  // namespace gonio::proc
