#include "proc/report/sample_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/core/number_text.h"
#include "proc/estimate/sample_albedo.h"
#include "proc/quality/verdict.h"
#include "proc/report/report_words.h"
#include "tests/report/html.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

using test::readHtml;
using test::wordsOf;
using test::Xml;

const std::string kHostile = "<script>alert(1)</script> & \"tile\" \xC3\xA9";

/// Lambert with a lobe.
double surface(Radians incidence, const Direction& wo) {
    const Direction mirror = Direction::fromSpherical(incidence, Radians(kPi));
    return 0.1 + std::exp(-40 * (1 - mirror.vector().dot(wo.vector())));
}

SampleSet tile() {
    SampleSet set = test::sampleSet(surface);
    set.info.dateUtc = "2026-01-02T03:04:05Z";
    set.info.rigSerial = "SIM-0007";
    set.info.calibrationId = "1+2+3";
    set.info.extra = {{"chi_square_per_freedom", "1.0228026802"}, {"seed", "7"}};
    set.info.budgetJson =
        R"([{"led":0,"band":"r","monte_carlo_cells":12,"components":[)"
        R"({"name":"white reference, common","type":"B","correlation":"common",)"
        R"("median_relative":0.006,"size":0.005,"unit":"relative","freedom":null},)"
        R"({"name":"direction of the cell","type":"A","correlation":"per state",)"
        R"("median_relative":0.008,"size":0.004,"unit":"degree","freedom":10}]},)"
        R"({"led":0,"band":"g","components":[{"name":"white reference, common","type":"B",)"
        R"("correlation":"common","median_relative":0.006,"size":0.005,"unit":"relative"}]}])";
    const std::vector<Verdict> verdicts{
        {.name = "tilt",
         .grade = Grade::Warned,
         .figure = Figure{.value = 1.52, .u = 0.011, .unit = "degrees", .limit = 1},
         .evidence = "the sample is tilted",
         .next = "seat it again"}};
    set.info.qcVerdicts = verdictsText(verdicts);
    return set;
}

ReportOrigin origin() {
    return {.file = "tile.gonio",
            .digest = "ab12",
            .madeUtc = "2026-02-03T04:05:06Z",
            .madeBy = "gonio 1",
            .operatorName = "Ada",
            .calibrations = {{.kind = "white",
                              .number = 3,
                              .dateUtc = "2026-01-01T00:00:00Z",
                              .ageHours = 27.07,
                              .celsius = 26.25,
                              .profileHash = "other"}},
            .noCalibrations = ""};
}

ReportEstimates nothing() { return {.noEstimator = "nothing between", .noFits = "nothing fitted"}; }

std::string reportOf(SampleSet set) { return sampleReport(std::move(set), origin(), nothing()); }

/// The cells of the table row that this heads.
std::vector<std::string> rowOf(const Xml& xml, const std::string& head) {
    std::vector<std::string> cells;
    bool within = false;
    for (const test::XmlElement& element : xml.elements) {
        if (element.name == "th") within = element.text == head;
        if (element.name == "td" && within) cells.push_back(element.text);
    }
    return cells;
}

