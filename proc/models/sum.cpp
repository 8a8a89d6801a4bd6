#include "proc/models/sum.h"

#include <algorithm>
#include <array>
#include <span>

namespace gonio::proc {
namespace {

/// As many as stay in the first cache, on the stack: an evaluation of arrays allocates nothing.
constexpr std::size_t kBlock = 512;

template <class T>
void addTo(std::span<T> total, std::span<const T> one) {
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += one[i];
}

template <class T>
void evaluateBlock(const std::vector<std::unique_ptr<const AnalyticModel>>& parts,
                   const PairArrays<T>& pairs,
                   const BandArrays<T>& f) {
    std::array<T, kBlock> r, g, b;
    const std::size_t count = pairs.inX.size();
    const BandArrays<T> one{
        std::span(r).first(count), std::span(g).first(count), std::span(b).first(count)};
    parts.front()->evaluate(pairs, f);
    for (std::size_t part = 1; part < parts.size(); ++part) {
        parts[part]->evaluate(pairs, one);
        addTo<T>(f.r, one.r);
        addTo<T>(f.g, one.g);
        addTo<T>(f.b, one.b);
    }
}

template <class T>
void evaluateSum(const std::vector<std::unique_ptr<const AnalyticModel>>& parts,
                 const PairArrays<T>& pairs,
                 const BandArrays<T>& f) {
    for (std::size_t from = 0; from < pairs.inX.size(); from += kBlock) {
        const std::size_t count = std::min(kBlock, pairs.inX.size() - from);
        evaluateBlock(parts, pairs.part(from, count), f.part(from, count));
    }
}

}  // namespace

void Sum::evaluate(const PairArrays<float>& pairs, const BandArrays<float>& f) const {
    evaluateSum(parts_, pairs, f);
}

void Sum::evaluate(const PairArrays<double>& pairs, const BandArrays<double>& f) const {
    evaluateSum(parts_, pairs, f);
}

LobeMixture Sum::lobes() const {
    LobeMixture all;
    for (const auto& part : parts_) {
        const LobeMixture own = part->lobes();
        all.insert(all.end(), own.begin(), own.end());
    }
    return all;
}

LedBands Sum::evaluate(const LightView& pair) const {
    LedBands total;
    for (const auto& part : parts_) total = total + part->answer(pair).f;
    return total;
}

}  // namespace gonio::proc
