// Every format, from a measured sample and back to one: what comes back is what the report says.

#include "proc/export/conversion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "proc/export/one_band.h"
#include "proc/export/source_of.h"
#include "proc/formats/open.h"
#include "proc/models/spec.h"
#include "proc/quality/file_facts.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

std::shared_ptr<const Scatterer> model(const std::string& spec) {
    auto made = makeModel(spec);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::shared_ptr<const Scatterer>(std::move(*made)) : nullptr;
}

/// Glossy, coloured, measured to 75 degrees at the LEDs' incidences, with uncertainties.
SampleSet measured() {
    const auto surface = model("lambert,albedo=0.3+ggx,alpha=0.25,f0=0.2");
    SampleSet set = test::sampleSet([&](Radians incidence, const Direction& wo) {
        return surface->answer({Direction::fromSpherical(incidence, {}), wo}).f[Band::R];
    });
    set.info.rigSerial = "MD2-0007";
    set.info.calibrationId = "10+11";
    set.info.referenceCertificate = "tile 99 of 2026";
    set.info.softwareVersion = "gonio 0.1.0";
    return set;
}

ConversionSource sourceOfSample() {
    SampleSet set = measured();
    Metadata about = metadataOf(set.info);
    auto source = sourceOf(BrdfFile{.content = std::move(set), .about = std::move(about)}, {});
    EXPECT_TRUE(source);
    return std::move(*source);
}

std::vector<ConvertedFile> converted(const ConversionSource& source, Format to) {
    auto files = convertTo(source, {.to = to});
    EXPECT_TRUE(files) << name(to) << ": " << (files ? "" : files.error().message);
    return files ? std::move(*files) : std::vector<ConvertedFile>{};
}

BrdfFile readBack(const ConvertedFile& file, Format format) {
    auto back = decodeBrdf(format, file.bytes, "back" + file.suffix);
    EXPECT_TRUE(back) << name(format) << ": " << (back ? "" : back.error().message);
    return back ? std::move(*back) : BrdfFile{};
}

const LossReport::Item* lossOf(const ConvertedFile& file, Loss kind, const std::string& what) {
    for (const LossReport::Item& item : file.loss.items) {
        if (item.kind == kind && item.what.find(what) != std::string::npos) return &item;
    }
    return nullptr;
}

struct RoundTrip {
    Format format;
    double weighted;  ///< error of .gonio -> format -> .gonio, sum of |df| cos over that of f cos
    double missing;   ///< share of measured values that do not come back
    bool metadata;    ///< all of them come back
};

/// Errors are those of a bilinear grid of the format's own steps over a lobe 14 degrees wide: UTIA
/// has 15 degrees; MERL cells are asked between incidences 20 degrees apart.
constexpr RoundTrip kTrips[] = {
    {Format::Gonio, 0, 0, true},
    {Format::Zemax, 2e-3, 0.03, true},
    {Format::LightTools, 2e-3, 0.03, true},
    {Format::Merl, 0.05, 0.45, false},
    {Format::Utia, 0.25, 0.08, false},
    {Format::Rgl, 0.01, 0, true},
    {Format::Bird, 1e-9, 0, true},
    {Format::Astm, 1e-9, 0, true},
    {Format::Speos, 2e-3, 0.03, true},
    {Format::Mbsdf, 0.03, 0.4, true},
    {Format::Ssdd, 2e-3, 0.03, true},
    {Format::Alta, 1e-9, 0, true},
    {Format::Csv, 0, 0, true},
    {Format::ExrTiles, 5e-3, 0.03, true},
};

class EveryFormat : public testing::TestWithParam<RoundTrip> {};

/// The bands of what was written, in as many files as the format takes.
SampleSet gonioAgain(const std::vector<ConvertedFile>& files, Format format) {
    SampleSet together;
    for (const ConvertedFile& file : files) {
        BandChoice choice;
        for (const Band band : kBands) {
            if (file.suffix == bandSuffix(band)) choice.bands = {band};
        }
        auto source = sourceOf(readBack(file, format), choice);
        EXPECT_TRUE(source) << (source ? "" : source.error().message);
        if (!source) return together;
        source->incidenceDeg = {0, 20, 40, 60};
        const auto gonio = converted(*source, Format::Gonio);
        if (gonio.empty()) return together;
        BrdfFile again = readBack(gonio.front(), Format::Gonio);
        SampleSet set = std::get<SampleSet>(std::move(again.content));
        if (together.leds.empty()) {
            together = std::move(set);
            continue;
        }
        for (std::size_t led = 0; led < set.leds.size(); ++led) {
            for (const Band band : choice.bands) {
                together.leds[led].bands[index(band)] = std::move(set.leds[led].bands[index(band)]);
            }
        }
    }
    return together;
}

