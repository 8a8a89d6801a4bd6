#include "proc/estimate/baked_table.h"

#include <array>
#include <cstring>
#include <limits>
#include <span>

namespace gonio::proc {
namespace {

constexpr std::size_t kBlock = 256;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A node's numbers are worked on together, in one vector register of the processor.
using Four [[gnu::vector_size(16)]] = float;
using FourBits [[gnu::vector_size(16)]] = std::int32_t;
using EightHalves [[gnu::vector_size(16)]] = std::int16_t;

/// Two nodes that follow each other.
struct FourTwice {
    Four low, high;
};

/// From halves in the upper 16 bits each, as toFloat of half_float.h does it; infinity becomes NaN,
/// which no node holds.
Four fourFrom(const FourBits& shifted) {
    constexpr std::int32_t kWithoutCopies = ~0x70000000;  // of the sign
    const FourBits bits = (shifted >> 3) & kWithoutCopies;
    const Four value = std::bit_cast<Four>(bits) * 0x1p112F;
    const auto notANumber = std::bit_cast<FourBits>(bits >= 0x0f800000);
    return std::bit_cast<Four>(std::bit_cast<FourBits>(value) | notANumber);
}

FourTwice loaded(const BakedNode<Half16>* node) {
    EightHalves all;
    std::memcpy(&all, node, sizeof all);
    const EightHalves zero{};
    const EightHalves low = __builtin_shufflevector(zero, all, 0, 8, 1, 9, 2, 10, 3, 11);
    const EightHalves high = __builtin_shufflevector(zero, all, 4, 12, 5, 13, 6, 14, 7, 15);
    return {fourFrom(std::bit_cast<FourBits>(low)), fourFrom(std::bit_cast<FourBits>(high))};
}

FourTwice loaded(const BakedNode<float>* node) {
    return {std::bit_cast<Four>(node[0]), std::bit_cast<Four>(node[1])};
}

Four between(const Four& low, const Four& high, float share) { return low + share * (high - low); }

/// How far apart in memory neighbours along T and m are; along c they follow each other.
struct Strides {
    std::size_t tanHalf, cosDiff;

