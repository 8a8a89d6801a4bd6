#include "proc/estimate/bezier_extrapolator.h"

#include <cmath>

#include "proc/estimate/answer_blend.h"

namespace gonio::proc {
namespace {

/// What the two values before the edge weigh in the curve.
struct Weights {
    double last = 0, before = 0;
};

class BezierExtrapolator : public Extrapolator {
public:
    BezierExtrapolator(std::unique_ptr<Scatterer> inner,
                       const Beyond& beyond,
                       const BezierOptions& options)
        : Extrapolator(std::move(inner), beyond), step_(options.step) {}

protected:
    [[nodiscard]] Answer outside(const LightView& pair) const override {
        const Answer last = atEdge(pair);
        const Answer before = innerAt(pair, edge() - step_);
        const double t = partTo90(pair);
        LedBands ofLast, ofBefore;
        for (const Band band : kBands) {
            const Weights w = weights({.last = last.f[band], .before = before.f[band]}, t);
            ofLast[band] = w.last;
            ofBefore[band] = w.before;
        }
        AnswerBlend blend;
        blend.add(ofLast, last);
        blend.add(ofBefore, before);
        return blend.sum(Source::Extrapolated);
    }

private:
    struct Values {
        double last = 0, before = 0;
    };

    /// At parameter t the curve is (1 - t)^2 P0 + 2 t (1 - t) P1.
    [[nodiscard]] Weights weights(const Values& f, double t) const {
        const double atP0 = (1 - t) * (1 - t);
        const double atP1 = 2 * t * (1 - t);
        const double reach = (90_deg - edge()).value() / (2 * step_.value());
        const double control = f.last + (f.last - f.before) * reach;
        // Quiet of NaN: without a value there are no weights to choose.
        if (std::isless(control, std::fmin(f.last, 0.0))) {
            return {.last = atP0 + (f.last < 0 ? atP1 : 0), .before = 0};
        }
        return {.last = atP0 + atP1 * (1 + reach), .before = -atP1 * reach};
    }

    Radians step_;
};

}  // namespace

Result<std::unique_ptr<Scatterer>> makeBezierExtrapolator(std::unique_ptr<Scatterer> inner,
                                                          const Beyond& beyond,
                                                          const BezierOptions& options) {
    if (!(options.step > Radians(0) && options.step <= beyond.edge)) {
        return Error{ErrorKind::Usage,
                     "bezier extrapolation: the step of the tangent must be above 0 and not "
                     "larger than the edge's angle"};
    }
    return makeExtrapolator<BezierExtrapolator>(std::move(inner), beyond, options);
}

}  // namespace gonio::proc
