#pragma once
// What all analytic models share: an answer with source `analytic`, no uncertainty, a defined none
// below the horizon, and evaluation of one pair or of arrays of them, in double or float, at an
// effort. A model is a kernel (kernel.h) with its parameters in both number types; the effort picks
// the instantiation of the same formula, so what differs between paths is rounding and the
// polynomials of fast_exp.h.

#include <span>

#include "proc/core/effort.h"
#include "proc/core/scatterer.h"
#include "proc/models/kernel.h"
#include "proc/models/sampling.h"

namespace gonio::proc {

enum class Precision {
    Float,
    Double
};
[[nodiscard]] Result<Precision> parsePrecision(std::string_view text);

/// Which instantiation answers. Directions are normalised in double before they are narrowed.
struct EvalPath {
    Effort effort = Effort::Reference;
    Precision precision = Precision::Double;
};

/// Directions as arrays of components; all of one length.
template <class T>
struct PairArrays {
    std::span<const T> inX, inY, inZ;
    std::span<const T> outX, outY, outZ;

    [[nodiscard]] PairArrays part(std::size_t from, std::size_t count) const {
        return {inX.subspan(from, count),
                inY.subspan(from, count),
                inZ.subspan(from, count),
                outX.subspan(from, count),
                outY.subspan(from, count),
                outZ.subspan(from, count)};
    }
};
template <class T>
struct BandArrays {
    std::span<T> r, g, b;

    [[nodiscard]] BandArrays part(std::size_t from, std::size_t count) const {
        return {r.subspan(from, count), g.subspan(from, count), b.subspan(from, count)};
    }
};

class AnalyticModel : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView& pair) const final {
        if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
            return Answer::none({Flag::BelowHorizon}, Source::Analytic);
        }
        Answer answer;
        answer.f = evaluate(pair);
        return answer;
    }

    /// f of every pair, on vector units where the processor has them; NaN below the horizon. The
    /// effort is the model's own, the precision the arrays'.
    virtual void evaluate(const PairArrays<float>& pairs, const BandArrays<float>& f) const = 0;
    virtual void evaluate(const PairArrays<double>& pairs, const BandArrays<double>& f) const = 0;

    /// What to draw directions from so that f cos / pdf varies little.
    [[nodiscard]] virtual LobeMixture lobes() const = 0;

protected:
    /// f in 1/sr; both directions above the horizon.
    [[nodiscard]] virtual LedBands evaluate(const LightView& pair) const = 0;
};

}  // namespace gonio::proc
