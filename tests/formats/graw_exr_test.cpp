#include "proc/formats/graw_exr.h"

#include <gtest/gtest.h>

#include <bit>
#include <climits>
#include <functional>

#include "proc/formats/exr_parts.h"
#include "proc/formats/file_bytes.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;
using test::smallCapture;
using test::smallState;

constexpr ExrLimits kLimits{.largest = {64, 64}, .parts = 16};

std::string encoded(const RawCapture& capture) {
    auto bytes = encodeGraw(capture);
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().message);
    return bytes ? std::move(*bytes) : "";
}

RawCapture decoded(std::string_view bytes) {
    auto capture = decodeGraw(bytes, "in.graw");
    EXPECT_TRUE(capture) << (capture ? "" : capture.error().message);
    return capture ? std::move(*capture) : RawCapture{};
}

/// What decodeGraw says to a capture whose parts were changed.
Result<RawCapture> afterChange(const std::function<void(std::vector<ExrPart>&)>& change) {
    auto parts = decodeExr(encoded(smallCapture()), kLimits);
    EXPECT_TRUE(parts);
    change(*parts);
    return decodeGraw(*encodeExr(*parts), "in.graw");
}

/// The same with a piece of the first state's JSON replaced.
Result<RawCapture> withState(std::string_view from, std::string_view to) {
    return afterChange([&](std::vector<ExrPart>& parts) {
        std::string& state = parts[0].text.at("gonio.state");
        ASSERT_NE(state.find(from), std::string::npos) << from << " in " << state;
        state = replaced(state, from, to);
    });
}

void expectSameBits(const Image<float>& a, const Image<float>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.pixels().size(); ++i) {
        EXPECT_EQ(std::bit_cast<std::uint32_t>(a.pixels()[i]),
                  std::bit_cast<std::uint32_t>(b.pixels()[i]));
    }
}

void expectSame(const RawState& a, const RawState& b) {
    expectSameBits(a.merged.radiance, b.merged.radiance);
    expectSameBits(a.merged.variance, b.merged.variance);
    EXPECT_EQ(a.merged.used, b.merged.used);
    EXPECT_EQ(a.merged.saturated, b.merged.saturated);
    EXPECT_EQ(a.merged.window, b.merged.window);
    EXPECT_EQ(a.merged.led, b.merged.led);
    EXPECT_EQ(a.merged.band, b.merged.band);
    EXPECT_EQ(a.merged.allSaturatedPixels, b.merged.allSaturatedPixels);
    EXPECT_EQ(a.merged.chiSquare, b.merged.chiSquare);
    EXPECT_EQ(a.merged.freedom, b.merged.freedom);
    EXPECT_EQ(a.bracket, b.bracket);
}

TEST(GrawFile, ReadsBackEverythingAndWritesTheSameBytes) {
    const RawCapture capture = smallCapture();
    const std::string bytes = encoded(capture);
    const RawCapture back = decoded(bytes);
    EXPECT_EQ(back.info, capture.info);
    ASSERT_EQ(back.states.size(), capture.states.size());
    for (std::size_t i = 0; i < 3; ++i) expectSame(back.states[i], capture.states[i]);
    EXPECT_EQ(encoded(back), bytes);
}

TEST(GrawFile, KeepsTheExtremesOfWhatAStateHolds) {
    RawCapture capture{.info = {{"", ""}, {"\xce\xb8", "a\n\"b\""}}, .states = {}};
    RawState state = smallState(11, Band::G);
    state.merged.chiSquare = 1.0 / 3;
    state.merged.freedom = SIZE_MAX;
    state.merged.window.x = -1;
    state.bracket = {{.captureId = 0,
                      .granted = Nanoseconds(INT64_MAX),
                      .level = 0,
                      .frames = INT_MAX,
                      .blackLevel = 65535,
                      .celsius = {5e-324, -273.15, std::nullopt, 1e308}}};
    capture.states = {state};
    const RawCapture back = decoded(encoded(capture));
    EXPECT_EQ(back.info, capture.info);
    expectSame(back.states.at(0), state);
    capture.states[0].bracket.clear();
    expectSame(decoded(encoded(capture)).states.at(0), capture.states[0]);
}

TEST(GrawFile, RefusesToBeWrittenWithoutStatesOrWithOneTwice) {
    for (const RawCapture& capture :
         {RawCapture{},
          RawCapture{.info = {}, .states = {smallState(0, Band::R), smallState(0, Band::R)}}}) {
        const auto bytes = encodeGraw(capture);
        ASSERT_FALSE(bytes);
        EXPECT_EQ(bytes.error().kind, ErrorKind::Internal);
    }
}

TEST(GrawFile, RefusesAnotherSchema) {
    for (const char* schema : {"", "gonio/raw/2", "gonio/sample/1"}) {
        EXPECT_TRUE(
            refuses(afterChange([&](auto& parts) { parts[0].text["gonio.schema"] = schema; }),
                    {"graw: in.graw: schema is not gonio/raw/1"}));
    }
    EXPECT_TRUE(
        refuses(afterChange([](auto& parts) { parts[0].text.erase("gonio.schema"); }), {"schema"}));
}

