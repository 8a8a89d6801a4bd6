#include "proc/formats/exr_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "proc/formats/file_bytes.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;

constexpr ExrLimits kLimits{.largest = {64, 64}, .parts = 8};

std::vector<std::uint32_t> bitsOf(const std::vector<float>& values) {
    std::vector<std::uint32_t> bits;
    for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
    return bits;
}

void expectSame(const ExrPart& a, const ExrPart& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(a.counts, b.counts);
    ASSERT_EQ(a.floats.size(), b.floats.size());
    for (const auto& [name, pixels] : a.floats)
        EXPECT_EQ(bitsOf(pixels), bitsOf(b.floats.at(name)));
    EXPECT_EQ(a.text, b.text);
}

ExrPart smallPart(const std::string& name) {
    ExrPart part;
    part.name = name;
    part.size = {4, 3};
    part.text["gonio.note"] = "a\nb \xc3\xa9";
    part.text["gonio.empty"] = "";
    part.floats["f"] = std::vector<float>(12, 0.5F);
    part.counts["n"] = std::vector<std::uint32_t>(12, 7);
    return part;
}

std::string encoded(std::vector<ExrPart> parts) {
    auto bytes = encodeExr(parts);
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().message);
    return bytes ? std::move(*bytes) : "";
}

std::string smallFile() { return encoded({smallPart("one"), smallPart("two")}); }

std::string word(std::uint32_t value) {
    std::string bytes;
    for (unsigned i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
    return bytes;
}

/// An attribute as a header holds it.
std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + word(static_cast<std::uint32_t>(value.size())) + value;
}

/// The file with the value of its first attribute of that name and type changed.
std::string withValue(std::string file, std::string_view nameAndType, std::string_view value) {
    const std::size_t at = file.find(nameAndType) + nameAndType.size() + 4;
    return file.replace(at, value.size(), value);
}

constexpr std::string_view kWindow("dataWindow\0box2i\0", 17);
constexpr std::string_view kCompression("compression\0compression\0", 24);
constexpr std::size_t kHeaderStart = 8;  // after the magic number and the version

TEST(ExrParts, ReadBackEveryBit) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 50; ++i) {
        std::vector<ExrPart> parts;
        for (std::uint64_t n = random() % 4; parts.size() <= n;) {
            ExrPart part;
            part.name = "part" + std::to_string(parts.size());
            part.size = {1 + static_cast<int>(random() % 64), 1 + static_cast<int>(random() % 64)};
            part.text["key"] = std::string(random() % 3000, 'x');
            for (std::size_t pixel = 0; pixel < part.size.pixels(); ++pixel) {
                const auto bits = static_cast<std::uint32_t>(random());
                part.floats["a"].push_back(std::bit_cast<float>(bits));
                part.floats["b"].push_back(static_cast<float>(pixel));
                part.counts["c"].push_back(bits);
            }
            parts.push_back(std::move(part));
        }
        const std::string bytes = encoded(parts);
        const auto back = decodeExr(bytes, kLimits);
        ASSERT_TRUE(back) << back.error().message;
        ASSERT_EQ(back->size(), parts.size());
        for (std::size_t k = 0; k < parts.size(); ++k) expectSame(parts[k], (*back)[k]);
        EXPECT_EQ(encoded(*back), bytes);
    }
}

TEST(ExrParts, KeepTheNameOfThePartOutOfItsTexts) {
    auto parts = *decodeExr(encoded({smallPart("one")}), kLimits);
    parts[0].name = "other";
    EXPECT_EQ(decodeExr(encoded(parts), kLimits)->at(0).name, "other");
}

TEST(ExrParts, RefuseToBeWrittenWithoutPixelsOrWithTheWrongNumber) {
    EXPECT_TRUE(refuses(encodeExr({}), {"no parts"}));
    ExrPart empty = smallPart("empty");
    empty = {.name = "empty", .size = {0, 3}, .text = {}, .floats = {}, .counts = {}};
    ExrPart fewFloats = smallPart("few");
    fewFloats.floats["f"].pop_back();
    ExrPart manyCounts = smallPart("many");
    manyCounts.counts["n"].push_back(1);
    for (const ExrPart& part : {empty, fewFloats, manyCounts}) {
        const auto bytes = encodeExr(std::vector{smallPart("one"), part});
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().kind, ErrorKind::Internal);
        EXPECT_NE(bytes.error().message.find("part " + part.name), std::string::npos);
    }
    EXPECT_TRUE(refuses(encodeExr(std::vector{smallPart("one"), smallPart("one")})));
}

TEST(ExrParts, RefuseWhatIsNotOpenExr) {
    for (const std::string& bytes :
         {std::string(), std::string("banana"), std::string(100, '\0'), smallFile().substr(1)}) {
        EXPECT_TRUE(refuses(decodeExr(bytes, kLimits), {"exr: not an OpenEXR file"}));
    }
}

