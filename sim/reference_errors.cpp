#include "sim/reference_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "proc/core/number_text.h"
#include "sim/random.h"

namespace gonio::sim {
namespace {

constexpr double kWhiteCommon = 0.005;
constexpr double kWhitePerDirection = 0.003;
constexpr double kBlack = 0.10;
constexpr double kNodeDegrees = 5;
constexpr std::uint64_t kNodesPerField = 10000;

/// Where `run` stands in the component's own order of the 20 strata.
int stratumOf(std::uint64_t key, int run) {
    std::array<int, kStrata> order{};
    for (int i = 0; i < kStrata; ++i) order[static_cast<std::size_t>(i)] = i;
    for (int i = kStrata - 1; i > 0; --i) {
        const auto j =
            static_cast<std::size_t>(uniform(key, static_cast<std::uint64_t>(i)) * (i + 1));
        std::swap(order[static_cast<std::size_t>(i)], order[j]);
    }
    return order[static_cast<std::size_t>(run)];
}

}  // namespace

ReferenceErrors ReferenceErrors::random(std::uint64_t seed) {
    ReferenceErrors errors;
    errors.kind_ = Kind::Random;
    errors.seed_ = seed;
    return errors;
}

ReferenceErrors ReferenceErrors::stratified(int run, std::uint64_t seed) {
    ReferenceErrors errors;
    errors.kind_ = Kind::Stratified;
    errors.run_ = run;
    errors.seed_ = seed;
    return errors;
}

Result<ReferenceErrors> ReferenceErrors::parse(std::string_view text, std::uint64_t seed) {
    if (text == "none") return ReferenceErrors();
    if (text == "random") return random(seed);
    if (text.starts_with("stratum:")) {
        const auto run = parseInteger(text.substr(8));
        if (run && *run >= 0 && *run < kStrata) return stratified(static_cast<int>(*run), seed);
    }
    return Error{ErrorKind::Usage,
                 "systematic errors '" + std::string(text) +
                     "': wanted none, random or stratum:K with K in 0..19"};
}

double ReferenceErrors::deviate(std::uint64_t component) const {
    const std::uint64_t key = mixed(mixed(seed_, 0x72656673), component);
    switch (kind_) {
        case Kind::None: return 0;
        case Kind::Random: return gaussian(key, 0);
        case Kind::Stratified: return normalQuantile((stratumOf(key, run_) + 0.5) / kStrata);
    }
    return 0;
}

double ReferenceErrors::field(int led, Band band, const Direction& wo) const {
    // Nodes on a square grid of the azimuthal-equidistant plane; the bilinear weights are
    // normalised to unit variance, so that no direction is better known than another.
    const double degrees = wo.theta().degrees();
    const double u = (degrees * cos(wo.phi()) + 100) / kNodeDegrees;
    const double v = (degrees * sin(wo.phi()) + 100) / kNodeDegrees;
    const double u0 = std::floor(u);
    const double v0 = std::floor(v);
    const std::uint64_t first =
        2 + (static_cast<std::uint64_t>(led) * 3 + index(band)) * kNodesPerField;
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            const double weight =
                (i == 0 ? 1 - (u - u0) : u - u0) * (j == 0 ? 1 - (v - v0) : v - v0);
            const auto node = static_cast<std::uint64_t>((u0 + i) * 100 + (v0 + j));
            sum += weight * deviate(first + node);
            squares += weight * weight;
        }
    }
    return sum / std::sqrt(squares);
}

double ReferenceErrors::white(int led, Band band, const Direction& wo) const {
    if (kind_ == Kind::None) return 1;
    return 1 + kWhiteCommon * deviate(0) + kWhitePerDirection * field(led, band, wo);
}

double ReferenceErrors::black() const { return 1 + kBlack * deviate(1); }

}  // namespace gonio::sim
