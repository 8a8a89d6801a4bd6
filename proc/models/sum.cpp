#include "proc/models/sum.h"

namespace gonio::proc {
namespace {

template <class T>
void addTo(std::span<T> total, const std::vector<T>& one) {
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += one[i];
}

template <class T>
void evaluateSum(const std::vector<std::unique_ptr<const AnalyticModel>>& parts,
                 const PairArrays<T>& pairs,
                 const BandArrays<T>& f) {
    const std::size_t count = pairs.inX.size();
    std::vector<T> r(count);
    std::vector<T> g(count);
    std::vector<T> b(count);
    parts.front()->evaluate(pairs, f);
    for (std::size_t part = 1; part < parts.size(); ++part) {
        parts[part]->evaluate(pairs, BandArrays<T>{r, g, b});
        addTo(f.r, r);
        addTo(f.g, g);
        addTo(f.b, b);
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
