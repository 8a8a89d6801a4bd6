#include "proc/estimate/clamp_extrapolator.h"

namespace gonio::proc {
namespace {

class ClampExtrapolator : public Extrapolator {
public:
    using Extrapolator::Extrapolator;

protected:
    [[nodiscard]] Answer outside(const LightView& pair) const override {
        return extrapolated(atEdge(pair), 1);
    }
};

}  // namespace

Result<std::unique_ptr<Scatterer>> makeClampExtrapolator(std::unique_ptr<Scatterer> inner,
                                                         const Beyond& beyond) {
    return makeExtrapolator<ClampExtrapolator>(std::move(inner), beyond);
}

}  // namespace gonio::proc
