#pragma once
// A kernel made a model. Include it in the .cpp that makes the model only: each kernel is
// instantiated for two number types, three instruction sets and, where it says that its formula
// depends on the effort, three efforts. A kernel that is not diffuse has `LobeMixture lobes()
// const`.

#include <memory>
#include <utility>

#include "proc/models/analytic.h"

namespace gonio::proc {

// One loop for the baseline, one for AVX2, one for AVX-512: the loader picks. The attribute works
// on instantiations of templates; what is inlined into them is compiled for each as well.
template <Effort E, class Kernel, class T>
[[gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]] void evaluateAll(
    const Kernel& kernel, const PairArrays<T>& pairs, const BandArrays<T>& f) {
    const T below = std::numeric_limits<T>::quiet_NaN();
    const std::size_t count = pairs.inX.size();
    for (std::size_t i = 0; i < count; ++i) {
        const T least = static_cast<T>(kGrazing);
        const Pair<T> pair{{pairs.inX[i], pairs.inY[i], std::max(pairs.inZ[i], least)},
                           {pairs.outX[i], pairs.outY[i], std::max(pairs.outZ[i], least)}};
        const Bands<T> value = kernel.template f<E>(pair);
        const bool above = pairs.inZ[i] > T(0) && pairs.outZ[i] > T(0);
        f.r[i] = above ? value.r : below;
        f.g[i] = above ? value.g : below;
        f.b[i] = above ? value.b : below;
    }
}

template <class Kernel>
concept ByEffort = requires { requires Kernel::kByEffort; };

template <template <class> class Kernel>
class KernelModel final : public AnalyticModel {
public:
    KernelModel(EvalPath path, Kernel<double> exact, Kernel<float> narrow)
        : path_(path), exact_(std::move(exact)), narrow_(std::move(narrow)) {}

    void evaluate(const PairArrays<float>& pairs, const BandArrays<float>& f) const override {
        atEffort([&]<Effort E>() { evaluateAll<E>(narrow_, pairs, f); });
    }
    void evaluate(const PairArrays<double>& pairs, const BandArrays<double>& f) const override {
        atEffort([&]<Effort E>() { evaluateAll<E>(exact_, pairs, f); });
    }

    [[nodiscard]] LobeMixture lobes() const override {
        if constexpr (requires { exact_.lobes(); }) {
            return exact_.lobes();
        } else {
            return {{}};  // diffuse
        }
    }

protected:
    [[nodiscard]] LedBands evaluate(const LightView& pair) const override {
        LedBands f;
        atEffort([&]<Effort E>() {
            if (path_.precision == Precision::Float) {
                f = ledBands(narrow_.template f<E>(pairOf<float>(pair)));
            } else {
                f = ledBands(exact_.template f<E>(pairOf<double>(pair)));
            }
        });
        return f;
    }

private:
    template <class Call>
    void atEffort(Call&& call) const {
        if constexpr (!ByEffort<Kernel<double>>) {
            return call.template operator()<Effort::Reference>();
        }
        switch (path_.effort) {
            case Effort::Draft: return call.template operator()<Effort::Draft>();
            case Effort::Standard: return call.template operator()<Effort::Standard>();
            case Effort::Reference: return call.template operator()<Effort::Reference>();
        }
    }

    EvalPath path_;
    Kernel<double> exact_;
    Kernel<float> narrow_;
};

/// The model of a kernel; `make.operator()<P>()` gives the kernel with its parameters in P.
template <template <class> class Kernel, class Make>
[[nodiscard]] std::unique_ptr<const AnalyticModel> kernelModel(EvalPath path, Make&& make) {
    return std::make_unique<KernelModel<Kernel>>(
        path, make.template operator()<double>(), make.template operator()<float>());
}

}  // namespace gonio::proc
