#include "daemon/exports.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "proc/estimate/sample_estimator.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/zemax.h"
#include "tests/formats/small_files.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

constexpr ExportFormat kFormats[] = {ExportFormat::Gonio, ExportFormat::Zemax, ExportFormat::Csv};

/// A measured sample of three bands, a model and a Zemax file.
class Exports : public testing::Test {
protected:
    static Material opened(const std::string& f) {
        auto material = openMaterial(f, {});
        EXPECT_TRUE(material) << material.error().message;
        return material ? std::move(*material) : Material{};
    }
    Material sample() {
        auto set = test::sampleSet([](Radians, const Direction& wo) { return 0.1 + 0.1 * wo.z(); });
        set.leds.resize(1);  // one page of the table: the test is not about size
        EXPECT_TRUE(proc::writeGonio(folder / "tile.gonio", set));
        return opened((folder / "tile.gonio").string());
    }
    static Material zemax() {
        return opened(GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf");
    }
    test::TempFolder folder;
};

TEST(ExportFormat, ComesBackFromItsNameAndItsExtension) {
    for (const ExportFormat format : kFormats) {
        EXPECT_EQ(*parseExportFormat(name(format)), format);
        EXPECT_EQ(formatOfExtension(extension(format)), format);
    }
}

TEST(ExportFormat, UnknownNameListsWhatIsKnown) {
    for (const char* text : {"", "Zemax", "exr", "csv "}) {
        const auto format = parseExportFormat(text);
        ASSERT_FALSE(format) << text;
        EXPECT_EQ(format.error().kind, ErrorKind::Usage);
        EXPECT_NE(format.error().message.find("gonio, zemax or csv"), std::string::npos);
    }
    EXPECT_FALSE(formatOfExtension(""));
    EXPECT_FALSE(formatOfExtension(".txt"));
}

TEST_F(Exports, SampleBecomesItselfAgain) {
    const Material surface = sample();
    const auto files = exportAs(surface, ExportFormat::Gonio);
    ASSERT_TRUE(files) << files.error().message;
    ASSERT_EQ(files->size(), 1U);
    EXPECT_EQ(files->front().suffix, "");
    EXPECT_TRUE(files->front().loss.items.empty());
    const auto back = proc::decodeGonio(files->front().bytes, "out");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->leds.size(), 1U);
    EXPECT_EQ(back->info.name, "test tile");
}

TEST_F(Exports, SampleBecomesOneTable) {
    const auto files = exportAs(sample(), ExportFormat::Csv);
    ASSERT_TRUE(files) << files.error().message;
    ASSERT_EQ(files->size(), 1U);
    EXPECT_NE(files->front().bytes.find("theta_i,phi_i,theta_o,phi_o"), std::string::npos);
}

TEST_F(Exports, ZemaxTakesAFileForEachBandAndSaysWhatIsLost) {
    const Material surface = sample();
    const auto files = exportAs(surface, ExportFormat::Zemax);
    ASSERT_TRUE(files) << files.error().message;
    ASSERT_EQ(files->size(), 3U);
    const char* suffixes[] = {"_R", "_G", "_B"};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ((*files)[i].suffix, suffixes[i]);
        const auto back = proc::parseZemax((*files)[i].bytes, "out");
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->incidenceDeg.size(), 1U);
        const auto& lost = (*files)[i].loss.items;
        EXPECT_TRUE(std::any_of(lost.begin(), lost.end(), [](const auto& item) {
            return item.what == "uncertainties left out" && item.count > 0;
        }));
    }
    // The bands of the sample are 1 : 2 : 3, and so are the tables, to the digits of the file.
    const auto red = proc::parseZemax((*files)[0].bytes, "r");
    const auto blue = proc::parseZemax((*files)[2].bytes, "b");
    ASSERT_TRUE(red && blue);
    ASSERT_GT(red->planes[0].f[40], 0);
    EXPECT_NEAR(blue->planes[0].f[40] / red->planes[0].f[40], 3, 1e-4);

    const auto one = exportAs(surface, ExportFormat::Zemax, Band::G);
    ASSERT_TRUE(one) << one.error().message;
    ASSERT_EQ(one->size(), 1U);
    EXPECT_EQ(one->front().bytes, (*files)[1].bytes);
}

TEST_F(Exports, AnEstimatorAnswersTheNodesThatWereNotMeasured) {
    const Material surface = sample();
    const auto estimator = proc::SampleEstimator::over(
        *surface.sample, {.method = "specular-log", .effort = Effort::Draft});
    ASSERT_TRUE(estimator) << estimator.error().message;
    const auto lost = [](const ExportedFile& file, const std::string& what) {
        for (const auto& item : file.loss.items) {
            if (item.what == what) return item.count;
        }
        return std::size_t{0};
    };
    const std::string unanswered = "nodes without an answer, written as 0";
    const std::string extrapolated = "answers beyond what was measured, extrapolated";
    const auto plain = exportAs(surface, ExportFormat::Zemax, Band::R);
    ASSERT_TRUE(plain);
    EXPECT_GT(lost(plain->front(), unanswered), 0U);
    EXPECT_EQ(lost(plain->front(), extrapolated), 0U);
    const auto filled = exportFilled(surface, **estimator);
    ASSERT_EQ(filled.size(), 3U);
    EXPECT_EQ(lost(filled[0], unanswered), 0U);
    EXPECT_EQ(lost(filled[0], extrapolated), lost(plain->front(), unanswered));
    const auto table = proc::parseZemax(filled[0].bytes, "filled");
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_GT(table->planes[0].tis[0],
              proc::parseZemax(plain->front().bytes, "x")->planes[0].tis[0]);
}

TEST_F(Exports, ZemaxFileIsWrittenAsItIs) {
    const Material surface = zemax();
    const auto files = exportAs(surface, ExportFormat::Zemax);
    ASSERT_TRUE(files) << files.error().message;
    ASSERT_EQ(files->size(), 1U);
    EXPECT_EQ(files->front().suffix, "");
    EXPECT_TRUE(files->front().loss.items.empty());
    EXPECT_EQ(files->front().bytes, proc::writeZemax(*surface.table).bytes);
}

TEST_F(Exports, OnlyAMeasuredSampleBecomesGonioOrCsv) {
    for (const Material& surface : {zemax(), opened("model:lambert,albedo=0.5")}) {
        for (const ExportFormat format : {ExportFormat::Gonio, ExportFormat::Csv}) {
            const auto files = exportAs(surface, format);
            ASSERT_FALSE(files);
            EXPECT_EQ(files.error().kind, ErrorKind::Usage);
            EXPECT_NE(files.error().message.find(surface.kind), std::string::npos);
            EXPECT_NE(files.error().message.find(name(format)), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace gonio::daemon