    explicit Strides(const BoxResolution& of)
        : tanHalf(static_cast<std::size_t>(of.cosDiff) * static_cast<std::size_t>(of.skew)),
          cosDiff(static_cast<std::size_t>(of.skew)) {}
};

template <class Number>
Four interpolated(const BakedNode<Number>* nodes, const Strides& strides, const BoxPlace& at) {
    const auto edge = [&](const BakedNode<Number>* low) {
        const FourTwice both = loaded(low);
        return between(both.low, both.high, at.skew);
    };
    const auto face = [&](const BakedNode<Number>* low) {
        return between(edge(low), edge(low + strides.cosDiff), at.cosDiff);
    };
    const BakedNode<Number>* const corner = nodes + at.node;
    return between(face(corner), face(corner + strides.tanHalf), at.tanHalf);
}

struct PlaceArrays {
    alignas(64) std::array<std::int32_t, kBlock> node;
    alignas(64) std::array<float, kBlock> tanHalf, cosDiff, skew;
};
struct BlockOfBands {
    alignas(64) std::array<float, kBlock> r, g, b;
};

/// body(i) for all i: no iteration may read what another writes. For the richest vector units that
/// the processor has, as in kernel_model.h; the body's captures are pointers and copies, and
/// everything it calls is inlined.
template <class Body>
#ifndef __clang__
[[gnu::flatten, gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]]
#endif
void vectorLoop(std::size_t count, const Body& body) {
    const Body local = body;
#ifndef __clang__
#pragma GCC ivdep
#endif
    for (std::size_t i = 0; i < count; ++i) local(i);
}

void placeAll(const BoxAxes& axes, const PairArrays<float>& pairs, PlaceArrays& at) {
    vectorLoop(pairs.inX.size(),
               [axes,
                inX = pairs.inX.data(),
                inY = pairs.inY.data(),
                inZ = pairs.inZ.data(),
                outX = pairs.outX.data(),
                outY = pairs.outY.data(),
                outZ = pairs.outZ.data(),
                node = at.node.data(),
                tanHalf = at.tanHalf.data(),
                cosDiff = at.cosDiff.data(),
                skew = at.skew.data()](std::size_t i) {
                   constexpr auto kLeast = static_cast<float>(kGrazing);
                   const Pair<float> pair{{inX[i], inY[i], std::max(inZ[i], kLeast)},
                                          {outX[i], outY[i], std::max(outZ[i], kLeast)}};
                   const BoxPlace place = axes.placeOf(boxPoint(pair));
                   node[i] = place.node;
                   tanHalf[i] = place.tanHalf;
                   cosDiff[i] = place.cosDiff;
                   skew[i] = place.skew;
               });
}

/// Node by node: the four numbers of each fill a register.
template <class Number>
#ifndef __clang__
[[gnu::flatten, gnu::target_clones("default", "arch=x86-64-v3")]]
#endif
void gatherAll(const BakedNode<Number>* nodes,
               const Strides& strides,
               const PlaceArrays& at,
               std::size_t count,
               BlockOfBands& stored) {
    for (std::size_t i = 0; i < count; ++i) {
        const BoxPlace place{at.node[i], at.tanHalf[i], at.cosDiff[i], at.skew[i]};
        const Four value = interpolated(nodes, strides, place);
        stored.r[i] = value[0];
        stored.g[i] = value[1];
        stored.b[i] = value[2];
    }
}

/// Of one pair, all in one function: no direction is stored between its parts.
template <class Number>
#ifndef __clang__
[[gnu::flatten, gnu::target_clones("default", "arch=x86-64-v3")]]
#endif
Four storedAt(const BakedNode<Number>* nodes, const BoxAxes& axes, const LightView& pair) {
    const BoxPlace at = axes.placeOf(boxPoint(pairOf<double>(pair)));
    return interpolated(nodes, Strides(axes.resolution()), at);
}

/// f holds the carrier's values, NaN where it has none.
void multiplyAll(const BlockOfBands& stored, const BandArrays<float>& f) {
    vectorLoop(f.r.size(),
               [fromR = stored.r.data(),
                fromG = stored.g.data(),
                fromB = stored.b.data(),
                r = f.r.data(),
                g = f.g.data(),
                b = f.b.data()](std::size_t i) {
                   r[i] *= fromR[i];
                   g[i] *= fromG[i];
                   b[i] *= fromB[i];
               });
}

/// 2 to the power; NaN stays NaN.
template <class T>
T powerOf2(T x) {
    return x == x ? fastExp2<5>(x) : x;
}

void raiseAll(const BlockOfBands& stored,
              const PairArrays<float>& pairs,
              const BandArrays<float>& f) {
    vectorLoop(f.r.size(),
               [fromR = stored.r.data(),
                fromG = stored.g.data(),
                fromB = stored.b.data(),
                inZ = pairs.inZ.data(),
                outZ = pairs.outZ.data(),
                r = f.r.data(),
                g = f.g.data(),
                b = f.b.data()](std::size_t i) {
                   constexpr float kBelow = std::numeric_limits<float>::quiet_NaN();
                   const bool above = inZ[i] > 0 && outZ[i] > 0;
                   r[i] = above ? powerOf2(fromR[i]) : kBelow;
                   g[i] = above ? powerOf2(fromG[i]) : kBelow;
                   b[i] = above ? powerOf2(fromB[i]) : kBelow;
               });
}

}  // namespace

struct BakedTable::Found {
    LedBands f = LedBands::all(kNan);
    double error = 0;  ///< relative
};

BakedTable::BakedTable(const BoxAxes& axes,
                       BakedNodes nodes,
                       std::unique_ptr<const AnalyticModel> carrier,
                       const BakeReport& report)
    : axes_(axes), nodes_(std::move(nodes)), carrier_(std::move(carrier)), report_(report) {}

BakedTable::Found BakedTable::find(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) return {};
    const Four stored =
        std::visit([&](const auto& nodes) { return storedAt(nodes.data(), axes_, pair); }, nodes_);
    Found found{.f = {{stored[0], stored[1], stored[2]}}, .error = stored[3] * kErrorUnit};
    if (carrier_) {
        found.f = found.f * carrier_->answer(pair).f;
    } else {
        for (double& value : found.f.value) value = powerOf2(value);
    }
    return found;
}

LedBands BakedTable::evaluate(const LightView& pair) const { return find(pair).f; }

Answer BakedTable::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const Found found = find(pair);
    Answer answer;
    answer.f = found.f;
    answer.source = Source::Interpolated;
    if (!answer.present()) return Answer::none({}, Source::Interpolated);
    answer.flags = {Flag::Interpolated};
    answer.uSystematic = LedBands{};
    for (const Band band : kBands) {
        (*answer.uSystematic)[band] = found.error * std::abs(found.f[band]);
    }
    return answer;
}

void BakedTable::evaluate(const PairArrays<float>& pairs, const BandArrays<float>& f) const {
    const Strides strides(axes_.resolution());
    PlaceArrays at;
    BlockOfBands stored;
    for (std::size_t from = 0; from < pairs.inX.size(); from += kBlock) {
        const std::size_t count = std::min(kBlock, pairs.inX.size() - from);
        const PairArrays<float> some = pairs.part(from, count);
        const BandArrays<float> out = f.part(from, count);
        placeAll(axes_, some, at);
        std::visit([&](const auto& nodes) { gatherAll(nodes.data(), strides, at, count, stored); },
                   nodes_);
        if (carrier_) {
            carrier_->evaluate(some, out);
            multiplyAll(stored, out);
        } else {
            raiseAll(stored, some, out);
        }
    }
}

TableStorage BakedTable::storage() const {
    return std::holds_alternative<std::vector<BakedNode<float>>>(nodes_) ? TableStorage::Float
                                                                         : TableStorage::Half;
}

std::size_t BakedTable::bytes() const {
    return std::visit([](const auto& nodes) { return nodes.size() * sizeof(nodes.front()); },
                      nodes_);
}

}  // namespace gonio::proc
