#include "proc/report/sample_report.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/core/number_text.h"
#include "proc/estimate/sample_albedo.h"
#include "proc/estimate/sample_estimator.h"
#include "proc/fit/selection.h"
#include "proc/quality/verdict.h"
#include "proc/report/calibration_tables.h"
#include "proc/report/reflectance_tables.h"
#include "proc/report/report_words.h"
#include "tests/estimate/scatterers.h"
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
    set.info.extra = {
        {"chi_square_per_freedom", "1.0228026802"}, {"made_with", "1.10"}, {"seed", "7"}};
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

/// Pieces of curves in the slices.
std::size_t curvesOf(const Xml& xml) {
    std::size_t curves = 0;
    for (const test::XmlElement& line : xml.all("polyline"))
        curves += static_cast<std::size_t>(line.at("stroke-width") == "1.4");
    return curves;
}

TEST(SampleReport, SaysWhatTheFileSays) {
    const SampleSet set = tile();
    const Xml xml = readHtml(reportOf(set));
    EXPECT_EQ(xml.all("title").at(0).text, "BRDF of test tile");
    EXPECT_EQ(rowOf(xml, "measured (UTC)"), std::vector<std::string>{"2026-01-02T03:04:05Z"});
    EXPECT_EQ(rowOf(xml, "SHA-256 of the file"), std::vector<std::string>{"ab12"});
    EXPECT_EQ(rowOf(xml, "operator"), std::vector<std::string>{"Ada"});
    EXPECT_EQ(rowOf(xml, "view"),
              std::vector<std::string>{"outermost value at 75 deg from the normal"});
    EXPECT_EQ(rowOf(xml, "checks"), std::vector<std::string>{"1 warned"});
    EXPECT_EQ(rowOf(xml, "sample on the stage"), std::vector<std::string>{"not turned"});
    EXPECT_EQ(rowOf(xml, "chi_square_per_freedom"), std::vector<std::string>{"1.023"});
    EXPECT_EQ(rowOf(xml, "made_with"), std::vector<std::string>{"1.10"}) << "no digit is added";
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
    const BandAlbedo mean = meanAlbedo(set)[Band::R];
    ASSERT_GT(mean.errorBound, 0);
    EXPECT_EQ(
        rowOf(xml, "bihemispherical mean").at(0),
        withExpanded(mean.value, mean.u()) + ", line within " + significant(mean.errorBound, 2));
    EXPECT_NE(wordsOf(xml).find("in 12 cells"), std::string::npos);
    EXPECT_EQ(xml.all("svg").size(), 3U);
    EXPECT_LT(reportOf(set).size(), 1'500'000U);
}

TEST(SampleReport, OfATurnedSampleShowsEachRotation) {
    SampleSet set;
    for (const double rotationDeg : {45.0, 90.0}) {
        for (const Radians incidence : {0_deg, 20_deg}) {
            set.leds.push_back(test::ledTable(
                incidence, [=](Radians, const Direction&) { return rotationDeg / 900; }));
            set.leds.back().rotation = Radians::fromDegrees(rotationDeg);
        }
    }
    const Xml xml = readHtml(reportOf(set));
    EXPECT_EQ(rowOf(xml, "light").at(0), "0 deg, 20 deg from the normal, azimuth 0 of the rig");
    EXPECT_EQ(rowOf(xml, "sample on the stage").at(0), "turned 45 deg, turned 90 deg");
    for (const std::size_t led : {1U, 3U}) {
        const std::string turn = led == 1 ? "turned 45 deg" : "turned 90 deg";
        const BandAlbedo red = directionalAlbedo(set.leds[led])[Band::R];
        EXPECT_EQ(rowOf(xml, "20 deg, " + turn).at(3), withExpanded(red.value, red.u()));
        EXPECT_EQ(rowOf(xml, "20 deg, " + turn + ", R 630 nm").size(), 3U) << "coverage";
        // Both sides of the view, which the normal tells from nothing.
        EXPECT_EQ(rowOf(xml, "0 deg and 20 deg, " + turn).size(), 2U * 4);
    }
    // f and u / f of each rotation, then the slices: a curve for each LED and band.
    EXPECT_EQ(xml.all("svg").size(), 2U * 3);
    EXPECT_EQ(curvesOf(xml), 2U * 2 * 3);
}

TEST(SampleReport, CalibrationsAreThoseOfTheBudgetAndOfAnyAge) {
    SampleSet set;
    for (const char* drift : {"0.001", "0.002", "0.006"}) {
        set.info.budgetJson +=
            std::string(set.info.budgetJson.empty() ? "[" : ",") +
            R"({"led":0,"band":"r","components":[)"
            R"({"name":"noise of the zero reference's frames","type":"A","size":0.1},)"
            R"({"name":"white reference, common","type":"B","size":0.005},)"
            R"({"name":"zero reference","type":"B","size":0.00021,"unit":"1/sr"},)"
            R"({"name":"LED drift","type":"B","size":)" +
            drift + "}]}";
    }
    set.info.budgetJson += "]";
    const Facts facts = calibrationFacts(set);
    const auto said = [&](const std::string& what) {
        for (const auto& [name, words] : facts) {
            if (name == what) return words;
        }
        return std::string();
    };
    EXPECT_EQ(said("its uncertainty"), "white reference, common 0.50 % (k = 1)");
    EXPECT_EQ(said("uncertainty of the lower reference"), "zero reference 0.00021 1/sr (k = 1)");
    EXPECT_EQ(said("drift between captures"), "LED drift 0.20 % (k = 1)") << "the median";
    ReportOrigin later = origin();
    later.calibrations[0].ageHours = -72;
    EXPECT_EQ(calibrationTable(set, later).rows.at(0).at(3).words,
              "3.0 days after the measurement");
}

TEST(SampleReport, WhatIsFilledWhollyLacksNothing) {
    SampleSet set;
    set.leds.push_back(test::ledTable(20_deg, [](Radians, const Direction&) { return 0.3 / kPi; }));
    const test::Made lambert([](const LightView&) { return test::answerOf(0.3 / kPi); });
    EXPECT_EQ(filledAlbedoTable(set, lambert).rows.at(0).at(2).words, "0");
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
    EXPECT_EQ(curvesOf(cell), 1U) << "a cell is drawn without its neighbours";
    const auto estimator = SampleEstimator::over(one, {});
    ASSERT_TRUE(estimator) << estimator.error().message;
    const Selection fits = selectModel(*familiesNamed("lambert,lambert+ggx"), fitDataOf(one));
    const Xml made = readHtml(sampleReport(one,
                                           origin(),
                                           {.estimator = estimator->get(),
                                            .noEstimator = {},
                                            .surface = estimator->get(),
                                            .fits = &fits}));
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
    const Xml xml = readHtml(sampleReport(set,
                                          origin(),
                                          {.estimator = estimator->get(),
                                           .noEstimator = {},
                                           .surface = estimator->get(),
                                           .fits = &fits}));
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
