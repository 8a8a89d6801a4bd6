#pragma once
// One scatterer for each band, as one: of bands that were measured in different cells, or not all
// of them.
//
// f and u of a band are those of its own scatterer, NaN where it has none; the source is the least
// trusted one of the bands that answer, the flags are those of them all. No answer where no band
// has one.

#include <array>
#include <memory>

#include "proc/core/scatterer.h"

namespace gonio::proc {

class BandWise final : public Scatterer {
public:
    /// By band; null where it was not measured.
    explicit BandWise(std::array<std::unique_ptr<const Scatterer>, 3> bands)
        : bands_(std::move(bands)) {}

    [[nodiscard]] Answer answer(const LightView& pair) const override;

private:
    std::array<std::unique_ptr<const Scatterer>, 3> bands_;
};

}  // namespace gonio::proc
