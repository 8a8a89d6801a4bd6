#include "proc/formats/gonio_exr.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "proc/formats/exr_parts.h"
#include "proc/formats/file_bytes.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::smallSample;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr ExrLimits kLimits{.largest = {360, 90}, .parts = 16};

std::string encoded(const SampleSet& set) {
    auto bytes = encodeGonio(set);
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().message);
    return bytes ? std::move(*bytes) : "";
}

SampleSet decoded(std::string_view bytes) {
    auto set = decodeGonio(bytes, "in.gonio");
    EXPECT_TRUE(set) << (set ? "" : set.error().message);
    return set ? std::move(*set) : SampleSet{};
}

/// What decodeGonio says to a sample file whose parts were changed.
Result<SampleSet> afterChange(const std::function<void(std::vector<ExrPart>&)>& change,
                              const SampleSet& set = smallSample()) {
    auto parts = decodeExr(encoded(set), kLimits);
    EXPECT_TRUE(parts);
    change(*parts);
    return decodeGonio(*encodeExr(*parts), "in.gonio");
}

Result<SampleSet> withText(const std::string& key, const std::string& value) {
    return afterChange([&](std::vector<ExrPart>& parts) { parts[0].text[key] = value; });
}

/// Any finite float, or missing.
std::vector<double> randomCells(std::mt19937_64& random) {
    std::vector<double> cells;
    while (cells.size() < CellGrid::count()) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        cells.push_back(std::isfinite(value) ? static_cast<double>(value) : kNan);
    }
    return cells;
}

SampleSet randomSet(std::mt19937_64& random) {
    SampleSet set;
    for (const double degrees : {0.0, 1.0 / 3, 20.0, 89.999}) {
        LedTable led;
        led.incidence = Radians::fromDegrees(degrees);
        for (const Band band : kBands) {
            if (degrees > 1 && random() % 3 == 0) continue;
            CellSamples& cells = led.bands[index(band)];
            cells.f = randomCells(random);
            cells.uRandom = randomCells(random);
            cells.uSystematic = randomCells(random);
            cells.nEff = randomCells(random);
            for (std::size_t i = 0; i < CellGrid::count(); ++i) {
                cells.flags.push_back(
                    Flags::fromMask(static_cast<std::uint32_t>(random() % (1U << kFlagCount))));
            }
        }
        if (led.bands[0].size() + led.bands[1].size() + led.bands[2].size() == 0) continue;
        set.leds.push_back(std::move(led));
    }
    return set;
}

void expectSameBits(const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (std::isnan(a[i]) && std::isnan(b[i])) continue;
        ASSERT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i]));
    }
}

void expectSame(const CellSamples& a, const CellSamples& b) {
    expectSameBits(a.f, b.f);
    expectSameBits(a.uRandom, b.uRandom);
    expectSameBits(a.uSystematic, b.uSystematic);
    expectSameBits(a.nEff, b.nEff);
    EXPECT_EQ(a.flags, b.flags);
}

TEST(GonioFile, ReadsBackEveryBitOfASampleOfFloats) {
    std::mt19937_64 random(1);
    const SampleSet set = randomSet(random);
    const std::string bytes = encoded(set);
    const SampleSet back = decoded(bytes);
    ASSERT_EQ(back.leds.size(), set.leds.size());
    for (std::size_t led = 0; led < set.leds.size(); ++led) {
        EXPECT_NEAR(back.leds[led].incidence.degrees(), set.leds[led].incidence.degrees(), 0.51e-9);
        for (const Band band : kBands) {
            expectSame(back.leds[led].bands[index(band)], set.leds[led].bands[index(band)]);
        }
    }
    EXPECT_EQ(encoded(back), bytes);
}

TEST(GonioFile, RoundsToFloatOnceAndThenWritesTheSameBytes) {
    const SampleSet set = test::sampleSet(
        [](Radians i, const Direction& wo) { return (1 + 0.1 * i.value()) / (3 + wo.x()); });
    const SampleSet once = decoded(encoded(set));
    const CellSamples& cells = set.leds[2].bands[1];
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (std::isnan(cells.f[i])) continue;
        ASSERT_EQ(once.leds[2].bands[1].f[i], static_cast<double>(static_cast<float>(cells.f[i])));
    }
    EXPECT_EQ(encoded(decoded(encoded(once))), encoded(once));
}

TEST(GonioFile, ReadsBackWholeDegreesToTheBit) {
    SampleSet set = smallSample();
    for (int degrees = 0; degrees < 90; ++degrees) {
        set.leds[0].incidence = Radians::fromDegrees(degrees);
        EXPECT_EQ(decoded(encoded(set)).leds[0].incidence, Radians::fromDegrees(degrees));
    }
}

