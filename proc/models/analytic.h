#pragma once
// What all analytic models share: an answer with source `analytic`, no uncertainty, and a defined
// none below the horizon.

#include "proc/core/scatterer.h"

namespace gonio::proc {

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

protected:
    /// f in 1/sr; both directions above the horizon.
    [[nodiscard]] virtual LedBands evaluate(const LightView& pair) const = 0;
};

}  // namespace gonio::proc
