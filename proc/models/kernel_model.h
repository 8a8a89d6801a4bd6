#pragma once
// A kernel made a model. Include it in the .cpp that makes the model only: each kernel is
// instantiated for two number types, three instruction sets and, where it says that its formula
// depends on the effort, three efforts. A kernel that is not diffuse has `LobeMixture lobes()
// const`.

#include <memory>
#include <utility>

#include "proc/models/analytic.h"

namespace gonio::proc {

// One loop for the baseline, one for AVX2, one for AVX-512: the loader picks. All that a kernel
// calls is inlined into each: one call left over would keep the loop scalar.
template <Effort E, class Kernel, class T>
#ifndef __clang__  // clang-tidy reads this too, and Clang takes one of the two at a time
[[gnu::flatten, gnu::target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")]]
#endif
void evaluateAll(const Kernel& kernel, const PairArrays<T>& pairs, const BandArrays<T>& f) {
    // A copy, and no dependence between iterations: what is written could else be taken for the
    // kernel's parameters or for a later direction.
    const Kernel local = kernel;
    const T below = std::numeric_limits<T>::quiet_NaN();
    const T least = static_cast<T>(kGrazing);
    const T* const inX = pairs.inX.data();
    const T* const inY = pairs.inY.data();
    const T* const inZ = pairs.inZ.data();
    const T* const outX = pairs.outX.data();
    const T* const outY = pairs.outY.data();
    const T* const outZ = pairs.outZ.data();
    T* const r = f.r.data();
    T* const g = f.g.data();
    T* const b = f.b.data();
    const std::size_t count = pairs.inX.size();
#ifndef __clang__
#pragma GCC ivdep
#endif
    for (std::size_t i = 0; i < count; ++i) {
        const Pair<T> pair{{inX[i], inY[i], std::max(inZ[i], least)},
                           {outX[i], outY[i], std::max(outZ[i], least)}};
        const Bands<T> value = local.template f<E>(pair);
        const bool above = inZ[i] > T(0) && outZ[i] > T(0);
        r[i] = above ? value.r : below;
        g[i] = above ? value.g : below;
        b[i] = above ? value.b : below;
    }
}

/// With the kernel's choices taken before the loop, where it has any.
template <Effort E, class Kernel, class T>
void evaluateForms(const Kernel& kernel, const PairArrays<T>& pairs, const BandArrays<T>& f) {
    const auto all = [&](const auto& fixed) { evaluateAll<E>(fixed, pairs, f); };
    if constexpr (requires { kernel.withForms(all); }) {
        kernel.withForms(all);
    } else {
        all(kernel);
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
        atEffort([&]<Effort E>() { evaluateForms<E>(narrow_, pairs, f); });
    }
    void evaluate(const PairArrays<double>& pairs, const BandArrays<double>& f) const override {
        atEffort([&]<Effort E>() { evaluateForms<E>(exact_, pairs, f); });
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
