#pragma once
// Scatterers made up for the tests of estimators.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "proc/models/spec.h"

namespace gonio::test {

/// Answers what a function says.
class Made : public Scatterer {
public:
    explicit Made(std::function<Answer(const LightView&)> answer) : answer_(std::move(answer)) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
            return Answer::none({Flag::BelowHorizon}, Source::Analytic);
        }
        return answer_(pair);
    }

private:
    std::function<Answer(const LightView&)> answer_;
};

inline Answer answerOf(double f) {
    Answer answer;
    answer.f = LedBands::all(f);
    return answer;
}

inline std::unique_ptr<const proc::AnalyticModel> model(const std::string& spec,
                                                        proc::EvalPath path = {}) {
    auto made = proc::makeModel(spec, path);
    if (!made) throw std::runtime_error(made.error().message);
    return std::move(*made);
}

inline Direction tilted(double degrees, double azimuth = 0.4) {
    return Direction::fromSpherical(Radians::fromDegrees(degrees), Radians(azimuth));
}

}  // namespace gonio::test
