#include "proc/estimate/gradient_extrapolator.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

class GradientExtrapolator : public Extrapolator {
public:
    GradientExtrapolator(std::unique_ptr<Scatterer> inner,
                         const Beyond& beyond,
                         const GradientOptions& options)
        : Extrapolator(std::move(inner), beyond), options_(options) {}

protected:
    [[nodiscard]] Answer outside(const LightView& pair) const override {
        const double chord = 2 * sin((thetaOf(pair) - edge()) / 2);
        const double t = bentStep(std::min(1.0, chord / options_.distance), options_.bend);
        return extrapolated(atEdge(pair), 1 - t + t * options_.ratio);
    }

private:
    GradientOptions options_;
};

}  // namespace

// (1 - 2 l) s^2 + 2 l s = x by the form of the root that does not cancel; it is 0 / 0 at x = l = 0,
// where s = 0.
double bentStep(double x, double bend) {
    const double root = std::sqrt(std::max(0.0, bend * bend + (1 - 2 * bend) * x));
    if (bend + root == 0) return 0;
    const double s = std::min(1.0, x / (bend + root));
    return 2 * (1 - s) * s * (1 - bend) + s * s;
}

Result<std::unique_ptr<Scatterer>> makeGradientExtrapolator(std::unique_ptr<Scatterer> inner,
                                                            const Beyond& beyond,
                                                            const GradientOptions& options) {
    const bool valid = options.ratio >= 0 && std::isfinite(options.ratio) && options.distance > 0 &&
                       options.bend >= 0 && options.bend <= 1;
    if (!valid) {
        return Error{ErrorKind::Usage,
                     "gradient extrapolation: wanted a ratio of at least 0, a distance above 0 and "
                     "a bend in [0, 1]"};
    }
    return makeExtrapolator<GradientExtrapolator>(std::move(inner), beyond, options);
}

}  // namespace gonio::proc
