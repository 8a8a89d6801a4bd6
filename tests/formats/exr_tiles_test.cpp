#include "proc/formats/exr_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_parts.h"
#include "proc/models/spec.h"
#include "proc/table/specular_lookup.h"
#include "tests/formats/refusal.h"
#include "tests/support/asymmetric_lobe.h"

namespace gonio::proc {
namespace {

using test::refuses;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SpecularTable filled(const Scatterer& from,
                     Size tile,
                     std::vector<double> incidences = {0, 20, 40, 60}) {
    return fillBands(from, exrTileGrid(std::move(incidences), tile)).table;
}

FileRead<SpecularTable> decoded(const Result<Written>& written) {
    EXPECT_TRUE(written) << (written ? "" : written.error().message);
    auto read = decodeExrTiles(written->bytes, "t.exr");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(*read) : FileRead<SpecularTable>{.content = {}, .about = {}};
}

SpecularLookup lookup(SpecularTable table) {
    auto made = SpecularLookup::over(std::move(table));
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return std::move(*made);
}

std::unique_ptr<const AnalyticModel> model(std::string_view spec) {
    auto made = makeModel(spec);
    EXPECT_TRUE(made);
    return std::move(*made);
}

/// The picture of a file, changed and encoded again.
template <class Change>
std::string changed(const std::string& bytes, const Change& change) {
    auto parts = decodeExr(bytes, {.largest = {4096, 4096}, .parts = 1});
    EXPECT_TRUE(parts);
    change(parts->front());
    return *encodeExr(*parts);
}

std::string smallFile() {
    const auto written = encodeExrTiles(filled(*model("lambert,albedo=0.3/0.2/0.1"), {8, 4}), {});
    EXPECT_TRUE(written);
    return written->bytes;
}

TEST(ExrTiles, GiveModelsBackAtNodes) {
    const auto truth = model("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.2,f0=0.5");
    const SpecularTable table = filled(*truth, {36, 18});
    const SpecularTable back = decoded(encodeExrTiles(table, {})).content;
    EXPECT_EQ(back.colour, TableColour::LedBands);
    EXPECT_EQ(back.incidenceDeg, table.incidenceDeg);
    EXPECT_EQ(back.azimuthDeg, table.azimuthDeg);
    const SpecularLookup at = lookup(back);
    EXPECT_EQ(at.bandCount(), BandCount::Three);
    std::size_t compared = 0;
    for (TableNode n; n.incidence < 4; ++n.incidence) {
        for (n.azimuth = 0; n.azimuth < 36; ++n.azimuth) {
            for (n.radial = 0; n.radial < 18; ++n.radial) {
                if (!back.canHoldData(n)) continue;
                ++compared;
                const LightView pair = back.pairAt(n);
                const LedBands f = truth->answer(pair).f;
                const Answer answer = at.answer(pair);
                for (const Band band : kBands) {
                    ASSERT_NEAR(back.bandsAt(n)[band], f[band], 1e-7 * f[band]);
                    ASSERT_NEAR(answer.f[band], f[band], 1e-6 * f[band]);
                }
            }
        }
    }
    EXPECT_GT(compared, 4U * 36 * 18 / 3);
}

TEST(ExrTiles, WriteTheSameBytesAgain) {
    const auto truth = model("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.1,f0=0.5");
    Metadata about;
    about.set("sample", "a tile");
    about.set("method", "prior");
    about.comments = {"", "a comment"};
    const SpecularTable table = filled(*truth, {24, 12}, {0, 1.0 / 3, 20, 33.3, 89.5});
    for (const bool half : {false, true}) {
        const auto once = encodeExrTiles(table, about, {.half = half});
        const FileRead<SpecularTable> back = decoded(once);
        EXPECT_EQ(back.about, about);
        EXPECT_TRUE(back.warnings.empty());
        const auto twice = encodeExrTiles(back.content, back.about, {.half = half});
        ASSERT_TRUE(twice);
        EXPECT_EQ(twice->bytes, once->bytes);
        for (std::size_t i = 0; i < 5; ++i) {
            EXPECT_NEAR(back.content.incidenceDeg[i], table.incidenceDeg[i], 6e-6);
            EXPECT_NEAR(back.content.planes[0].tis[i], table.planes[0].tis[i], 1e-6);
        }
    }
}

TEST(ExrTiles, KeepTheSideOfALobe) {
    const test::AsymmetricLobe lobe;
    const SpecularLookup at = lookup(decoded(encodeExrTiles(filled(lobe, {72, 36}), {})).content);
    for (const double incidence : {0.0, 20.0, 40.0, 60.0}) {
        const Direction wi = Direction::fromSpherical(Radians::fromDegrees(incidence), 0_deg);
        const Direction left = test::AsymmetricLobe::lobeOf(wi);
        const Direction right = Direction::fromSpherical(45_deg, 140_deg);
        const double there = lobe.answer({wi, left}).f[Band::R];
        EXPECT_NEAR(at.answer({wi, left}).f[Band::R], there, 0.02 * there);
        EXPECT_LT(at.answer({wi, right}).f[Band::R], 0.8 * there);
    }
}

TEST(ExrTiles, KeepTheMirrorDirectionOfANarrowLobe) {
    const auto truth = model("ggx,alpha=0.05,f0=0.9");
    const SpecularLookup at =
        lookup(decoded(encodeExrTiles(filled(*truth, {72, 180}), {})).content);
    for (const int incidence : {0, 20, 40, 60}) {
        const Direction wi = Direction::fromSpherical(Radians::fromDegrees(incidence), 70_deg);
        double best = -1;
        int peak = -1;
        for (int theta = -80; theta <= 80; ++theta) {
            const Direction wo = Direction::fromSpherical(Radians::fromDegrees(std::abs(theta)),
                                                          theta < 0 ? 70_deg : 250_deg);
            const Answer answer = at.answer({wi, wo});
            if (answer.present() && answer.f[Band::R] > best) {
                best = answer.f[Band::R];
                peak = theta;
            }
        }
        EXPECT_NEAR(peak, incidence, 1);
    }
}

TEST(ExrTiles, HoldBothSidesOfAPlaneSymmetricalTable) {
    const auto truth = model("ggx,alpha=0.3,f0=0.5");
    const auto grid = exrTileGrid({10, 50}, {16, 8}, TableSymmetry::PlaneSymmetrical);
    EXPECT_EQ(grid.azimuthDeg.size(), 8U);
    const SpecularTable table = fillTable(*truth, grid, Band::G).table;
    const auto written = encodeExrTiles(table, {});
    const SpecularTable back = decoded(written).content;
    EXPECT_EQ(back.symmetry, TableSymmetry::PlaneSymmetrical);
    EXPECT_EQ(back.colour, TableColour::Monochrome);
    EXPECT_EQ(back.azimuthDeg, table.azimuthDeg);
    for (std::size_t i = 0; i < table.planes[0].f.size(); ++i) {
        ASSERT_NEAR(back.planes[0].f[i], table.planes[0].f[i], 1e-7 * table.planes[0].f[i]);
    }
    EXPECT_EQ(encodeExrTiles(back, {})->bytes, written->bytes);
    const std::string bent = changed(written->bytes, [](ExrPart& p) { p.floats["Y"][1] *= 2; });
    const auto read = decodeExrTiles(bent, "t.exr");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->content.symmetry, TableSymmetry::Asymmetrical);
    EXPECT_EQ(read->warnings.size(), 1U);
}

TEST(ExrTiles, StandBesideEachOtherAsAsked) {
    const SpecularTable table =
        filled(*model("lambert,albedo=0.3/0.2/0.1+ggx,alpha=0.2,f0=0.5"), {8, 4});
    for (const std::size_t columns : {1U, 2U, 3U, 4U, 100U}) {
        const auto written = encodeExrTiles(table, {}, {.columns = columns});
        ASSERT_TRUE(written);
        const auto parts = decodeExr(written->bytes, {.largest = {99, 99}, .parts = 1});
        ASSERT_TRUE(parts);
        EXPECT_EQ(parts->front().size.width,
                  8 * static_cast<int>(std::min<std::size_t>(columns, 4)));
        const SpecularTable back = decoded(written).content;
        for (std::size_t i = 0; i < table.nodeCount(); ++i) {
            const double f = table.planes[2].f[i];
            ASSERT_NEAR(back.planes[2].f[i], f, 1e-7 * f);
        }
    }
}

TEST(ExrTiles, KeepMasks) {
    SpecularTable table = filled(*model("lambert,albedo=0.3/0.2/0.1"), {8, 4});
    const TableNode gone{0, 1, 2, 1};
    table.planes[1].f[table.index(gone)] = kNan;
    const auto written = encodeExrTiles(table, {});
    ASSERT_TRUE(written);
    ASSERT_EQ(written->loss.items.size(), 1U);
    EXPECT_EQ(written->loss.items[0].kind, Loss::Masked);
    EXPECT_EQ(written->loss.items[0].count, 1U);
    const SpecularTable back = decoded(written).content;
    EXPECT_FALSE(back.hasData(gone));
    EXPECT_TRUE(back.hasData(TableNode{0, 1, 1, 1}));
}

TEST(ExrTiles, ReportWhatSixteenBitsCannotHold) {
    SpecularTable table = filled(*model("lambert,albedo=0.3/0.2/0.1"), {8, 4});
    table.planes[0].f[table.index({0, 0, 1, 0})] = 1e6;
    table.planes[1].f[table.index({0, 0, 1, 0})] = 1e-9;
    const auto written = encodeExrTiles(table, {}, {.half = true});
    ASSERT_TRUE(written);
    ASSERT_EQ(written->loss.items.size(), 3U);
    EXPECT_EQ(written->loss.items[0].kind, Loss::Clamped);
    EXPECT_EQ(written->loss.items[1].kind, Loss::Masked);
    const LossReport::Item& rounded = written->loss.items[2];
    EXPECT_EQ(rounded.kind, Loss::Resampled);
    EXPECT_EQ(rounded.what, "values rounded to 16 bits");
    const SpecularTable back = decoded(written).content;
    std::size_t differing = 0;
    double largest = 0;
    for (std::size_t p = 0; p < 3; ++p) {
        for (std::size_t i = 0; i < back.nodeCount(); ++i) {
            const double wrote = static_cast<float>(table.planes[p].f[i]);
            const double f = back.planes[p].f[i];
            if (f == 0 || f == 65504 || f == wrote) continue;
            ++differing;
            largest = std::max(largest, std::abs(f / wrote - 1));
        }
    }
    EXPECT_EQ(rounded.count, differing);
    EXPECT_NEAR(rounded.largestError.value_or(0), largest, 1e-7);  // floats
    EXPECT_GT(largest, 0);
    EXPECT_EQ(encodeExrTiles(back, {}, {.half = true})->loss.items.size(), 0U);
    EXPECT_EQ(back.planes[0].f[back.index({0, 0, 1, 0})], 65504);
    EXPECT_FALSE(back.hasData(1, {0, 0, 1, 0}));
    const double lambert = 0.3 / kPi;
    EXPECT_NEAR(back.planes[0].f[back.index({0, 0, 0, 0})], lambert, lambert / 2048);
}

TEST(ExrTiles, TakeOtherProgramsAttributesWithAWarning) {
    const std::string sound = smallFile();
    const auto without = [&](const char* key) {
        return changed(sound, [&](ExrPart& part) { part.text.erase(key); });
    };
    auto read = decodeExrTiles(without("gonioAngleUnit"), "t.exr");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->content.incidenceDeg, (std::vector<double>{0, 20, 40, 60}));
    EXPECT_EQ(read->warnings.size(), 1U);
    const std::string degrees = changed(sound, [](ExrPart& part) {
        part.text.erase("gonioAngleUnit");
        part.numbers["bsdfTileAngles"] = {0, 20, 40, 60};
    });
    read = decodeExrTiles(degrees, "t.exr");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->content.incidenceDeg, (std::vector<double>{0, 20, 40, 60}));
    // 8 x 16 pixels: one tile of 8 x 4 beside the other, or none would be even.
    read = decodeExrTiles(without("gonioTileColumns"), "t.exr");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->content.radialDeg.size(), 4U);
    EXPECT_EQ(read->warnings.size(), 1U);
}