TEST(ExrParts, RefuseAFileCutAtAnyByte) {
    const std::string bytes = smallFile();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_TRUE(refuses(decodeExr(bytes.substr(0, size), kLimits), {"exr: "})) << size;
    }
}

TEST(ExrParts, RefuseLossyCompression) {
    const std::string bytes = smallFile();
    for (int code = 0; code < 256; ++code) {
        const auto parts = decodeExr(
            withValue(bytes, kCompression, std::string(1, static_cast<char>(code))), kLimits);
        if (code <= 3) {
            EXPECT_TRUE(parts || refuses(parts, {"exr: damaged"})) << code;
        } else {
            EXPECT_TRUE(refuses(parts, {"compression is not one of none, RLE, ZIPS, ZIP"}));
        }
    }
}

TEST(ExrParts, RefusePicturesOutsideTheLimits) {
    const auto windowed =
        [](std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1) {
            return decodeExr(
                withValue(smallFile(), kWindow, word(x0) + word(y0) + word(x1) + word(y1)),
                kLimits);
        };
    const std::uint32_t most = 0x7fff'ffff;
    const std::uint32_t least = 0x8000'0000;
    EXPECT_TRUE(windowed(0, 0, 3, 2));
    EXPECT_TRUE(refuses(windowed(0, 0, 64, 2), {"picture size outside 1 x 1 .. 64 x 64"}));
    EXPECT_TRUE(refuses(windowed(0, 0, 3, 64), {"picture size"}));
    EXPECT_TRUE(refuses(windowed(0, 0, most, most), {"picture size"}));
    EXPECT_TRUE(refuses(windowed(least, least, most, most), {"picture size"}));
    EXPECT_TRUE(refuses(windowed(4, 0, 3, 2), {"picture size"}));
    EXPECT_TRUE(refuses(windowed(0, most, 0, least), {"picture size"}));
    EXPECT_TRUE(refuses(windowed(1, 0, 4, 2), {"does not start at 0,0"}));
    EXPECT_TRUE(refuses(windowed(least, least, least + 3, least + 2), {"exr: "}));
    EXPECT_TRUE(refuses(windowed(0, 0, 63, 63), {"exr: "}));  // within the limits, but not there
}

TEST(ExrParts, RefuseMorePixelsThanTheFileCanHoldBeforeTheyMakeRoom) {
    const std::uint32_t last = 59'999;  // 14 GB a channel
    const std::string file =
        withValue(smallFile(), kWindow, word(0) + word(0) + word(last) + word(last));
    EXPECT_TRUE(refuses(decodeExr(file, {.largest = {60'000, 60'000}, .parts = 8}), {"exr: "}));
}

TEST(ExrParts, RefuseMorePartsThanTheLimit) {
    EXPECT_TRUE(decodeExr(smallFile(), {.largest = {4, 3}, .parts = 2}));
    EXPECT_TRUE(
        refuses(decodeExr(smallFile(), {.largest = {4, 3}, .parts = 1}), {"more than 1 parts"}));
}

