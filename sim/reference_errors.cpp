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
constexpr double kZero = 1e-5;                                    // 1/sr
constexpr std::uint64_t kZeroComponent = std::uint64_t{1} << 32;  // behind all field nodes
constexpr double kNodeDegrees = 5;
constexpr std::uint64_t kNodesPerField = 10000;
constexpr std::size_t kNodesPerRow = 100;
constexpr std::size_t kRows = 41;  // of nodes: -100..100 degrees

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

/// A node of the field and its weight in one direction.
struct Share {
    std::size_t node = 0;
    double weight = 0;
};

/// Nodes on a square grid of the azimuthal-equidistant plane; the bilinear weights are normalised
/// to unit variance, so that no direction is better known than another.
std::array<Share, 4> sharesOf(const Direction& wo) {
    const double degrees = wo.theta().degrees();
    const Radians phi = wo.phi();
    const double u = (degrees * cos(phi) + 100) / kNodeDegrees;
    const double v = (degrees * sin(phi) + 100) / kNodeDegrees;
    const double fu = u - std::floor(u);
    const double fv = v - std::floor(v);
    const std::size_t first =
        static_cast<std::size_t>(u) * kNodesPerRow + static_cast<std::size_t>(v);
    std::array<Share, 4> shares{{{first, (1 - fu) * (1 - fv)},
                                 {first + 1, (1 - fu) * fv},
                                 {first + kNodesPerRow, fu * (1 - fv)},
                                 {first + kNodesPerRow + 1, fu * fv}}};
    double squares = 0;
    for (const Share& share : shares) squares += share.weight * share.weight;
    const double norm = 1 / std::sqrt(squares);
    for (Share& share : shares) share.weight *= norm;
    return shares;
}

/// The component of the field's first node.
std::uint64_t firstNode(int led, Band band) {
    return 2 + (static_cast<std::uint64_t>(led) * 3 + index(band)) * kNodesPerField;
}

}  // namespace

ReferenceErrors ReferenceErrors::random(std::uint64_t seed) {
    ReferenceErrors errors;
    errors.kind_ = Kind::Random;
    errors.seed_ = seed;
    return errors;
}

ReferenceErrors ReferenceErrors::stratified(int run) {
    ReferenceErrors errors;
    errors.kind_ = Kind::Stratified;
    errors.run_ = run;
    return errors;
}

Result<ReferenceErrors> ReferenceErrors::parse(std::string_view text, std::uint64_t seed) {
    if (text == "none") return ReferenceErrors();
    if (text == "random") return random(seed);
    if (text.starts_with("stratum:")) {
        const auto run = parseInteger(text.substr(8));
        if (run && *run >= 0 && *run < kStrata) return stratified(static_cast<int>(*run));
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
    const std::uint64_t first = firstNode(led, band);
    double sum = 0;
    for (const Share& share : sharesOf(wo)) sum += share.weight * deviate(first + share.node);
    return sum;
}

double ReferenceErrors::white(int led, Band band, const Direction& wo) const {
    if (kind_ == Kind::None) return 1;
    return 1 + kWhiteCommon * deviate(0) + kWhitePerDirection * field(led, band, wo);
}

WhiteErrors ReferenceErrors::white(int led) const {
    WhiteErrors errors;
    if (kind_ == Kind::None) return errors;
    errors.common_ = 1 + kWhiteCommon * deviate(0);
    errors.nodes_.resize(kRows * kNodesPerRow);
    for (std::size_t row = 0; row < kRows; ++row) {
        for (std::size_t column = 0; column < kRows; ++column) {
            const std::size_t node = row * kNodesPerRow + column;
            for (Band b : kBands) errors.nodes_[node][b] = deviate(firstNode(led, b) + node);
        }
    }
    return errors;
}

LedBands WhiteErrors::factor(const Direction& wo) const {
    if (nodes_.empty()) return LedBands::all(1);
    LedBands factor = LedBands::all(common_);
    for (const Share& share : sharesOf(wo)) {
        const LedBands& node = nodes_[share.node];
        for (Band b : kBands) factor[b] += kWhitePerDirection * share.weight * node[b];
    }
    return factor;
}

double ReferenceErrors::black() const { return 1 + kBlack * deviate(1); }

double ReferenceErrors::zero() const { return kZero * std::abs(deviate(kZeroComponent)); }

}  // namespace gonio::sim