TEST(ExrTiles, RefuseWhatDoesNotFitTogether) {
    const std::string sound = smallFile();
    const auto with = [&](auto change) { return decodeExrTiles(changed(sound, change), "t.exr"); };
    EXPECT_TRUE(with([](ExrPart&) {}));
    EXPECT_TRUE(
        refuses(decodeExrTiles("", "t.exr"), {"exr-tiles: t.exr: exr: not an OpenEXR file"}));
    EXPECT_TRUE(
        refuses(with([](ExrPart& p) { p.numbers.erase("bsdfTileAngles"); }), {"bsdfTileAngles"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.numbers["bsdfTileAngles"] = {}; })));
    EXPECT_TRUE(refuses(with([](ExrPart& p) {
                            p.numbers["bsdfTileAngles"] = {0.2F, 0.1F};
                        }),
                        {"ascending"}));
    const auto nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(
        refuses(with([&](ExrPart& p) { p.numbers["bsdfTileAngles"] = {nan}; }), {"ascending"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) {
                            p.numbers["bsdfTileAngles"] = {0, 0.1F, 0.2F};
                        }),
                        {"do not divide 8 x 16 pixels"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.text["bsdfType"] = "BSSRDF"; }),
                        {"'BSSRDF', wanted BRDF"}));
    EXPECT_TRUE(
        refuses(with([](ExrPart& p) { p.text["gonioPixelPhase"] = "edge"; }), {"wanted centre"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.text["gonioTileColumns"] = "5"; }), {"'5'"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.text["gonioTileColumns"] = "-1"; })));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.text["gonioAngleUnit"] = "grad"; }), {"'grad'"}));
    EXPECT_TRUE(
        refuses(with([](ExrPart& p) { p.text["gonioAtlas"] = "9999999 1"; }), {"gonioAtlas"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.text["gonioAtlas"] = "2"; }), {"gonioAtlas"}));
    EXPECT_TRUE(
        refuses(with([](ExrPart& p) { p.text["gonioAtlas"] = "2 1"; }), {"an atlas of 2 samples"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.floats.erase("G"); }), {"no channels R, G, B"}));
    EXPECT_TRUE(
        refuses(with([&](ExrPart& p) { p.floats["B"][9] = nan; }), {"channel 'B', pixel 1, 1"}));
    EXPECT_TRUE(refuses(with([](ExrPart& p) { p.text["long"] = std::string(100000, '\n'); }),
                        {"lines of text"}));
    for (std::size_t size = 0; size < sound.size(); size += 7) {
        EXPECT_TRUE(refuses(decodeExrTiles(sound.substr(0, size), "t.exr")));
    }
}

