#pragma once
// A sum of lobes: f is the sum of the parts' f.

#include <memory>
#include <vector>

#include "proc/models/analytic.h"

namespace gonio::proc {

class Sum : public AnalyticModel {
public:
    /// At least one part.
    explicit Sum(std::vector<std::unique_ptr<const AnalyticModel>> parts)
        : parts_(std::move(parts)) {}

    void evaluate(const PairArrays<float>& pairs, const BandArrays<float>& f) const override;
    void evaluate(const PairArrays<double>& pairs, const BandArrays<double>& f) const override;

    [[nodiscard]] LobeMixture lobes() const override;

protected:
    [[nodiscard]] LedBands evaluate(const LightView& pair) const override;

private:
    std::vector<std::unique_ptr<const AnalyticModel>> parts_;
};

}  // namespace gonio::proc
