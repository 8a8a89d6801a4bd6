#include "proc/formats/mbsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "proc/formats/little_endian.h"
#include "proc/table/block_integral.h"
#include "proc/table/spherical_lookup.h"
#include "tests/formats/refusal.h"
#include "tests/support/spherical_tables.h"

namespace gonio::proc {
namespace {

using test::refuses;

const std::string kHead = "NVIDIA ARC MBSDF V1\nname=\"a \\\"tile\\\"\\n\\\\\"\ndate=\"\"\n";

std::string block(std::uint32_t type, std::uint32_t thetas, std::uint32_t azimuths) {
    std::string bytes;
    for (const std::uint32_t word : {type, thetas, azimuths}) appendLittle(bytes, word);
    for (std::uint32_t i = 0; i < thetas * thetas * azimuths * (type == 0 ? 1 : 3); ++i) {
        appendLittle(bytes, 0.5F + static_cast<float>(i));
    }
    return bytes;
}

std::string smallFile() {
    return kHead + "MBSDF_DATA_REFLECTION=\n" + block(1, 2, 3) + "MBSDF_DATA_TRANSMISSION=\n" +
           block(1, 3, 2);
}

std::string oneBlock(const std::string& data) { return kHead + "MBSDF_DATA=\n" + data; }

TEST(Mbsdf, ReadsValuesAtTheCentresOfCells) {
    const auto read = parseMbsdf(smallFile(), "t.mbsdf");
    ASSERT_TRUE(read) << read.error().message;
    const SphericalTable& table = read->content;
    ASSERT_EQ(table.blocks.size(), 2U * 3 + 3 * 3);
    EXPECT_TRUE(table.planeSymmetrical);
    EXPECT_EQ(table.mirrorAzimuthDeg, 180);
    const SphericalBlock& second = table.blocks[3 + 2];  // theta_in 1, B
    EXPECT_EQ(second.channel, 2U);
    EXPECT_EQ(second.incidenceDeg, 67.5);
    EXPECT_EQ(second.azimuthDeg, (std::vector<double>{30, 90, 150}));
    EXPECT_EQ(second.thetaDeg, (std::vector<double>{22.5, 67.5}));
    // 3 channels * (theta_in * 2 * 3 + theta_out * 3 + azimuth) + channel.
    EXPECT_EQ(second.f[second.index(2, 1)], 0.5 + 3 * (6 + 3 + 2) + 2);
    EXPECT_EQ(read->about.at("name"), "a \"tile\"\n\\");
}

TEST(Mbsdf, CountsTransmissionFromTheLowerNormal) {
    const auto read = parseMbsdf(smallFile(), "t.mbsdf");
    ASSERT_TRUE(read);
    const SphericalBlock& below = read->content.blocks[6];  // theta_in 0, R
    EXPECT_TRUE(below.transmission);
    EXPECT_EQ(below.thetaDeg, (std::vector<double>{105, 135, 165}));
    EXPECT_EQ(below.f[below.index(1, 2)], 0.5 + 3 * (0 * 2 + 1));  // the first theta_out
}

TEST(Mbsdf, WritesTheSameBytesAgain) {
    const auto read = parseMbsdf(smallFile(), "t.mbsdf");
    ASSERT_TRUE(read);
    const auto once = writeMbsdf(read->content, read->about);
    ASSERT_TRUE(once) << once.error().message;
    EXPECT_TRUE(once->loss.items.empty());
    const auto back = parseMbsdf(once->bytes, "t.mbsdf");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->about, read->about);
    const auto twice = writeMbsdf(back->content, back->about);
    ASSERT_TRUE(twice);
    EXPECT_EQ(twice->bytes, once->bytes);
}

TEST(Mbsdf, KeepsMetadataAndComments) {
    Metadata about;
    about.set("sample", "tile \"7\"");
    about.set("notes", "two\nlines");
    about.set("a b", "no key of the format");
    about.comments = {"first", "second \\ \"quoted\""};
    const auto out = writeMbsdf(mbsdfGrid({{"", 525}}, {2, 2}), about);
    ASSERT_TRUE(out);
    const auto back = parseMbsdf(out->bytes, "t.mbsdf");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->about.at("sample"), "tile \"7\"");
    EXPECT_EQ(back->about.at("notes"), "two\nlines");
    EXPECT_EQ(back->about.comments, about.comments);
    ASSERT_EQ(out->loss.items.size(), 3U);  // the key, the wavelength, the missing values
    EXPECT_EQ(out->loss.items[0].what, "metadata entries");
    EXPECT_EQ(out->loss.items[0].count, 1U);
    EXPECT_EQ(out->loss.items[2].kind, Loss::Masked);
    EXPECT_EQ(out->loss.items[2].count, 8U);
}