TEST(ExrParts, RefuseAttributesThatEndBeyondTheFile) {
    const std::string name("gonio.note\0string\0", 18);
    for (const std::uint32_t size : {0x7fff'ffffU, 0xffff'ffffU, 100'000U}) {
        std::string file = smallFile();
        file.replace(file.find(name) + name.size(), 4, word(size));
        EXPECT_TRUE(refuses(decodeExr(file, kLimits), {"exr: truncated in a header"}));
    }
    std::string file = smallFile();
    file.insert(kHeaderStart, std::string(300, 'n'));
    EXPECT_TRUE(refuses(decodeExr(file, kLimits), {"exr: truncated in a header"}));
}

TEST(ExrParts, RefuseAttributesThatPromiseMoreThanTheyHold) {
    for (const std::string& lie : {attribute("preview", "preview", word(30'000) + word(30'000)),
                                   attribute("preview", "preview", word(0x8000'0000) + word(2)),
                                   attribute("names", "stringvector", word(0x7fff'fff0)),
                                   attribute("names", "stringvector", word(0xffff'ffff)),
                                   attribute("dataWindow", "box2i", word(0)),
                                   attribute("channels", "chlist", "no end"),
                                   attribute("tiles", "tiledesc", word(1))}) {
        std::string file = smallFile();
        file.insert(kHeaderStart, lie);
        EXPECT_TRUE(refuses(decodeExr(file, kLimits), {"exr: ", "which it says that it is"}));
    }
}

// Found by libFuzzer: the library reads a channel list on to its end, wherever that is, and took
// the next bytes for the size of something to make room for.
TEST(ExrParts, RefuseAChannelListThatGoesOnBeyondItsSize) {
    const std::string list = std::string("f\0", 2) + word(2) + word(0) + word(1) + word(1);
    for (const std::string& wrong : {list, list + list, list + '\0' + '\0', std::string()}) {
        std::string file = smallFile();
        file.insert(kHeaderStart, attribute("more", "chlist", wrong));
        EXPECT_TRUE(refuses(decodeExr(file, kLimits), {"'more' is not 'chlist'"}));
    }
}

TEST(ExrParts, TakeSoundAttributesThatTheyDoNotKnow) {
    for (const std::string& other :
         {attribute("preview", "preview", word(2) + word(1) + word(0) + word(0)),
          attribute("names", "stringvector", word(2) + "ab" + word(0)),
          attribute("times", "floatvector", word(0) + word(1)),
          attribute("ours", "of our own", "any bytes")}) {
        std::string file = smallFile();
        file.insert(kHeaderStart, other);
        // Where the pixels begin stands in the file: only the headers can be read of this one.
        EXPECT_TRUE(refuses(decodeExr(file, kLimits), {"damaged"}));
    }
}

TEST(ExrParts, RefuseOtherKindsOfOpenExr) {
    const std::string bytes = smallFile();
    for (const std::uint32_t version : {0U, 1U, 3U, 0x202U, 0x802U, 0x1802U, 0x8000'0002U}) {
        std::string file = bytes;
        file.replace(4, 4, word(version));
        EXPECT_TRUE(refuses(decodeExr(file, kLimits), {"a version or kind that is not read"}));
    }
    EXPECT_TRUE(refuses(decodeExr(replaced(bytes, "scanlineimage", "deepscanline0"), kLimits),
                        {"not of scan lines"}));
}

TEST(ExrParts, RefuseChannelsThatAreNotSampledAtEveryPixel) {
    const std::string channel = std::string("f\0", 2) + word(2) + word(0);
    std::string file = encoded({smallPart("one")});
    file.replace(file.find(channel) + channel.size(), 4, word(2));
    EXPECT_TRUE(refuses(decodeExr(file, kLimits), {"exr: damaged: "}));
}

TEST(ExrParts, ReadHalvesAsFloatsAndRefuseOtherKindsOfRealFiles) {
    constexpr ExrLimits kAny{.largest = {4096, 4096}, .parts = 8};
    if (const auto file = test::dataFile("exr_edge_cases/BrightRings.exr")) {
        const auto parts = decodeExr(*readFile(*file), kAny);
        ASSERT_TRUE(parts) << parts.error().message;
        ASSERT_EQ(parts->size(), 1U);
        const std::vector<float>& green = parts->at(0).floats.at("G");
        EXPECT_EQ(green.size(), parts->at(0).size.pixels());
        EXPECT_EQ(*std::max_element(green.begin(), green.end()), 1025);
    }
    if (const auto file = test::dataFile("exr_edge_cases/MirrorPattern.exr")) {  // tiled
        EXPECT_TRUE(refuses(decodeExr(*readFile(*file), kAny), {"a version or kind"}));
    }
    for (const char* name : {"AllHalfValues", "Rec709", "t06", "XYZ"}) {  // PIZ
        const auto file = test::dataFile("exr_edge_cases/" + std::string(name) + ".exr");
        if (!file) continue;
        EXPECT_TRUE(refuses(decodeExr(*readFile(*file), kAny), {"compression is not one of"}));
    }
}

TEST(ExrParts, RefusesMorePixelsThanItWasToldToRead) {
    const auto all = decodeExr(smallFile(), {.largest = {4, 3}, .parts = 2});
    ASSERT_TRUE(all);
    std::size_t bytes = 0;
    for (const ExrPart& part : *all) {
        bytes += (part.floats.size() + part.counts.size()) * part.size.pixels() * sizeof(float);
    }
    EXPECT_TRUE(decodeExr(smallFile(), {.largest = {4, 3}, .parts = 2, .bytes = bytes}));
    EXPECT_TRUE(refuses(decodeExr(smallFile(), {.largest = {4, 3}, .parts = 2, .bytes = bytes - 1}),
                        {"exr: ", std::to_string(bytes) + " bytes of pixels"}));
}

TEST(ExrParts, StoreHalvesAndNumbersInASinglePart) {
    ExrPart part;
    part.size = {2, 1};
    part.floats["R"] = {0.1F, 65504.0F};
    part.floats["G"] = {1.0F, -0.25F};
    part.numbers["angles"] = {0, 0.25F, -1e30F};
    part.numbers["none"] = {};
    part.half = true;
    const auto bytes = encodeExr(std::vector{part});
    ASSERT_TRUE(bytes);
    EXPECT_EQ((*bytes)[5] & 0x10, 0);  // of one part, as plain readers want it
    const auto back = decodeExr(*bytes, {.largest = {2, 1}, .parts = 1});
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE(back->front().half);
    EXPECT_EQ(back->front().numbers, part.numbers);
    EXPECT_EQ(back->front().floats.at("G"), part.floats["G"]);
    // Nearest of 11 significant bits.
    EXPECT_NEAR(back->front().floats.at("R")[0], 0.1F, 0.1F / 2048);
    EXPECT_EQ(back->front().floats.at("R")[1], 65504.0F);
    EXPECT_EQ(*encodeExr(*back), *bytes);
}

}  // namespace
}  // namespace gonio::proc
