#include "proc/export/band_choice.h"

#include <gtest/gtest.h>

#include "proc/export/source_of.h"
#include "proc/export/tensor_fit.h"
#include "proc/models/spec.h"
#include "proc/table/specular_fill.h"
#include "tests/support/spherical_tables.h"

namespace gonio::proc {
namespace {

using Bands = std::vector<Band>;

BandChoice parsed(std::string_view text) {
    const auto choice = parseBandChoice(text);
    EXPECT_TRUE(choice) << text;
    return choice ? *choice : BandChoice{};
}

LightView somePair() {
    return {.in = Direction::fromSpherical(Radians::fromDegrees(20), Radians(0)),
            .out = Direction::fromSpherical(Radians::fromDegrees(30), Radians::fromDegrees(90))};
}

/// f = 1, 2, ... by channel.
BrdfFile scans() {
    return {
        .format = Format::LightTools,
        .content = test::sphericalTable({.channels = {{"scan 1", {}}, {"scan 2", {}}, {"", 532}}},
                                        [](const LightView&, std::size_t channel) {
                                            return 1.0 + static_cast<double>(channel);
                                        }),
        .about = {},
        .warnings = {}};
}

double answered(const BrdfFile& file, const BandChoice& choice) {
    const auto source = sourceOf(file, choice);
    EXPECT_TRUE(source) << (source ? "" : source.error().message);
    if (!source || !source->scatterer) return -1;
    EXPECT_EQ(source->scatterer->bandCount(), BandCount::One);
    return source->scatterer->answer(somePair()).f[Band::G];
}

TEST(BandChoice, IsBandsOrANumberOrSrgb) {
    EXPECT_EQ(parsed("b,r").bands, (Bands{Band::R, Band::B}));
    EXPECT_TRUE(parsed("srgb").srgb);
    EXPECT_EQ(parsed("2").channel, 2U);
    EXPECT_TRUE(parsed("2").bands.empty());
    EXPECT_EQ(parsed("g=12").channel, 12U);
    EXPECT_EQ(parsed("g=12").bands, Bands{Band::G});
    for (const char* wrong : {"", "0", "-1", "x", "r,", "r,r", "g=", "=2", "r,g=2", "2=g", "2,3"}) {
        EXPECT_FALSE(parseBandChoice(wrong)) << wrong;
    }
}

TEST(BandChoice, TakesOneChannelOfBlocks) {
    const auto refused = bandsOf(scans());
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("--bands 2 takes the second"), std::string::npos);
    EXPECT_EQ(answered(scans(), parsed("1")), 1);
    EXPECT_EQ(answered(scans(), parsed("2")), 2);
    const auto unknown = chosen(scans(), parsed("2"));
    ASSERT_TRUE(unknown);
    EXPECT_EQ(unknown->band, std::nullopt);
    EXPECT_EQ(unknown->about.at("channel"), "2: scan 2");
    EXPECT_EQ(channelsOf(*unknown), std::vector<Channel>{Channel{}});
    EXPECT_EQ(chosen(scans(), parsed("b=2"))->band, Band::B);
    const auto known = chosen(scans(), parsed("3"));
    EXPECT_EQ(known->band, Band::G);  // 532 nm
    EXPECT_EQ(channelsOf(*known)[0].nanometres, 532);
    const auto none = chosen(scans(), parsed("4"));
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::Usage);
    EXPECT_NE(none.error().message.find("the file has 3 channels"), std::string::npos);
}

TEST(BandChoice, TakesOneChannelOfRows) {
    BrdfRows rows{.channels = {{"a", {}}, {"b", {}}}, .pairs = {somePair(), somePair()}};
    rows.f = {1, 2, 3, 4};
    rows.uRandom = {5, 6, 7, 8};
    const auto one =
        chosen({.format = Format::Csv, .content = rows, .about = {}, .warnings = {}}, parsed("2"));
    ASSERT_TRUE(one);
    EXPECT_EQ(one->as<BrdfRows>()->f, (std::vector<double>{2, 4}));
    EXPECT_EQ(one->as<BrdfRows>()->uRandom, (std::vector<double>{6, 8}));
    EXPECT_TRUE(one->as<BrdfRows>()->flags.empty());
}

TEST(BandChoice, TakesOneChannelOfATensor) {
    const auto model = makeModel("lambert,albedo=0.3/0.2/0.1");
    ASSERT_TRUE(model);
    const FittedTensor fitted = fitTensor(**model, {.side = 8, .spectral = true});
    const BrdfFile file{
        .format = Format::Rgl, .content = fitted.table, .about = {}, .warnings = {}};
    EXPECT_NEAR(answered(file, parsed("1")), 0.1 / kPi, 1e-3);  // 465 nm
    EXPECT_NEAR(answered(file, parsed("3")), 0.3 / kPi, 1e-3);
    EXPECT_EQ(chosen(file, parsed("3"))->band, Band::R);
}

TEST(BandChoice, TakesTristimulusValuesAndBandsOfATable) {
    const auto model = makeModel("lambert,albedo=0.3/0.2/0.1");
    ASSERT_TRUE(model);
    const auto grid = SpecularGrid::oneDegree({0, 20}, TableSymmetry::PlaneSymmetrical);
    BrdfFile file{.format = Format::ExrTiles,
                  .content = fillBands(**model, grid).table,
                  .about = {},
                  .warnings = {}};
    EXPECT_EQ(sourceOf(file, parsed("3"))->bands, Bands{Band::B});
    EXPECT_TRUE(chosen(file, parsed("b=3")));
    EXPECT_FALSE(chosen(file, parsed("r=3")));
    std::get<SpecularTable>(file.content).colour = TableColour::Xyz;
    EXPECT_FALSE(bandsOf(file));
    EXPECT_NEAR(answered(file, parsed("2")), 0.2 / kPi, 1e-12);
    EXPECT_EQ(chosen(file, parsed("2"))->about.at("channel"), "2: Y");
}

}  // namespace
}  // namespace gonio::proc
