#include "proc/estimate/extrapolator.h"

#include "proc/core/number_text.h"
#include "proc/estimate/answer_blend.h"

namespace gonio::proc {

Result<void> checkBeyond(const Beyond& beyond) {
    if (beyond.edge >= Radians(0) && beyond.edge < 90_deg) return {};
    return Error{ErrorKind::Usage,
                 "extrapolation: an edge of " + shortest(beyond.edge.degrees()) +
                     " degrees, wanted one in [0, 90)"};
}

Answer Extrapolator::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Extrapolated);
    }
    return thetaOf(pair) > edge() ? outside(pair) : inner_->answer(pair);
}

const Direction& Extrapolator::sideOf(const LightView& pair) const {
    return beyond_.side == Side::Outgoing ? pair.out : pair.in;
}

Radians Extrapolator::thetaOf(const LightView& pair) const { return sideOf(pair).theta(); }

double Extrapolator::partTo90(const LightView& pair) const {
    return (thetaOf(pair) - edge()).value() / (90_deg - edge()).value();
}

Answer Extrapolator::innerAt(const LightView& pair, Radians theta) const {
    const Direction there = Direction::fromSpherical(theta, sideOf(pair).phi());
    return beyond_.side == Side::Outgoing ? inner_->answer({.in = pair.in, .out = there})
                                          : inner_->answer({.in = there, .out = pair.out});
}

Answer extrapolated(const Answer& from, double factor) {
    AnswerBlend blend;
    blend.add(LedBands::all(factor), from);
    return blend.sum(Source::Extrapolated);
}

}  // namespace gonio::proc
