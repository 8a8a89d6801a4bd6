#include "proc/calibrate/monte_carlo.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>
#include <vector>

namespace gonio::proc {
namespace {

constexpr double kExpansion = 1.96;
constexpr double kHeld = 0.95;
constexpr double kSecondOrderShare = 0.1;  // of u
constexpr double kContrastShare = 0.1;     // of the contrast
constexpr int kFewestDraws = 20;

/// The half width that holds 95 % of the deviations, in standard deviations of a Gaussian.
double halfWidth(std::vector<double>& deviations) {
    const auto at = static_cast<std::ptrdiff_t>(kHeld * static_cast<double>(deviations.size()));
    std::nth_element(deviations.begin(), deviations.begin() + at, deviations.end());
    return deviations[static_cast<std::size_t>(at)] / kExpansion;
}

/// One draw of the noise, and of all the rest upon it.
class Sampler {
public:
    Sampler(const CellInputs& best, std::uint64_t seed) : best_(best), random_(seed) {}

    CellInputs noise() {
        CellInputs drawn = best_;
        drawn.sample += std::sqrt(best_.sampleVariance) * normal_(random_);
        drawn.white += std::sqrt(best_.whiteVariance) * normal_(random_);
        drawn.black += std::sqrt(best_.blackVariance) * normal_(random_);
        return drawn;
    }
    /// f of it with everything else off, too.
    double disturbed(CellInputs drawn) {
        for (double* signal : {&drawn.sample, &drawn.white, &drawn.black}) {
            *signal *= 1 + best_.uLight * normal_(random_);
        }
        drawn.fWhite *= 1 + best_.uWhite * normal_(random_);
        drawn.fBlack += best_.uBlack * normal_(random_);
        const double x = best_.uAngle.alongTheta.value() * normal_(random_);
        const double y = best_.uAngle.alongPhi.value() * normal_(random_);
        return best_.shape.at(drawn.f(), x, y) + best_.uElse * normal_(random_);
    }

private:
    const CellInputs& best_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
};

}  // namespace

double CellInputs::f() const {
    return fBlack + (fWhite - fBlack) * (sample - black) / (white - black);
}

PropagatedUncertainty propagate(const CellInputs& inputs, int draws, std::uint64_t seed) {
    assert(draws >= kFewestDraws);
    const double best = inputs.f();
    Sampler sampler(inputs, seed);
    std::vector<double> byNoise, byAll;
    for (int i = 0; i < std::max(draws, kFewestDraws); ++i) {
        const CellInputs noisy = sampler.noise();
        byNoise.push_back(std::abs(noisy.f() - best));
        byAll.push_back(std::abs(sampler.disturbed(noisy) - best));
    }
    const double random = halfWidth(byNoise);
    const double all = std::max(random, halfWidth(byAll));
    return {.random = random, .systematic = std::sqrt(all * all - random * random)};
}

bool firstOrderFails(const CellInputs& inputs, double u) {
    const double contrast = inputs.white - inputs.black;
    const double uContrast = std::hypot(std::sqrt(inputs.whiteVariance + inputs.blackVariance),
                                        inputs.uLight * inputs.white,
                                        inputs.uLight * inputs.black);
    return uContrast > kContrastShare * contrast ||
           inputs.shape.secondOrder(inputs.f(), inputs.uAngle) > kSecondOrderShare * u;
}

}  // namespace gonio::proc
