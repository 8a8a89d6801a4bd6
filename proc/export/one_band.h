#pragma once
// One band of a surface, as a monochrome one.

#include <memory>

#include "proc/core/scatterer.h"

namespace gonio::proc {

/// f, uncertainties and presence are those of `band` alone, in all three bands.
class OneBand final : public Scatterer {
public:
    OneBand(std::shared_ptr<const Scatterer> all, Band band) : all_(std::move(all)), band_(band) {}

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return BandCount::One; }

private:
    std::shared_ptr<const Scatterer> all_;
    Band band_;
};

}  // namespace gonio::proc