TEST(GrawFile, RefusesPartsWithoutAllTheirChannels) {
    for (const char* channel : {"radiance", "variance"}) {
        EXPECT_TRUE(refuses(afterChange([&](auto& parts) { parts[1].floats.erase(channel); }),
                            {"graw: in.graw: part 'led0.b': channels missing"}));
    }
    for (const char* channel : {"used", "saturated"}) {
        EXPECT_TRUE(refuses(afterChange([&](auto& parts) { parts[1].counts.erase(channel); }),
                            {"channels missing"}));
    }
}

TEST(GrawFile, CapsCountsAtWhatAStateHolds) {
    const auto capture =
        afterChange([](auto& parts) { parts[0].counts["used"][1] = 4'000'000'000; });
    ASSERT_TRUE(capture);
    EXPECT_EQ(capture->states[0].merged.used.pixels()[1], 255);
}

TEST(GrawFile, RefusesAStateThatIsNotOne) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return refuses(withState(from, to), {"graw: in.graw: part 'led0.r': its attributes"});
    };
    for (const char* key : {"\"led\"",
                            "\"band\"",
                            "\"window\"",
                            "\"binning\"",
                            "\"bracket\"",
                            "\"chi_square\"",
                            "\"freedom\"",
                            "\"all_saturated_pixels\"",
                            "\"level\"",
                            "\"frames\"",
                            "\"granted_ns\"",
                            "\"black_level\"",
                            "\"capture_id\"",
                            "\"celsius\""}) {
        EXPECT_TRUE(refused(key, "\"other\""));
    }
    EXPECT_TRUE(refused("{", "["));
    EXPECT_TRUE(refused("\"band\":0", "\"band\":3"));
    EXPECT_TRUE(refused("\"band\":0", "\"band\":\"b\""));
    EXPECT_TRUE(refused("\"window\":[", "\"window\":[]"));
    EXPECT_TRUE(refused("\"window\":[16,8,8,6]", "\"window\":[16,8,8]"));
}

TEST(GrawFile, RefusesNumbersThatDoNotFitWhereTheyBelong) {
    for (const char* number : {"65536", "70000", "-1", "1.5", "1e300", "true", "null", "\"1\""}) {
        EXPECT_TRUE(
            refuses(withState("\"level\":65535", "\"level\":" + std::string(number)), {"led0.r"}));
    }
    for (const char* number : {"2147483648", "-2147483649", "1e10", "18446744073709551615"}) {
        EXPECT_TRUE(
            refuses(withState("\"frames\":4", "\"frames\":" + std::string(number)), {"led0.r"}));
    }
    EXPECT_TRUE(refuses(withState("\"granted_ns\":1000123", "\"granted_ns\":9223372036854775808")));
    EXPECT_TRUE(refuses(withState("18446744073709551615", "18446744073709551616")));
    EXPECT_TRUE(refuses(withState("10.25", "1e999")));
    EXPECT_TRUE(withState("\"frames\":4", "\"frames\":2147483647"));
}

TEST(GrawFile, RefusesAStateThatIsAnotherParts) {
    EXPECT_TRUE(refuses(withState("\"led\":0", "\"led\":1")));
    EXPECT_TRUE(refuses(withState("\"band\":0", "\"band\":2")));
    EXPECT_TRUE(refuses(withState("\"binning\":2", "\"binning\":0")));
    EXPECT_TRUE(refuses(withState("\"binning\":2", "\"binning\":1")));
    EXPECT_TRUE(refuses(withState("[16,8,8,6]", "[16,8,8,8]")));
    EXPECT_TRUE(refuses(afterChange([](auto& parts) { parts[0].name = "a\nb"; }), {"'a?b'"}));
}

TEST(GrawFile, RefusesInfoThatIsNotText) {
    for (const char* info : {"", "[1]", "{\"a\":1}", "{", "null"}) {
        EXPECT_TRUE(refuses(afterChange([&](auto& parts) { parts[0].text["gonio.info"] = info; }),
                            {"graw: in.graw: "}));
    }
}

TEST(GrawFile, RefusesAFileCutAtAnyByte) {
    const std::string bytes = encoded(smallCapture());
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_TRUE(
            refuses(decodeGraw(bytes.substr(0, size), "cut.graw"), {"graw: cut.graw: exr: "}));
    }
}

TEST(GrawFile, WritesAndReadsFilesAndNamesThemInErrors) {
    const test::TempFolder folder;
    ASSERT_TRUE(writeGraw(folder / "a.graw", smallCapture()));
    const auto back = readGraw(folder / "a.graw");
    ASSERT_TRUE(back);
    EXPECT_EQ(encoded(*back), *readFile(folder / "a.graw"));
    EXPECT_TRUE(refuses(readGraw(folder / "none.graw"), {"none.graw: no such file"}));
    EXPECT_TRUE(refuses(writeGraw(folder / "no" / "a.graw", smallCapture()), {"a.graw"}));
    ASSERT_TRUE(writeFile(folder / "text.graw", "banana"));
    EXPECT_TRUE(refuses(readGraw(folder / "text.graw"), {"text.graw: exr: not an OpenEXR file"}));
    EXPECT_FALSE(writeGraw(folder / "a.graw", {}));
    EXPECT_TRUE(readGraw(folder / "a.graw"));
}

}  // namespace
}  // namespace gonio::proc
