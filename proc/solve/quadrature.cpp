#include "proc/solve/quadrature.h"

#include <cmath>

#include "proc/core/units.h"

namespace gonio::proc {
namespace {

struct Legendre {
    double value;
    double slope;
};

Legendre legendre(std::size_t n, double x) {
    double before = 1;
    double now = x;
    for (std::size_t k = 2; k <= n; ++k) {
        const auto d = static_cast<double>(k);
        const double next = ((2 * d - 1) * x * now - (d - 1) * before) / d;
        before = now;
        now = next;
    }
    const auto d = static_cast<double>(n);
    return {now, d * (x * now - before) / (x * x - 1)};
}

}  // namespace

std::vector<QuadratureNode> gaussLegendre(std::size_t n) {
    std::vector<QuadratureNode> nodes;
    const auto count = static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) {
        double x = std::cos(kPi * (static_cast<double>(i) + 0.75) / (count + 0.5));
        constexpr int kSteps = 20;
        for (int step = 0; step < kSteps; ++step) {
            const Legendre p = legendre(n, x);
            const double change = p.value / p.slope;
            x -= change;
            if (std::abs(change) < 1e-16) break;
        }
        const double slope = legendre(n, x).slope;
        nodes.push_back({.x = (1 - x) / 2, .weight = 1 / ((1 - x) * (1 + x) * slope * slope)});
    }
    return nodes;
}

// x = (1 + tanh(s)) / 2, s = (pi / 2) sinh(t): 1 - x = 1 / (1 + exp(2 s)).
std::vector<QuadratureNode> tanhSinh(std::size_t n) {
    constexpr double kReach = 3.2;  // weights below 1e-16 beyond
    const double step = kReach / static_cast<double>(n);
    std::vector<QuadratureNode> nodes;
    double sum = 0;
    for (std::size_t i = 0; i <= 2 * n; ++i) {
        const double t = (static_cast<double>(i) - static_cast<double>(n)) * step;
        const double twice = kPi * std::sinh(t);
        const double x = 1 / (1 + std::exp(-twice));
        const double oneMinusX = 1 / (1 + std::exp(twice));
        nodes.push_back({.x = x, .weight = step * kPi * std::cosh(t) * x * oneMinusX});
        sum += nodes.back().weight;
    }
    for (QuadratureNode& node : nodes) node.weight /= sum;
    return nodes;
}

}  // namespace gonio::proc