TEST(SampleReport, SaysWhatTheFileSays) {
    const SampleSet set = tile();
    const Xml xml = readHtml(reportOf(set));
    EXPECT_EQ(xml.all("title").at(0).text, "BRDF of test tile");
    EXPECT_EQ(rowOf(xml, "measured (UTC)"), std::vector<std::string>{"2026-01-02T03:04:05Z"});
    EXPECT_EQ(rowOf(xml, "SHA-256 of the file"), std::vector<std::string>{"ab12"});
    EXPECT_EQ(rowOf(xml, "operator"), std::vector<std::string>{"Ada"});
    EXPECT_EQ(rowOf(xml, "view"),
              std::vector<std::string>{"to 75 deg from the normal, all azimuths"});
    EXPECT_EQ(rowOf(xml, "checks"), std::vector<std::string>{"1 warned"});
    EXPECT_EQ(rowOf(xml, "chi_square_per_freedom"), std::vector<std::string>{"1.023"});
    EXPECT_EQ(
        rowOf(xml, "white"),
        (std::vector<std::string>{"3", "2026-01-01T00:00:00Z", "27.1 h", "26.2 degC", "other"}));
    EXPECT_EQ(rowOf(xml, "tilt"),
              (std::vector<std::string>{"warned",
                                        "(1.520 \xC2\xB1 0.022) degrees",
                                        "1.00 degrees",
                                        "the sample is tilted",
                                        "seat it again"}));
    // 0.6 and 0.8 % are 1.0 % together; 0.36 and 0.64 of the variance; 10 / 0.64^2 = 24.4.
    EXPECT_EQ(rowOf(xml, "white reference, common"),
              (std::vector<std::string>{
                  "B", "common", "0.50 %", "0.60 %", "0.60 %", "not known", "36.0 %", "many"}));
    // Of green one component is known, of blue none.
    const auto expectTotal = [&](const char* head, const std::vector<std::string>& bands) {
        std::vector<std::string> row{"", "", ""};
        row.insert(row.end(), bands.begin(), bands.end());
        row.insert(row.end(), 2, "");
        EXPECT_EQ(rowOf(xml, head), row);
    };
    expectTotal("combined, k = 1", {"1.0 %", "at least 0.60 %", "not known"});
    expectTotal("expanded, k = 2 (about 95 %)", {"2.0 %", "at least 1.2 %", "not known"});
    expectTotal("effective degrees of freedom", {"24", "not known", "not known"});
    // Two tables have rows of 40 degrees: uncertainties, albedo.
    const Albedo albedo = directionalAlbedo(set.leds[2]);
    const BandAlbedo& green = albedo[Band::G];
    EXPECT_EQ(rowOf(xml, "40 deg").at(5), withExpanded(green.value, green.u()));
    EXPECT_EQ(rowOf(xml, "40 deg").at(6), shareText(green.missing));
    EXPECT_NE(wordsOf(xml).find("in 12 cells"), std::string::npos);
    EXPECT_EQ(xml.all("svg").size(), 3U);
    EXPECT_LT(reportOf(set).size(), 1'500'000U);
}

TEST(SampleReport, HostileNamesAreEscaped) {
    SampleSet set = tile();
    set.info.name = set.info.operatorNotes = set.info.session = set.info.referenceCertificate =
        kHostile;
    set.info.extra = {{kHostile, kHostile}};
    set.info.qcVerdicts = verdictsText(std::vector<Verdict>{
        {.name = kHostile, .figure = {}, .evidence = kHostile, .next = kHostile}});
    set.info.budgetJson = R"([{"led":0,"band":"r","components":[{"name":"<b>&","size":1,)"
                          R"("median_relative":0.1,"unit":"<i>"}]}])";
    ReportOrigin from = origin();
    from.file = from.operatorName = from.calibrations[0].kind = kHostile;
    const std::string html = sampleReport(set, from, nothing());
    const Xml xml = readHtml(html);
    EXPECT_EQ(html.find("<script"), std::string::npos);
    EXPECT_EQ(html.find("<b>"), std::string::npos);
    EXPECT_EQ(xml.all("h1").at(0).text, "BRDF of " + kHostile);
    EXPECT_EQ(rowOf(xml, "notes"), std::vector<std::string>{kHostile});
    EXPECT_EQ(rowOf(xml, "<b>&").size(), 8U);
}

TEST(SampleReport, WithoutPartsItSaysSo) {
    SampleSet bare = test::sampleSet(surface);
    bare.info = {};
    const std::string words = wordsOf(readHtml(reportOf(bare)));
    for (const char* said : {"a sample without a name",
                             "holds no uncertainty budget",
                             "holds no verdicts",
                             "nothing between",
                             "nothing fitted"})
        EXPECT_NE(words.find(said), std::string::npos) << said;
    bare.leds.resize(1);
    for (const char* broken : {"banana", "{}", "[1,{\"led\":-1}]", R"([{"led":0,"band":"x"}])"}) {
        bare.info.budgetJson = bare.info.qcVerdicts = broken;
        readHtml(reportOf(bare));
    }
}