TEST(Mbsdf, RefusesDamage) {
    const std::string sound = smallFile();
    EXPECT_TRUE(refuses(parseMbsdf("", "t.mbsdf"), {"mbsdf: t.mbsdf: byte 0"}));
    EXPECT_TRUE(refuses(parseMbsdf("\xEF\xBB\xBF" + sound, "t.mbsdf"), {"NVIDIA ARC MBSDF V1"}));
    EXPECT_TRUE(refuses(parseMbsdf(sound + "x", "t.mbsdf"), {"nothing after the last block"}));
    EXPECT_TRUE(refuses(parseMbsdf(kHead + "name=\"b\"\nMBSDF_DATA=\n", "t.mbsdf"),
                        {"'name' is given twice"}));
    EXPECT_TRUE(refuses(parseMbsdf(kHead + "size=3\nMBSDF_DATA=\n", "t.mbsdf"), {"key=\"value\""}));
    EXPECT_TRUE(
        refuses(parseMbsdf(oneBlock(block(0, 1, 1).replace(0, 1, "\2")), "t.mbsdf"), {"type 2"}));
    for (std::size_t size = 0; size < sound.size(); ++size) {
        if (size == (kHead + "MBSDF_DATA_REFLECTION=\n" + block(1, 2, 3)).size()) continue;
        EXPECT_FALSE(parseMbsdf(std::string_view(sound).substr(0, size), "t.mbsdf")) << size;
    }
}

TEST(Mbsdf, RefusesCountsThatTheFileCannotHold) {
    for (const auto& [thetas, azimuths] : {std::pair{0xFFFFFFFFU, 0xFFFFFFFFU},
                                           std::pair{0x80000000U, 4U},
                                           std::pair{0U, 4U},
                                           std::pair{4U, 0U},
                                           std::pair{2U, 100U}}) {
        std::string head;
        for (const std::uint32_t word : {0U, thetas, azimuths}) appendLittle(head, word);
        const std::string file = oneBlock(head + std::string(64, '\0'));
        EXPECT_TRUE(refuses(parseMbsdf(file, "t.mbsdf"), {"values, 16 are left"}));
    }
}

TEST(Mbsdf, RefusesANumberThatIsNone) {
    std::string data = block(0, 2, 2);
    std::string raw;
    appendLittle(raw, std::numeric_limits<float>::quiet_NaN());
    data.replace(12 + 4 * 5, 4, raw);
    const std::string at = std::to_string(kHead.size() + 12 + 12 + 20);
    EXPECT_TRUE(
        refuses(parseMbsdf(oneBlock(data), "t.mbsdf"), {"byte " + at + ": not a finite number"}));
}

TEST(Mbsdf, DoesNotWriteOtherDirections) {
    SphericalTable table = mbsdfGrid({{}}, {4, 4});
    EXPECT_TRUE(writeMbsdf(table));
    table.blocks[1].thetaDeg[2] += 1;
    EXPECT_FALSE(writeMbsdf(table));
    EXPECT_FALSE(writeMbsdf(SphericalTable{}));
    table = mbsdfGrid({{}}, {4, 4});
    table.blocks.pop_back();
    EXPECT_FALSE(writeMbsdf(table));
    EXPECT_FALSE(writeMbsdf(mbsdfGrid({{"X", {}}, {"Y", {}}, {"Z", {}}}, {4, 4})));
}