/// Files of before there were rotations have none; 0 is not written, so that they stay as they are.
TEST(GonioFile, KeepsTheRotationOfEachTableAndRefusesWhatIsNone) {
    SampleSet set = smallSample();
    EXPECT_FALSE(decodeExr(encoded(set), kLimits)->front().text.contains("gonio.rotation_deg"));
    EXPECT_EQ(decoded(encoded(set)).leds[0].rotation, Radians(0));
    set.leds.push_back(set.leds.front());
    set.leds[1].rotation = rotationOf(-45);
    EXPECT_EQ(decoded(encoded(set)).leds[1].rotation, rotationOf(315));
    EXPECT_EQ(decoded(encoded(set)).leds[0].rotation, Radians(0));
    for (const char* none : {"-45", "360", "north", "nan"}) {
        EXPECT_TRUE(refuses(withText("gonio.rotation_deg", none), {"led0.g", "rotation_deg"}))
            << none;
    }
    EXPECT_TRUE(
        refuses(withText("gonio.wavelength_nm", "530"), {"led0.g", "wavelength_nm", "525"}));
    set.leds.resize(kMostTables + 1, set.leds[1]);
    EXPECT_FALSE(encodeGonio(set));
}

TEST(GonioFile, KeepsEverythingAboutTheSample) {
    SampleSet set = smallSample();
    set.info = {.name = "tile \xc3\xa9 \"7\"\nsecond line",
                .rigSerial = "R1",
                .profileHash = "ab12",
                .calibrationId = "C1",
                .session = "S1",
                .dateUtc = "2025-01-01T00:00:00Z",
                .operatorNotes = "",
                .softwareVersion = "0.1.0",
                .effort = "standard",
                .referenceCertificate = "RC",
                .qcVerdicts = "[]",
                .truthSpec = "lambert,albedo=0.3",
                .budgetJson = std::string(200'000, '{'),
                .rigSeconds = 1.0 / 3,
                .computeSeconds = 1e-300,
                .requestedUncertainty = 0.01,
                .achievedUncertainty = std::nullopt,
                .interruptions = 3,
                .extra = {{"", ""}, {"key", "a\tb"}, {"\xce\xb8", "\"\\"}}};
    EXPECT_EQ(decoded(encoded(set)).info, set.info);
    set.info.requestedUncertainty.reset();
    set.info.achievedUncertainty = 0.02;
    EXPECT_EQ(decoded(encoded(set)).info, set.info);
}

TEST(GonioFile, LeavesOutNumbersOfTheInfoThatAreNotFinite) {
    SampleSet set = smallSample();
    set.info.rigSeconds = kNan;
    set.info.achievedUncertainty = kInf;
    const SampleSet back = decoded(encoded(set));
    EXPECT_EQ(back.info.rigSeconds, 0);
    EXPECT_EQ(back.info.achievedUncertainty, std::nullopt);
}

TEST(GonioFile, ShowsAtEachPixelTheCellThatHoldsItsMiddle) {
    SampleSet set = smallSample();
    CellSamples& cells = set.leds[0].bands[index(Band::G)];
    for (std::size_t i = 0; i < cells.size(); ++i) cells.f[i] = static_cast<double>(i);
    const auto parts = decodeExr(encoded(set), kLimits);
    ASSERT_TRUE(parts);
    EXPECT_EQ(parts->at(0).name, "led0.g");
    EXPECT_EQ(parts->at(0).text.at("gonio.incidence_deg"), "20");
    EXPECT_EQ(parts->at(0).text.at("gonio.wavelength_nm"), "525");
    constexpr double kMiddle = 0.5 + 1e-9;  // where two cells meet at the middle: the upper one
    for (int y = 0; y < 90; ++y) {
        for (int x = 0; x < 360; ++x) {
            const auto cell = CellGrid::cellAt(Direction::fromSpherical(
                Radians::fromDegrees(y + 0.5), Radians::fromDegrees(x + kMiddle)));
            ASSERT_TRUE(cell);
            const auto pixel = static_cast<std::size_t>(360 * y + x);
            ASSERT_EQ(parts->at(0).floats.at("f")[pixel], static_cast<float>(*cell));
            ASSERT_EQ(parts->at(0).counts.at("cell_id")[pixel], *cell);
        }
    }
}

TEST(GonioFile, RefusesToBeWrittenAsItCouldNotBeRead) {
    const auto refused = [](const std::function<void(SampleSet&)>& change) {
        SampleSet set = smallSample();
        change(set);
        const auto bytes = encodeGonio(set);
        return !bytes && bytes.error().kind == ErrorKind::Internal;
    };
    const auto g = [](SampleSet& set) -> CellSamples& { return set.leds[0].bands[1]; };
    EXPECT_TRUE(refused([](SampleSet& set) { set.leds.clear(); }));
    EXPECT_TRUE(refused([](SampleSet& set) { set.leds.emplace_back(); }));
    EXPECT_TRUE(refused([&](SampleSet& set) { g(set).f.pop_back(); }));
    EXPECT_TRUE(refused([&](SampleSet& set) { g(set).nEff.pop_back(); }));
    EXPECT_TRUE(refused([&](SampleSet& set) { g(set).flags.emplace_back(); }));
    EXPECT_TRUE(refused([&](SampleSet& set) { g(set).f[7] = kInf; }));
    EXPECT_TRUE(refused([&](SampleSet& set) { g(set).uRandom[7] = -kInf; }));
    EXPECT_TRUE(refused([&](SampleSet& set) { g(set).f[7] = 1e39; }));  // above the largest float
    EXPECT_FALSE(refused([&](SampleSet& set) { g(set).f[7] = 3e38; }));
    EXPECT_FALSE(refused([&](SampleSet& set) { g(set).f[7] = kNan; }));
}

TEST(GonioFile, RefusesAnotherSchema) {
    for (const char* schema : {"", "gonio/sample/2", "gonio/raw/1", "line\nend"}) {
        EXPECT_TRUE(refuses(withText("gonio.schema", schema),
                            {"gonio: in.gonio: schema '", "wanted gonio/sample/1"}));
    }
    EXPECT_TRUE(refuses(afterChange([](auto& parts) { parts[0].text.erase("gonio.schema"); }),
                        {"schema ''"}));
}

TEST(GonioFile, RefusesPartsWithoutAllTheirChannels) {
    for (const char* channel : {"f", "u_random", "u_systematic", "n_eff"}) {
        const auto without = [&](auto& parts) { parts[0].floats.erase(channel); };
        EXPECT_TRUE(refuses(afterChange(without),
                            {"part led0.g: no float channel " + std::string(channel)}));
    }
    EXPECT_TRUE(refuses(afterChange([](auto& parts) { parts[0].counts.erase("flags"); }),
                        {"part led0.g: no UINT channel flags"}));
    EXPECT_TRUE(refuses(afterChange([](auto& parts) { parts[0].counts.erase("cell_id"); }),
                        {"part led0.g: cell_id"}));
}

TEST(GonioFile, RefusesUnknownFlagsInfiniteValuesAndAnotherGrid) {
    for (unsigned bit = 0; bit < 32; ++bit) {
        const auto set =
            afterChange([&](auto& parts) { parts[0].counts["flags"][99] = 1U << bit; });
        EXPECT_EQ(set.has_value(), bit < static_cast<unsigned>(kFlagCount));
        EXPECT_TRUE(set || refuses(set, {"part led0.g: unknown bits in flags"}));
    }
    for (const char* channel : {"f", "u_random", "u_systematic", "n_eff"}) {
        for (const float value : {HUGE_VALF, -HUGE_VALF}) {
            const auto set = afterChange([&](auto& p) { p[0].floats[channel].back() = value; });
            EXPECT_TRUE(refuses(set, {"an infinite value in " + std::string(channel)}));
        }
    }
    EXPECT_TRUE(refuses(afterChange([](auto& parts) { ++parts[0].counts["cell_id"][0]; }),
                        {"cell_id is not the grid"}));
    const auto small = [](auto& parts) {
        parts[0].size = {180, 90};
        for (auto& channel : parts[0].floats) channel.second.resize(180 * 90);
        for (auto& channel : parts[0].counts) channel.second.resize(180 * 90);
    };
    EXPECT_TRUE(refuses(afterChange(small), {"part led0.g: not 360 x 90"}));
}

TEST(GonioFile, RefusesAPictureLargerThanTheGrid) {
    const auto large = [](auto& parts) {
        parts[0].size = {360, 91};
        for (auto& channel : parts[0].floats) channel.second.resize(360 * 91);
        for (auto& channel : parts[0].counts) channel.second.resize(360 * 91);
    };
    EXPECT_TRUE(refuses(afterChange(large), {"gonio: in.gonio: exr: picture size", "360 x 90"}));
}

TEST(GonioFile, RefusesMissingOrForeignParts) {
    EXPECT_TRUE(refuses(afterChange([](auto& parts) { parts[0].name = "led1.g"; }),
                        {"there is no led0.r, .g or .b"}));
    EXPECT_TRUE(refuses(afterChange([](auto& parts) { parts[0].name = "led0.x"; }), {"no led0"}));
    const auto foreign = [](auto& parts) {
        parts.push_back(parts[0]);
        parts[1].name = "thumbnail";
    };
    EXPECT_TRUE(refuses(afterChange(foreign), {"there is no led1"}));
}

TEST(GonioFile, RefusesIncidencesThatAreNoneOrDiffer) {
    for (const char* degrees : {"banana", "", "nan", "-1", "90", "1e9"}) {
        EXPECT_TRUE(refuses(withText("gonio.incidence_deg", degrees),
                            {"part led0.g: gonio.incidence_deg is not in [0, 90)"}));
    }
    const auto differ = [](auto& parts) {
        parts.push_back(parts[0]);
        parts[1].name = "led0.b";
        parts[1].text["gonio.incidence_deg"] = "21";
    };
    EXPECT_TRUE(refuses(afterChange(differ), {"part led0.b: another incidence"}));
}

TEST(GonioFile, RefusesAttributesThatAreNotWhatTheyShouldBe) {
    for (const char* key : {"gonio.rig_seconds",
                            "gonio.compute_seconds",
                            "gonio.requested_uncertainty",
                            "gonio.achieved_uncertainty"}) {
        for (const char* value : {"banana", "nan", "inf", "1,5"}) {
            EXPECT_TRUE(refuses(withText(key, value), {std::string(key) + " is not a number"}));
        }
    }
    for (const char* value : {"-1", "1.5", "banana", "1000001", "99999999999999999999"}) {
        EXPECT_TRUE(refuses(withText("gonio.interruptions", value), {"is not a count"}));
    }
    for (const char* value : {"", "[]", "{", "{\"a\":1}", "null"}) {
        EXPECT_TRUE(refuses(withText("gonio.extra", value), {"attribute gonio.extra"}));
    }
    EXPECT_TRUE(refuses(withText("gonio.extra", std::string(100'000, '[')), {"gonio.extra"}));
}

TEST(GonioFile, RefusesAFileCutAnywhere) {
    const std::string bytes = encoded(smallSample());
    const std::size_t header = 2000;  // every byte here, every 97th in the pixels
    for (std::size_t size = 0; size < bytes.size(); size += size < header ? 1 : 97) {
        EXPECT_TRUE(
            refuses(decodeGonio(bytes.substr(0, size), "cut.gonio"), {"gonio: cut.gonio: exr: "}));
    }
    EXPECT_TRUE(refuses(decodeGonio(bytes.substr(0, bytes.size() - 1), "cut.gonio")));
}

TEST(GonioFile, WritesAndReadsFilesAndNamesThemInErrors) {
    const test::TempFolder folder;
    ASSERT_TRUE(writeGonio(folder / "a.gonio", smallSample()));
    const auto back = readGonio(folder / "a.gonio");
    ASSERT_TRUE(back);
    EXPECT_EQ(encoded(*back), *readFile(folder / "a.gonio"));
    EXPECT_TRUE(refuses(readGonio(folder / "none.gonio"), {"none.gonio: no such file"}));
    EXPECT_TRUE(refuses(writeGonio(folder / "no" / "a.gonio", smallSample()), {"a.gonio"}));
    ASSERT_TRUE(writeFile(folder / "text.gonio", "banana"));
    EXPECT_TRUE(refuses(readGonio(folder / "text.gonio"),
                        {"gonio: ", "text.gonio: exr: not an OpenEXR file"}));
    SampleSet broken = smallSample();
    broken.leds.clear();
    EXPECT_FALSE(writeGonio(folder / "a.gonio", broken));
    EXPECT_TRUE(readGonio(folder / "a.gonio"));
}

TEST(GonioFile, RefusesASmallFileThatWouldFillTheMemory) {
    // One part with 300 channels of zeros: some 100 kB that unfold to 39 MB.
    ExrPart part;
    part.name = "led0.r";
    part.size = {360, 90};
    for (int i = 0; i < 300; ++i) {
        part.floats["c" + std::to_string(i)].resize(part.size.pixels());
    }
    const auto bytes = encodeExr(std::span(&part, 1));
    ASSERT_TRUE(bytes);
    EXPECT_LT(bytes->size(), 1'000'000U);
    EXPECT_TRUE(refuses(decodeGonio(*bytes, "bomb.gonio"), {"bomb.gonio", "bytes of pixels"}));
}

}  // namespace
}  // namespace gonio::proc