TEST(SampleReport, OfOneLedOneBandOrOneCellIsWhole) {
    SampleSet one = tile();
    one.leds = {one.leds[1]};
    one.leds[0].bands[0] = one.leds[0].bands[2] = {};
    const Xml band = readHtml(reportOf(one));
    EXPECT_EQ(rowOf(band, "bands").at(0), "G 525 nm (the LEDs' own)");
    EXPECT_NE(wordsOf(band).find("No pair of directions"), std::string::npos);

    CellSamples& cells = one.leds[0].bands[1];
    const Measured<double> kept = cells.at(0);
    cells = CellSamples::missing(cells.size());
    const Xml none = readHtml(reportOf(one));
    EXPECT_EQ(rowOf(none, "20 deg, G 525 nm"), (std::vector<std::string>{"0", "100.0 %"}));
    EXPECT_EQ(rowOf(none, "20 deg"),
              (std::vector<std::string>{"none measured", "none", "100.0 %"}));
    cells.f[0] = kept.value;
    cells.uRandom[0] = kept.uRandom;
    cells.uSystematic[0] = kept.uSystematic;
    cells.flags[0] = kept.flags;
    const Xml cell = readHtml(reportOf(one));
    EXPECT_EQ(rowOf(cell, "20 deg, G 525 nm").at(0), "< 0.1 %");
    const auto estimator = SampleEstimator::over(one, {});
    ASSERT_TRUE(estimator) << estimator.error().message;
    const Selection fits = selectModel(*familiesNamed("lambert,lambert+ggx"), fitDataOf(one));
    const Xml made = readHtml(sampleReport(
        one, origin(), {.estimator = estimator->get(), .noEstimator = {}, .fits = &fits}));
    EXPECT_NE(wordsOf(made).find("Too few incidences"), std::string::npos);
    EXPECT_EQ(rowOf(made, "lambert").at(0), "too few data");

    one.leds.clear();
    EXPECT_NE(wordsOf(readHtml(reportOf(one))).find("nothing to draw"), std::string::npos);
}

TEST(SampleReport, ShowsTheMethodAndTheFits) {
    SampleSet set = tile();
    const auto estimator = SampleEstimator::over(
        set, {.method = "specular-log", .effort = Effort::Draft, .prior = {}});
    ASSERT_TRUE(estimator) << estimator.error().message;
    const auto families = familiesNamed("lambert");
    ASSERT_TRUE(families);
    const Selection fits = selectModel(*families, fitDataOf(set));
    const Xml xml = readHtml(sampleReport(
        set, origin(), {.estimator = estimator->get(), .noEstimator = {}, .fits = &fits}));
    const std::string words = wordsOf(xml);
    EXPECT_NE(words.find("Between the incidences: specular-log"), std::string::npos);
    EXPECT_NE(words.find("prior was not asked"), std::string::npos);
    EXPECT_NE(words.find(fits.verdict), std::string::npos);
    const std::vector<std::string> row = rowOf(xml, "lambert");
    ASSERT_GE(row.size(), 9U);
    EXPECT_EQ(row[0], "misfits") << "it has no lobe";
    EXPECT_EQ(row[1], "3");
    EXPECT_EQ(row[2], significant(fits.ranked[0].fit.chiSquarePerDof(), 3));
    const FittedParameter& red = fits.ranked[0].fit.parameters.at(0);
    EXPECT_NE(row[7].find("R " + withExpanded(red.value, std::hypot(red.uRandom, red.uSystematic))),
              std::string::npos)
        << row[7];
    // At an incidence in between nothing is measured.
    EXPECT_EQ(rowOf(xml, "30 deg").at(0), "0");
    EXPECT_EQ(xml.all("svg").size(), 4U);
}

}  // namespace
}  // namespace gonio::proc
