#include "proc/estimate/lookup_pairs.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace gonio::proc {
namespace {

constexpr double kMostDeg = 89;

class Draws {
public:
    explicit Draws(unsigned seed) : random_(seed) {}
    double share() { return unit_(random_); }
    Radians azimuth() { return Radians(2 * kPi * share()); }

private:
    std::mt19937_64 random_;
    std::uniform_real_distribution<double> unit_;
};

}  // namespace

std::vector<LightView> cosinePairs(const PairDraw& draw) {
    Draws draws(draw.seed);
    const auto direction = [&] {
        const double sine = std::sqrt(draws.share()) * sin(Radians::fromDegrees(kMostDeg));
        const Radians phi = draws.azimuth();
        return Direction::fromSpherical(Radians(std::asin(sine)), phi);
    };
    std::vector<LightView> pairs;
    while (pairs.size() < draw.count) {
        const Direction in = direction();
        pairs.push_back({.in = in, .out = direction()});
    }
    return pairs;
}

std::vector<LightView> lobePairs(const PairDraw& draw, double width) {
    Draws draws(draw.seed);
    std::vector<LightView> pairs;
    while (pairs.size() < draw.count) {
        const Radians theta = Radians::fromDegrees(kMostDeg * draws.share());
        const Direction wi = Direction::fromSpherical(theta, draws.azimuth());
        const double t = width * std::exp(-3 + 5.5 * draws.share());
        const Radians phi = draws.azimuth();
        const Eigen::Vector3d h = Eigen::Vector3d(t * cos(phi), t * sin(phi), 1).normalized();
        const auto wo = Direction::fromVector(2 * h.dot(wi.vector()) * h - wi.vector());
        if (wo && wo->z() > cos(Radians::fromDegrees(kMostDeg))) pairs.push_back({wi, *wo});
    }
    return pairs;
}

}  // namespace gonio::proc
