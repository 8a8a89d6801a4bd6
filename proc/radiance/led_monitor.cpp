#include "proc/radiance/led_monitor.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kLeastPoints = 8;
constexpr double kLeastKelvin = 0.2;
constexpr double kFinestMatters = 5e-4, kFullLevel = 65535;

double level(const WarmUpPoint& p) { return p.signal / p.current; }
double weight(const WarmUpPoint& p) { return std::pow(p.current / p.u, 2); }

/// Weighted, of several frames.
class Mean {
public:
    void add(const WarmUpPoint& p) {
        weights_ += weight(p);
        levels_ += weight(p) * gonio::proc::level(p);
        celsius_ += weight(p) * p.celsius;
    }
    [[nodiscard]] double level() const { return levels_ / weights_; }
    [[nodiscard]] double celsius() const { return celsius_ / weights_; }

private:
    double weights_ = 0, levels_ = 0, celsius_ = 0;
};

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "warm-up of the LED: " + what};
}

}  // namespace

Result<WarmUpFit> fitWarmUp(std::span<const WarmUpPoint> points) {
    if (points.size() < kLeastPoints) {
        return refused(std::to_string(points.size()) + " frames, wanted " +
                       std::to_string(kLeastPoints) + " at least");
    }
    std::map<int, Mean> cycles;
    Mean all;
    double coldest = points.front().celsius, warmest = coldest;
    for (const WarmUpPoint& p : points) {
        if (!(p.u > 0) || !(p.signal > 0) || !(p.current > 0) || !std::isfinite(p.celsius)) {
            return refused("a frame without light, uncertainty or temperature");
        }
        cycles[p.cycle].add(p);
        all.add(p);
        coldest = std::min(coldest, p.celsius);
        warmest = std::max(warmest, p.celsius);
    }
    if (warmest - coldest < kLeastKelvin) {
        return refused("the LED board warmed by " + fixed(warmest - coldest, 2) +
                       " K only, wanted " + fixed(kLeastKelvin, 1) +
                       "; let the rig cool for a minute, and try again");
    }
    if (points.size() < 2 * cycles.size()) return refused("a cycle of a single frame");
    double xx = 0, xy = 0;
    for (const WarmUpPoint& p : points) {
        const Mean& own = cycles[p.cycle];
        const double x = p.celsius - own.celsius();
        xx += weight(p) * x * x;
        xy += weight(p) * x * (level(p) - own.level());
    }
    const double slope = xy / xx;
    WarmUpFit fit{.perKelvin = slope / all.level(),
                  .celsius = all.celsius(),
                  .freedom = points.size() - cycles.size() - 1};
    for (const WarmUpPoint& p : points) {
        const Mean& own = cycles[p.cycle];
        const double left = level(p) - own.level() - slope * (p.celsius - own.celsius());
        fit.chiSquare += weight(p) * left * left;
    }
    // The LED wanders within a cycle too: what noise does not explain makes the slope less certain.
    const double widened = std::max(1.0, fit.chiSquare / static_cast<double>(fit.freedom));
    fit.uPerKelvin = std::sqrt(widened / xx) / all.level();
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
