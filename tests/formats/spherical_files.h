#pragma once
// What every codec of spherical tables is held to: laws that a test asks of its writer and reader.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/models/spec.h"
#include "proc/table/spherical_lookup.h"
#include "tests/support/spherical_tables.h"

namespace gonio::test {

/// f of a model at a pair; NaN where it has no answer.
class ModelValue {
public:
    explicit ModelValue(std::string_view spec) {
        auto made = proc::makeModel(spec);
        EXPECT_TRUE(made);
        if (made) model_ = std::shared_ptr(std::move(*made));
    }
    double operator()(const LightView& pair, std::size_t channel) const {
        return model_->answer(pair).f.value[channel % 3];
    }

private:
    std::shared_ptr<const Scatterer> model_;
};

/// Every node of `source` that has data is answered alike by `back`, to `relative`.
inline void expectSameAtNodes(const proc::SphericalTable& source,
                              const proc::SphericalTable& back,
                              double relative) {
    auto channels = proc::bandChannels(back.channels);
    ASSERT_TRUE(channels) << (channels ? "" : channels.error().message);
    const auto lookup = proc::SphericalLookup::over(back, *channels);
    ASSERT_TRUE(lookup) << (lookup ? "" : lookup.error().message);
    std::size_t compared = 0;
    for (const proc::SphericalBlock& block : source.blocks) {
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                const double f = block.f[block.index(a, t)];
                if (std::isnan(f)) continue;
                const Answer answer = lookup->answer(source.pairAt(block, a, t));
                ASSERT_TRUE(answer.present())
                    << block.incidenceDeg << ' ' << block.azimuthDeg[a] << ' ' << block.thetaDeg[t];
                ASSERT_NEAR(answer.f.value[block.channel % 3], f, relative * std::abs(f))
                    << block.incidenceDeg << ' ' << block.azimuthDeg[a] << ' ' << block.thetaDeg[t];
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 0U);
}

/// The largest f of each reflection block lies at the mirror direction of its light.
inline void expectPeaksAtMirror(const proc::SphericalTable& table) {
    for (const proc::SphericalBlock& block : table.blocks) {
        double largest = 0;
        LightView at;
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                if (block.f[block.index(a, t)] <= largest) continue;
                largest = block.f[block.index(a, t)];
                at = table.pairAt(block, a, t);
            }
        }
        EXPECT_NEAR(angleBetween({.in = mirrorOf(at.in), .out = at.out}).degrees(), 0, 1e-5)
            << "incidence " << block.incidenceDeg;
    }
}

}  // namespace gonio::test