TEST_P(EveryFormat, MakesTheRoundTripThroughGonio) {
    const RoundTrip& trip = GetParam();
    const ConversionSource source = sourceOfSample();
    const SampleSet& before = *source.file->as<SampleSet>();
    const SampleSet after = gonioAgain(converted(source, trip.format), trip.format);
    // UTIA's tables are of several azimuths of the light: the first ones are of azimuth 0.
    ASSERT_TRUE(after.leds.size() == before.leds.size() || trip.format == Format::Utia);
    ASSERT_GE(after.leds.size(), before.leds.size());
    double apart = 0;
    double all = 0;
    std::size_t measuredValues = 0;
    std::size_t missing = 0;
    std::size_t made = 0;
    for (std::size_t led = 0; led < before.leds.size(); ++led) {
        EXPECT_NEAR(
            after.leds[led].incidence.degrees(), before.leds[led].incidence.degrees(), 1e-9);
        for (const Band band : kBands) {
            const CellSamples& was = before.leds[led].bands[index(band)];
            const CellSamples& is = after.leds[led].bands[index(band)];
            ASSERT_EQ(is.size(), was.size()) << letter(band);
            for (std::size_t cell = 0; cell < was.size(); ++cell) {
                if (!was.present(cell)) {
                    made += is.present(cell) ? 1U : 0U;
                    continue;
                }
                ++measuredValues;
                if (!is.present(cell)) {
                    ++missing;
                    continue;
                }
                const double cosine = CellGrid::centre(cell).z();
                apart += std::abs(is.f[cell] - was.f[cell]) * cosine;
                all += was.f[cell] * cosine;
            }
        }
    }
    EXPECT_LE(apart / all, trip.weighted + 1e-7);  // .gonio holds floats
    EXPECT_LE(static_cast<double>(missing), trip.missing * static_cast<double>(measuredValues));
    const bool rgl = trip.format == Format::Rgl;  // has no place for a missing value: it says so
    EXPECT_TRUE(rgl || made == 0) << made << " values where none was measured";
    RecordProperty("weighted", std::to_string(apart / all));
    RecordProperty("missing", std::to_string(missing));
    const Metadata was = metadataOf(before.info);
    const Metadata is = metadataOf(after.info);
    for (const auto& [key, value] : was.values) {
        EXPECT_EQ(is.at(key) == value, trip.metadata) << key << ": " << is.at(key);
    }
}

TEST_P(EveryFormat, TellsWhatItCannotHold) {
    const Format format = GetParam().format;
    const ConversionSource source = sourceOfSample();
    const auto files = converted(source, format);
    ASSERT_FALSE(files.empty());
    const bool holdsAll =
        format == Format::Gonio || format == Format::Csv || format == Format::Bird;
    const bool told = std::any_of(files.begin(), files.end(), [](const ConvertedFile& file) {
        return lossOf(file, Loss::Dropped, "uncertainties") != nullptr;
    });
    EXPECT_NE(told, holdsAll) << name(format);
    if (!GetParam().metadata) {
        EXPECT_NE(lossOf(files.front(), Loss::Dropped, "metadata"), nullptr);
    }
}

/// What was written is written again to the same bytes, metadata and all.
TEST_P(EveryFormat, IsStableFromTheFirstWritingOn) {
    const Format format = GetParam().format;
    for (const ConvertedFile& file : converted(sourceOfSample(), format)) {
        auto source = sourceOf(readBack(file, format), {});
        ASSERT_TRUE(source);
        const auto again = converted(*source, format);
        ASSERT_EQ(again.size(), 1U);
        EXPECT_TRUE(again.front().bytes == file.bytes) << name(format) << file.suffix;
    }
}

/// Totals of a Lambertian as the file's own values have them: to 1e-4 where they cover the
/// hemisphere. Steps of 15 degrees (UTIA) and the square of an RGL file do not integrate as well.
TEST_P(EveryFormat, KeepsTheTotalOfALambertian) {
    const Format format = GetParam().format;
    const ConversionSource source = sourceOf(model("lambert,albedo=0.5"), {});
    std::vector<ConvertedFile> files;
    if (format == Format::Gonio) {
        auto rows = sourceOf(readBack(converted(source, Format::Csv).front(), Format::Csv),
                             {.bands = {Band::G}});
        ASSERT_TRUE(rows);
        files = converted(*rows, format);
    } else {
        files = converted(source, format);
    }
    ASSERT_FALSE(files.empty());
    BrdfFile file = readBack(files.front(), format);
    if (file.as<BrdfRows>() != nullptr) {
        file.band = Band::G;
        auto rows = sourceOf(std::move(file), {});
        ASSERT_TRUE(rows);
        file = readBack(converted(*rows, Format::Gonio).front(), Format::Gonio);
    }
    double tolerance = 1e-4;
    if (format == Format::Zemax) tolerance = 1.5e-4;  // panes of a degree at the horizon
    if (format == Format::Utia) tolerance = 0.08;     // no value beyond 75 degrees
    if (format == Format::Rgl) tolerance = 2e-3;
    if (format == Format::Mbsdf) tolerance = 3e-4;  // cells' centres end at 89.5 degrees
    if (format == Format::Merl) tolerance = 5e-2;   // theta_diff ends at 89, edges are missing
    const FileFacts facts = fileFacts(file);
    ASSERT_FALSE(facts.totals.empty()) << name(format);
    for (const TotalFacts& total : facts.totals) {
        EXPECT_NEAR(total.recomputed, 0.5, 0.5 * tolerance)
            << name(format) << ", incidence " << total.incidenceDeg;
        EXPECT_NEAR(total.stated.value_or(0.5), 0.5, 0.5 * 1e-4) << name(format);
    }
}

