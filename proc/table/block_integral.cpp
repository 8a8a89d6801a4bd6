#include "proc/table/block_integral.h"

#include <algorithm>
#include <cmath>

#include "proc/core/units.h"

namespace gonio::proc {
namespace {

/// Weight of each azimuth, in degrees; empty where the axis leaves a gap.
std::vector<double> azimuthWeights(const SphericalTable& table, const SphericalBlock& block) {
    if (block.isRound()) return {360};
    const std::vector<double>& axis = block.azimuthDeg;
    const double wanted = table.planeSymmetrical ? 180 : 360;
    std::vector<double> weights(axis.size(), 0);
    double widest = 0;
    for (std::size_t i = 1; i < axis.size(); ++i) {
        const double step = axis[i] - axis[i - 1];
        weights[i - 1] += step / 2;
        weights[i] += step / 2;
        widest = std::max(widest, step);
    }
    const double gap = axis.empty() ? wanted : wanted - (axis.back() - axis.front());
    if (std::abs(gap) <= 1e-6) {
        if (table.planeSymmetrical) {
            for (double& weight : weights) weight *= 2;
        }
        return weights;
    }
    if (table.planeSymmetrical || gap < 0 || gap > 1.5 * widest) return {};
    weights.front() += gap / 2;
    weights.back() += gap / 2;
    return weights;
}

/// Integrals over [a, b] of |cos| sin times the two hat functions, angles in radians.
struct HatWeights {
    double low = 0, high = 0;
};
HatWeights hatWeights(double a, double b) {
    const auto plain = [](double t) { return std::sin(t) * std::sin(t) / 2; };
    const auto timesT = [](double t) { return std::sin(2 * t) / 8 - t * std::cos(2 * t) / 4; };
    const double whole = plain(b) - plain(a);
    const double first = timesT(b) - timesT(a);
    const double high = (first - a * whole) / (b - a);
    return {std::abs(whole - high), std::abs(high)};
}

std::vector<double> thetaWeights(const std::vector<double>& axisDeg) {
    std::vector<double> weights(axisDeg.size(), 0);
    for (std::size_t i = 1; i < axisDeg.size(); ++i) {
        const HatWeights hats = hatWeights(Radians::fromDegrees(axisDeg[i - 1]).value(),
                                           Radians::fromDegrees(axisDeg[i]).value());
        weights[i - 1] += hats.low;
        weights[i] += hats.high;
    }
    return weights;
}

/// Of even cells: each its own share of the circle, the half of it standing for both.
std::vector<double> cellAzimuthWeights(const SphericalBlock& block) {
    const std::size_t count = block.azimuthDeg.size();
    return std::vector(count, 360.0 / static_cast<double>(count));
}

std::vector<double> cellThetaWeights(const std::vector<double>& axisDeg) {
    std::vector<double> weights;
    const double half = axisDeg.size() > 1 ? (axisDeg[1] - axisDeg[0]) / 2 : 45;
    for (const double centre : axisDeg) {
        const double low = std::sin(Radians::fromDegrees(centre - half).value());
        const double high = std::sin(Radians::fromDegrees(centre + half).value());
        weights.push_back(std::abs(high * high - low * low) / 2);
    }
    return weights;
}

}  // namespace

double blockIntegral(const SphericalTable& table, const SphericalBlock& block) {
    const std::vector<double> azimuths =
        table.cellCentred ? cellAzimuthWeights(block) : azimuthWeights(table, block);
    if (azimuths.empty()) return std::nan("");
    const std::vector<double> thetas =
        table.cellCentred ? cellThetaWeights(block.thetaDeg) : thetaWeights(block.thetaDeg);
    double sum = 0;
    for (std::size_t a = 0; a < azimuths.size(); ++a) {
        double row = 0;
        for (std::size_t t = 0; t < thetas.size(); ++t) {
            const double f = block.f[block.index(a, t)];
            if (!std::isnan(f)) row += thetas[t] * f;
        }
        sum += Radians::fromDegrees(azimuths[a]).value() * row;
    }
    return sum;
}

}  // namespace gonio::proc
