#include "proc/estimate/linear_extrapolator.h"

namespace gonio::proc {
namespace {

class LinearExtrapolator : public Extrapolator {
public:
    using Extrapolator::Extrapolator;

protected:
    [[nodiscard]] Answer outside(const LightView& pair) const override {
        return extrapolated(atEdge(pair), 1 - partTo90(pair));
    }
};

}  // namespace

Result<std::unique_ptr<Scatterer>> makeLinearExtrapolator(std::unique_ptr<Scatterer> inner,
                                                          const Beyond& beyond) {
    return makeExtrapolator<LinearExtrapolator>(std::move(inner), beyond);
}

}  // namespace gonio::proc
