#pragma once
// A family made of kernels. `Lobes` says how many parameters there are and builds the kernel:
//   static constexpr int kShared, kPerBand;
//   template <class P> static auto kernel(const P* shared, const Bands<P>* perBand);
// Include it in the .cpp that makes families only: each is instantiated for double and for dual
// numbers.

#include <utility>

#include "proc/fit/family.h"
#include "proc/solve/jet.h"

namespace gonio::proc {

/// The sum of two kernels.
template <class A, class B>
struct BothKernels {
    A a;
    B b;

    template <Effort E, class D>
    [[nodiscard]] auto f(const Pair<D>& pair) const {
        return a.template f<E>(pair) + b.template f<E>(pair);
    }
};
template <class A, class B>
BothKernels(A, B) -> BothKernels<A, B>;

template <class Lobes>
class KernelFamily final : public Family {
public:
    KernelFamily(std::string name,
                 std::vector<FamilyLobe> lobes,
                 std::vector<FamilyParameter> parameters)
        : Family(std::move(name), std::move(lobes), std::move(parameters)) {}

    [[nodiscard]] LedBands f(const FamilyPoint& point,
                             std::span<const WeightedNode> nodes) const override {
        return ledBands(mean<double>(point, nodes, [](double v, int) { return v; }));
    }

    [[nodiscard]] std::array<BandSlopes, 3> slopes(
        const FamilyPoint& point, std::span<const WeightedNode> nodes) const override {
        using Number = Dual<kLocal>;
        const Bands<Number> f =
            mean<Number>(point, nodes, [](double v, int k) { return Number(v, k); });
        return {slopesOf(f.r), slopesOf(f.g), slopesOf(f.b)};
    }

private:
    static constexpr int kLocal = Lobes::kShared + Lobes::kPerBand;
    static_assert(kLocal <= static_cast<int>(kMostLocal));

    static BandSlopes slopesOf(const Dual<kLocal>& f) {
        BandSlopes slopes{.value = f.a};
        for (int k = 0; k < kLocal; ++k) slopes.slope[static_cast<std::size_t>(k)] = f.v[k];
        return slopes;
    }

    template <class P, class Make>
    [[nodiscard]] static Bands<P> mean(const FamilyPoint& point,
                                       std::span<const WeightedNode> nodes,
                                       Make&& make) {
        std::array<P, Lobes::kShared + 1> shared;
        std::array<Bands<P>, Lobes::kPerBand> perBand;
        for (int k = 0; k < Lobes::kShared; ++k) {
            const auto i = static_cast<std::size_t>(k);
            shared[i] = make(point.shared[i], k);
        }
        for (int k = 0; k < Lobes::kPerBand; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const int place = Lobes::kShared + k;
            perBand[i] = {make(point.perBand[i][Band::R], place),
                          make(point.perBand[i][Band::G], place),
                          make(point.perBand[i][Band::B], place)};
        }
        const auto kernel = Lobes::template kernel<P>(shared.data(), perBand.data());
        Bands<P> sum = Bands<P>::all(P(0));
        for (const WeightedNode& node : nodes) {
            sum = sum + kernel.template f<Effort::Reference>(node.pair) * node.weight;
        }
        return sum;
    }
};

using FamilyList = std::vector<std::unique_ptr<const Family>>;
void addDiffuseFamilies(FamilyList& list);
void addCosineFamilies(FamilyList& list);
void addSlopeFamilies(FamilyList& list);
void addMicrofacetFamilies(FamilyList& list);

/// Parameters that several families have.
namespace family_parameters {

inline constexpr double kLeastAlpha = 5e-3;

[[nodiscard]] inline FamilyParameter albedo(std::size_t lobe = 0) {
    return {.name = "albedo", .lobe = lobe, .unit = "1", .perBand = true, .starts = {0.2}};
}
[[nodiscard]] inline FamilyParameter f0(std::size_t lobe = 0) {
    return {.name = "f0", .lobe = lobe, .unit = "1", .perBand = true, .starts = {0.1}};
}
[[nodiscard]] inline FamilyParameter ks() {
    return {.name = "ks", .lobe = 1, .unit = "1", .upper = 10, .perBand = true, .starts = {0.1}};
}
/// A width in [5e-3, 1].
[[nodiscard]] inline FamilyParameter width(std::string_view name, std::size_t lobe = 0) {
    return {.name = name,
            .lobe = lobe,
            .unit = "1",
            .lower = kLeastAlpha,
            .upper = 1,
            .scale = ParameterScale::Log,
            .starts = {0.007, 0.015, 0.03, 0.06, 0.12, 0.22, 0.4, 0.7}};
}
[[nodiscard]] inline FamilyParameter secondWidth(std::string_view name, std::size_t lobe) {
    FamilyParameter second = width(name, lobe);
    second.likeTheOneBefore = true;
    return second;
}

}  // namespace family_parameters

}  // namespace gonio::proc
