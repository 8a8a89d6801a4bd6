#include "proc/estimate/no_extrapolation.h"

namespace gonio::proc {
namespace {

class NoExtrapolation : public Extrapolator {
public:
    using Extrapolator::Extrapolator;

protected:
    [[nodiscard]] Answer outside(const LightView& /*pair*/) const override {
        return Answer::none({}, Source::Extrapolated);
    }
};

}  // namespace

Result<std::unique_ptr<Scatterer>> makeNoExtrapolation(std::unique_ptr<Scatterer> inner,
                                                       const Beyond& beyond) {
    return makeExtrapolator<NoExtrapolation>(std::move(inner), beyond);
}

}  // namespace gonio::proc