TEST(ExrTiles, RefuseTablesThatTheyCannotHold) {
    const SpecularTable sound = filled(*model("lambert,albedo=0.3/0.2/0.1"), {8, 4});
    const auto refused = [&](auto change) {
        SpecularTable table = sound;
        change(table);
        const auto written = encodeExrTiles(table, {});
        return !written && written.error().kind == ErrorKind::Usage;
    };
    EXPECT_FALSE(refused([](SpecularTable&) {}));
    EXPECT_TRUE(refused([](SpecularTable& t) { t.colour = TableColour::Xyz; }));
    EXPECT_TRUE(refused([](SpecularTable& t) { t.rotationDeg = {0, 90}; }));
    EXPECT_TRUE(refused([](SpecularTable& t) { t.azimuthDeg[3] += 1; }));
    EXPECT_TRUE(refused([](SpecularTable& t) { t.planes.pop_back(); }));
    EXPECT_TRUE(refused([](SpecularTable& t) { t.planes[0].f.pop_back(); }));
}

TEST(ExrTiles, ReadBackAPictureThatShrinksToNothing) {
    SpecularTable table;
    const SpecularGrid grid = exrTileGrid({0, 10, 20, 30, 40, 50, 60, 70}, {720, 360});
    table.symmetry = grid.symmetry;
    table.incidenceDeg = grid.incidenceDeg;
    table.azimuthDeg = grid.azimuthDeg;
    table.radialDeg = grid.radialDeg;
    table.colour = TableColour::LedBands;
    table.planes.assign(
        3,
        {.f = std::vector<double>(table.nodeCount(), 0.25), .tis = std::vector<double>(8, 0.75)});
    const auto written = encodeExrTiles(table, {});
    EXPECT_GT(written->bytes.size(), table.nodeCount() * 3 / 6);
    EXPECT_EQ(encodeExrTiles(decoded(written).content, {})->bytes, written->bytes);
}

