#pragma once
// The relative uncertainty of a surface as a surface, for a map of it: f stands for u / f
// (combined, k = 1); no answer where f is not above 0 or its u is not known.

#include <cmath>
#include <limits>

#include "proc/core/scatterer.h"

namespace gonio::proc {

/// Borrows the surface.
class RelativeUncertainty : public Scatterer {
public:
    explicit RelativeUncertainty(const Scatterer& surface) : surface_(surface) {}

    [[nodiscard]] Answer answer(const LightView& pair) const override {
        Answer answer = surface_.answer(pair);
        const Answer whole = answer;
        for (const Band band : kBands) {
            const auto u = whole.u(band);
            answer.f[band] = u && whole.f[band] > 0 ? *u / whole.f[band]
                                                    : std::numeric_limits<double>::quiet_NaN();
        }
        return answer;
    }
    [[nodiscard]] BandCount bandCount() const override { return surface_.bandCount(); }

private:
    const Scatterer& surface_;
};

}  // namespace gonio::proc
