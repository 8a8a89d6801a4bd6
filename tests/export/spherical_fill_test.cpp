#include "proc/export/spherical_fill.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/formats/mbsdf.h"
#include "proc/formats/utia.h"
#include "proc/models/spec.h"
#include "tests/support/asymmetric_lobe.h"

namespace gonio::proc {
namespace {

SphericalTable mbsdfBack(const SphericalTable& table) {
    const auto written = writeMbsdf(table);
    EXPECT_TRUE(written) << (written ? "" : written.error().message);
    auto read = parseMbsdf(written->bytes, "t.mbsdf");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(read->content) : SphericalTable{};
}

SphericalTable utiaBack(const SphericalTable& table) {
    const auto written = writeUtia(table);
    EXPECT_TRUE(written) << (written ? "" : written.error().message);
    auto read = parseUtia(written->bytes, "t.bin");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(read->content) : SphericalTable{};
}

/// Every node that is above the horizon, against the scatterer itself.
void expectSame(const SphericalTable& back, const Scatterer& from, double relative) {
    ASSERT_FALSE(back.blocks.empty());
    for (const SphericalBlock& block : back.blocks) {
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                const double f = from.answer(back.pairAt(block, a, t)).f.value[block.channel];
                ASSERT_NEAR(block.f[block.index(a, t)], f, relative * f)
                    << block.incidenceDeg << " " << block.azimuthDeg[a] << " " << block.thetaDeg[t];
            }
        }
    }
}

/// Direction of a block's largest value.
Direction peakOf(const SphericalTable& table, const SphericalBlock& block) {
    const auto at = static_cast<std::size_t>(std::max_element(block.f.begin(), block.f.end()) -
                                             block.f.begin());
    return table.pairAt(block, at / block.thetaDeg.size(), at % block.thetaDeg.size()).out;
}

TEST(SphericalFill, GivesModelsBackAtNodesThroughAnMbsdf) {
    const auto model = makeModel("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.2,f0=0.5");
    ASSERT_TRUE(model);
    const auto filled =
        fillSpherical(**model, mbsdfGrid({{"R", {}}, {"G", {}}, {"B", {}}}, {18, 36}));
    EXPECT_EQ(filled.unanswered, 0U);
    EXPECT_EQ(filled.nodes, 3U * 18 * 18 * 36);
    expectSame(mbsdfBack(filled.table), **model, 1e-7);  // 2^-24 of a float
}

TEST(SphericalFill, GivesModelsBackAtNodesThroughUtia) {
    const auto model = makeModel("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.2,f0=0.5");
    ASSERT_TRUE(model);
    expectSame(utiaBack(fillSpherical(**model, utiaGrid()).table), **model, 1e-9);
}

TEST(SphericalFill, KeepsTheSideOfALobeThroughUtia) {
    const test::AsymmetricLobe lobe;
    const SphericalTable back = utiaBack(fillSpherical(lobe, utiaGrid()).table);
    expectSame(back, lobe, 1e-9);
    for (const SphericalBlock& block : back.blocks) {
        const Direction wi = back.pairAt(block, 0, 0).in;
        const Direction peak = peakOf(back, block);
        // Nodes every 7.5 degrees: the lobe's azimuth, 40 from the mirror's, is at most half a step
        // away.
        EXPECT_LT(angleBetween({peak, test::AsymmetricLobe::lobeOf(wi)}).degrees(), 3.75);
    }
}

TEST(SphericalFill, KeepsTheMirrorDirectionOfANarrowLobe) {
    const auto model = makeModel("ggx,alpha=0.05,f0=0.9");
    ASSERT_TRUE(model);
    const SphericalTable back = mbsdfBack(fillSpherical(**model, mbsdfGrid({{}}, {90, 90})).table);
    for (const SphericalBlock& block : back.blocks) {
        if (block.incidenceDeg > 60) continue;
        const Direction wi = back.pairAt(block, 0, 0).in;
        EXPECT_LT(angleBetween({peakOf(back, block), mirrorOf(wi)}).degrees(), 1.2);
    }
}

TEST(SphericalFill, FillsTransmissionBelowTheSurface) {
    struct Through : Scatterer {
        [[nodiscard]] Answer answer(const LightView& pair) const override {
            if (pair.out.z() > 0) return Answer::none({}, Source::Analytic);
            Answer answer;
            answer.f = LedBands::all(-pair.out.z() * (2 + pair.in.x() * pair.out.x()));
            return answer;
        }
    };
    const auto filled = fillSpherical(Through{}, mbsdfGrid({{}}, {6, 8}, MbsdfShape{10, 12}));
    EXPECT_EQ(filled.nodes, 6U * 6 * 8 + 10 * 10 * 12);
    EXPECT_EQ(filled.unanswered, 6U * 6 * 8);
    const SphericalTable back = mbsdfBack(filled.table);
    std::size_t seen = 0;
    for (const SphericalBlock& block : back.blocks) {
        if (!block.transmission) continue;
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                const LightView pair = back.pairAt(block, a, t);
                ASSERT_LT(pair.out.z(), 0);
                ASSERT_NEAR(block.f[block.index(a, t)], Through{}.answer(pair).f[Band::R], 1e-6);
                ++seen;
            }
        }
    }
    EXPECT_EQ(seen, 10U * 10 * 12);
}

}  // namespace
}  // namespace gonio::proc