TEST(ExrAtlas, HoldsSamplesInTheirOrder) {
    const char* specs[] = {"lambert,albedo=0.3/0.2/0.1",
                           "ggx,alpha=0.2,f0=0.5",
                           "lambert,albedo=0.9",
                           "ggx,alpha=0.4,f0=0.2",
                           "lambert,albedo=0.1"};
    std::vector<AtlasSample> samples;
    for (const char* spec : specs) {
        AtlasSample sample{.table = filled(*model(spec), {12, 6}), .about = {}};
        sample.about.set("sample", spec);
        samples.push_back(sample);
    }
    for (const std::size_t columns : {0U, 1U, 2U, 5U}) {
        const auto written = encodeExrAtlas(samples, {.innerColumns = columns});
        ASSERT_TRUE(written) << written.error().message;
        const auto back = decodeExrAtlas(written->bytes, "a.exr");
        ASSERT_TRUE(back) << back.error().message;
        ASSERT_EQ(back->size(), 5U);
        std::vector<AtlasSample> again;
        for (std::size_t k = 0; k < 5; ++k) {
            const FileRead<SpecularTable>& read = (*back)[k];
            EXPECT_EQ(read.about.at("sample"), specs[k]);
            for (std::size_t c = 0; c < 3; ++c) {
                for (std::size_t i = 0; i < read.content.nodeCount(); ++i) {
                    const double f = samples[k].table.planes[c].f[i];
                    ASSERT_NEAR(read.content.planes[c].f[i], f, 1e-7 * f);
                }
            }
            again.push_back({read.content, read.about});
        }
        EXPECT_EQ(encodeExrAtlas(again, {.innerColumns = columns})->bytes, written->bytes);
    }
}

TEST(ExrAtlas, RefusesSamplesThatDoNotGoTogether) {
    const auto truth = model("lambert,albedo=0.3/0.2/0.1");
    const AtlasSample first{.table = filled(*truth, {12, 6}), .about = {}};
    const auto refused = [&](SpecularTable second) {
        return !encodeExrAtlas(std::vector<AtlasSample>{first, {std::move(second), {}}});
    };
    EXPECT_FALSE(refused(first.table));
    EXPECT_TRUE(refused(filled(*truth, {12, 8})));
    EXPECT_TRUE(refused(filled(*truth, {12, 6}, {0, 20, 40, 61})));
    SpecularTable other = first.table;
    other.kind = ScatterKind::Btdf;
    EXPECT_TRUE(refused(other));
    EXPECT_FALSE(encodeExrAtlas({}));
}

}  // namespace
}  // namespace gonio::proc