std::string nameOf(const testing::TestParamInfo<RoundTrip>& info) {
    std::string text(name(info.param.format));
    std::erase(text, '-');
    return text;
}
INSTANTIATE_TEST_SUITE_P(Of, EveryFormat, testing::ValuesIn(kTrips), nameOf);

TEST(Conversion, AsksWhichBandOneValueIs) {
    const ConversionSource source =
        sourceOf(std::make_shared<OneBand>(model("lambert,albedo=0.5"), Band::G), {});
    const auto refused = convertTo(source, {.to = Format::Gonio});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    EXPECT_NE(refused.error().message.find("--bands"), std::string::npos);
}

TEST(Conversion, RefusesAGridOfScatteredValuesWithTheOptionThatHelps) {
    const auto csv = converted(sourceOfSample(), Format::Csv);
    auto rows = sourceOf(readBack(csv.front(), Format::Csv), {});
    ASSERT_TRUE(rows);
    for (const Format format : {Format::Zemax, Format::Merl, Format::Rgl, Format::LightTools}) {
        const auto refused = convertTo(*rows, {.to = format});
        ASSERT_FALSE(refused) << name(format);
        EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
        EXPECT_NE(refused.error().message.find("--estimator auto"), std::string::npos);
    }
}

TEST(Conversion, IsRefusedToFormatsThatAreOnlyRead) {
    for (const FormatFacts& facts : formats()) {
        if (facts.writes) continue;
        const auto refused = convertTo(sourceOfSample(), {.to = facts.format});
        ASSERT_FALSE(refused) << facts.name;
        EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    }
}

TEST(Conversion, AsksAtTheGridThatIsWanted) {
    const ConversionSource source = sourceOf(model("ggx,alpha=0.3,f0=0.5"), {});
    const auto grid = parseTargetGrid("0:15:75/5");
    ASSERT_TRUE(grid);
    const auto files = convertTo(source, {.to = Format::Zemax, .grid = *grid});
    ASSERT_TRUE(files);
    const BrdfFile file = readBack(files->front(), Format::Zemax);
    const auto* table = file.as<SpecularTable>();
    ASSERT_NE(table, nullptr);
    EXPECT_EQ(table->incidenceDeg, (std::vector<double>{0, 15, 30, 45, 60, 75}));
    EXPECT_EQ(table->radialDeg.size(), 37U);
    for (const char* bad : {"", "90", "20,10", "0:0:10", "1:2", "/0", "/31", "a", "0,20/x"}) {
        EXPECT_FALSE(parseTargetGrid(bad)) << bad;
    }
}

TEST(Conversion, RefusesRowsOfWhichNoneIsWhole) {
    BrdfRows rows;
    rows.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}};
    const Direction up = Direction::fromSpherical({}, {});
    rows.pairs = {{.in = up, .out = up}};
    rows.f = {1, std::nan(""), 1};
    const auto source = sourceOf(BrdfFile{.format = Format::Csv, .content = rows}, {});
    ASSERT_TRUE(source);
    for (const Format to : {Format::Astm, Format::Alta, Format::Pab}) {
        const auto files = convertTo(*source, {.to = to});
        ASSERT_FALSE(files) << name(to);
        EXPECT_EQ(files.error().kind, ErrorKind::Usage);
        EXPECT_NE(files.error().message.find("no direction has a value"), std::string::npos);
    }
    EXPECT_TRUE(convertTo(*source, {.to = Format::Csv}));
}

/// By way of a sample, whose own members are not the only ones that come back.
TEST(Conversion, KeepsWhatABirdFileSaysThroughGonio) {
    ConversionSource source = sourceOfSample();
    Metadata said;
    said.set(key::kSolidAngle, "0.0012");
    said.set("bird.method", "goniometer");
    said.set("bird.description", "a tile");
    said.set("bird.instrumentation.name", "the big one");
    said.set(key::kRig, "MD2-0007");
    source.about = said;
    const auto bird = converted(source, Format::Bird);
    ASSERT_EQ(bird.size(), 1U);
    auto first = sourceOf(readBack(bird.front(), Format::Bird), {});
    ASSERT_TRUE(first);
    const auto gonio = converted(*first, Format::Gonio);
    ASSERT_EQ(gonio.size(), 1U);
    auto second = sourceOf(readBack(gonio.front(), Format::Gonio), {});
    ASSERT_TRUE(second);
    const auto again = converted(*second, Format::Bird);
    ASSERT_EQ(again.size(), 1U);
    EXPECT_NE(again.front().bytes.find("\"solid_angle\": {\"value\": 0.0012"), std::string::npos);
    EXPECT_NE(again.front().bytes.find("\"method\": \"goniometer\""), std::string::npos);
    const Metadata back = readBack(again.front(), Format::Bird).about;
    for (const auto& [key, value] : said.values) EXPECT_EQ(back.at(key), value) << key;
}

}  // namespace
}  // namespace gonio::proc