template <class Value>
SphericalTable throughFile(MbsdfShape shape, const Value& value) {
    SphericalTable table = mbsdfGrid({{}}, shape);
    for (SphericalBlock& block : table.blocks) {
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                block.f[block.index(a, t)] = value(table.pairAt(block, a, t));
            }
        }
    }
    auto read = parseMbsdf(writeMbsdf(table)->bytes, "t.mbsdf");
    EXPECT_TRUE(read);
    return read->content;
}

double askedAt(const SphericalTable& table, double thetaI, double thetaO, double apart) {
    const auto lookup = SphericalLookup::over(table, *bandChannels(table.channels));
    EXPECT_TRUE(lookup);
    const auto at = [](double theta, double phi) {
        return Direction::fromSpherical(Radians::fromDegrees(theta), Radians::fromDegrees(phi));
    };
    const Answer answer = lookup->answer({.in = at(thetaI, 33), .out = at(thetaO, 33 + apart)});
    EXPECT_TRUE(answer.present()) << thetaI << ' ' << thetaO << ' ' << apart;
    return answer.f[Band::R];
}

TEST(Mbsdf, AnswersAtTheMirrorDirectionAndOnItsOwnSide) {
    const auto lobe = [](const LightView& pair) { return test::mirrorLobe(pair, 10); };
    const SphericalTable table = throughFile({}, lobe);
    // Of a lobe of 10 degrees two of the four nodes about it are a degree beside the peak, and all
    // half a degree of azimuth: 0.75 %.
    for (const double theta : {20.0, 40.0, 60.0}) {
        EXPECT_NEAR(askedAt(table, theta, theta, 180), 1, 7.5e-3) << theta;
        EXPECT_NEAR(askedAt(table, theta, theta, -180), 1, 7.5e-3) << theta;
        EXPECT_LT(askedAt(table, theta, theta, 0), 0.1);
    }
}

/// The cells of the ends hold to the normal and to the horizon.
TEST(Mbsdf, AnswersAtTheNormalAndNearTheHorizon) {
    const auto byTheta = [](const LightView& pair) {
        return pair.in.theta().degrees() + 100 * pair.out.theta().degrees();
    };
    for (const MbsdfShape shape : {MbsdfShape{}, MbsdfShape{.thetas = 1, .azimuths = 1}}) {
        const SphericalTable table = throughFile(shape, byTheta);
        const double first = 45.0 / static_cast<double>(shape.thetas);
        for (const double apart : {0.0, 0.1, 90.0, 179.9, 180.0, 270.0}) {
            EXPECT_NEAR(askedAt(table, 0, 0, apart), 101 * first, 1e-3);
            EXPECT_NEAR(askedAt(table, 89.95, 89.95, apart), 101 * (90 - first), 1e-2);
            EXPECT_NEAR(askedAt(table, 0, 89.95, apart), first + 100 * (90 - first), 1e-2);
        }
    }
}

TEST(Mbsdf, IntegratesALambertianToItsAlbedo) {
    for (const MbsdfShape shape : {MbsdfShape{},
                                   MbsdfShape{.thetas = 7, .azimuths = 5},
                                   MbsdfShape{.thetas = 1, .azimuths = 1}}) {
        const SphericalTable table = throughFile(shape, [](const LightView&) { return 0.5 / kPi; });
        for (const SphericalBlock& block : table.blocks) {
            EXPECT_NEAR(blockIntegral(table, block), 0.5, 1e-7);  // floats
        }
    }
}

}  // namespace
}  // namespace gonio::proc
