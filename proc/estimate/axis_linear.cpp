#include "proc/estimate/axis_linear.h"

#include <cmath>

#include "proc/estimate/answer_blend.h"

namespace gonio::proc {
namespace {

class AxisLinear : public Scatterer {
public:
    AxisLinear(const ScatteredSet& data, const AxisReach& reach)
        : lines_(data), reach_(reach), bands_(data.bandCount()) {
        for (const SampleId id : data.ids()) samples_.push_back(*data.find(id));
    }

    [[nodiscard]] Answer answer(const LightView& pair) const override {
        if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
            return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
        }
        const std::vector<LineShare> shares = lines_.sharesAt(pair, reach_);
        AnswerBlend blend;
        for (const LineShare& share : shares) {
            blend.add(share.weight, answerOf(samples_[share.sample]));
        }
        const bool hit = shares.size() == 1 && isAt(samples_[shares.front().sample], pair);
        return blend.mean(hit ? Source::Measured : Source::Interpolated);
    }
    [[nodiscard]] BandCount bandCount() const override { return bands_; }

private:
    /// A lone sample may also be the last one of an axis, away from the pair.
    [[nodiscard]] bool isAt(const ScatteredSample& sample, const LightView& pair) const {
        constexpr double kSamePair = 1e-9;
        return squaredDistance(pair, sample.pair, lines_.symmetry()) < kSamePair * kSamePair;
    }

    SphericalLines lines_;
    AxisReach reach_;
    BandCount bands_;
    std::vector<ScatteredSample> samples_;  ///< in the order of their ids
};

bool isReach(Radians reach) { return std::isfinite(reach.value()) && reach >= Radians(0); }

}  // namespace

Result<std::unique_ptr<Scatterer>> makeAxisLinear(const ScatteredSet& data,
                                                  const AxisReach& reach) {
    if (!isReach(reach.incoming) || !isReach(reach.outgoing) || reach.maxPoints == 0) {
        return Error{ErrorKind::Usage,
                     "axis-linear: distances along the axes must be finite and at least 0, the "
                     "points looked at more than 0"};
    }
    return std::unique_ptr<Scatterer>(std::make_unique<AxisLinear>(data, reach));
}

}  // namespace gonio::proc
