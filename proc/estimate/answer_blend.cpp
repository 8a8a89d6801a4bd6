#include "proc/estimate/answer_blend.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

Flags withOrigin(Flags flags, Source source) {
    flags.clear(Flag::Measured).clear(Flag::Interpolated).clear(Flag::Extrapolated);
    if (source == Source::Measured) flags.set(Flag::Measured);
    if (source == Source::Interpolated) flags.set(Flag::Interpolated);
    if (source == Source::Extrapolated) flags.set(Flag::Extrapolated);
    return flags;
}

}  // namespace

Answer answerOf(const ScatteredSample& sample) {
    return {.f = sample.f,
            .uRandom = sample.uRandom,
            .uSystematic = sample.uSystematic,
            .flags = withOrigin(sample.flags, Source::Measured),
            .source = Source::Measured};
}

void AnswerBlend::add(double weight, const Answer& part) {
    if (weight != 0) add(LedBands::all(weight), part);
}

void AnswerBlend::add(const LedBands& weight, const Answer& part) {
    weight_ = weight_ + weight;
    f_ = f_ + part.f * weight;
    knowsRandom_ = knowsRandom_ && part.uRandom;
    knowsSystematic_ = knowsSystematic_ && part.uSystematic;
    if (part.uRandom) {
        const LedBands random = *part.uRandom * weight;
        randomSquared_ = randomSquared_ + random * random;
    }
    if (part.uSystematic) systematic_ = systematic_ + *part.uSystematic * weight;
    flags_ = flags_ | part.flags;
    ++parts_;
    allMeasured_ = allMeasured_ && part.source == Source::Measured;
}

Answer AnswerBlend::sum(Source source) const {
    return parts_ == 0 ? Answer::none({}, source) : scaled(LedBands::all(1), source);
}

Answer AnswerBlend::mean(Source source) const {
    if (parts_ == 0) return Answer::none({}, source);
    return scaled({{1 / weight_.value[0], 1 / weight_.value[1], 1 / weight_.value[2]}}, source);
}

Answer AnswerBlend::scaled(const LedBands& by, Source source) const {
    Answer answer;
    answer.f = f_ * by;
    answer.source = source;
    answer.flags = withOrigin(flags_, source);
    if (std::all_of(
            answer.f.value.begin(), answer.f.value.end(), [](double f) { return std::isnan(f); })) {
        return Answer::none(Flags(flags_).clear(Flag::Measured), source);
    }
    if (knowsRandom_) answer.uRandom = LedBands{};
    if (knowsSystematic_) answer.uSystematic = LedBands{};
    for (const Band band : kBands) {
        const double size = std::abs(by[band]);
        if (knowsRandom_) (*answer.uRandom)[band] = size * std::sqrt(randomSquared_[band]);
        if (knowsSystematic_) (*answer.uSystematic)[band] = size * std::abs(systematic_[band]);
    }
    return answer;
}

}  // namespace gonio::proc
