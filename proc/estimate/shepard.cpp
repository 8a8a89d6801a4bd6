#include "proc/estimate/shepard.h"

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "proc/estimate/answer_blend.h"

namespace gonio::proc {
namespace {

constexpr double kSamePair = 1e-9;

class Shepard : public Scatterer {
public:
    Shepard(ScatteredSet data, const ShepardOptions& options)
        : data_(std::move(data)), options_(options) {}

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return data_.bandCount(); }

private:
    [[nodiscard]] Answer hits(std::span<const Neighbour> near) const;
    [[nodiscard]] Answer weighted(std::span<const Neighbour> near) const;

    ScatteredSet data_;
    ShepardOptions options_;
};

Answer Shepard::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const auto near =
        data_.nearest(pair, {.count = options_.most, .maxDistance = options_.maxDistance});
    if (near.size() < options_.fewest) return Answer::none({}, Source::Interpolated);
    const bool hit = options_.epsilon == 0 && near.front().distance < kSamePair;
    return hit ? hits(near) : weighted(near);
}

Answer Shepard::hits(std::span<const Neighbour> near) const {
    AnswerBlend blend;
    for (const Neighbour& one : near) {
        if (one.distance < kSamePair) blend.add(1, answerOf(*data_.find(one.id)));
    }
    return blend.mean(Source::Measured);
}

Answer Shepard::weighted(std::span<const Neighbour> near) const {
    AnswerBlend blend;
    for (const Neighbour& one : near) {
        const double d = one.distance + options_.epsilon;
        blend.add(1 / (d * d), answerOf(*data_.find(one.id)));
    }
    return blend.mean(Source::Interpolated);
}

}  // namespace

Result<std::unique_ptr<Scatterer>> makeShepard(ScatteredSet data, const ShepardOptions& options) {
    const auto refuse = [](const char* wanted) {
        return Error{ErrorKind::Usage, std::string("shepard: ") + wanted};
    };
    if (options.fewest < 1 || options.most < options.fewest) {
        return refuse("the neighbours want a range of at least 1, the fewest before the most");
    }
    if (!(options.maxDistance > 0)) return refuse("the maximum distance must be above 0");
    if (!(options.epsilon >= 0) || std::isinf(options.epsilon)) {
        return refuse("epsilon must be finite and at least 0");
    }
    return std::unique_ptr<Scatterer>(std::make_unique<Shepard>(std::move(data), options));
}

}  // namespace gonio::proc
