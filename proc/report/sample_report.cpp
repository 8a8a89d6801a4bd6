#include "proc/report/sample_report.h"

#include "proc/estimate/sample_estimator.h"
#include "proc/fit/selection.h"
#include "proc/report/at_cell_centres.h"
#include "proc/report/budget_tables.h"
#include "proc/report/calibration_tables.h"
#include "proc/report/estimate_tables.h"
#include "proc/report/fit_tables.h"
#include "proc/report/glossary.h"
#include "proc/report/hemisphere_map.h"
#include "proc/report/html_page.h"
#include "proc/report/plot_request.h"
#include "proc/report/reflectance_tables.h"
#include "proc/report/relative_uncertainty.h"
#include "proc/report/sample_cells.h"
#include "proc/report/sample_tables.h"
#include "proc/report/slice_plot.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"
#include "proc/table/sample_lookup.h"

namespace gonio::proc {
namespace {

/// What all parts go over.
struct Reported {
    const SampleSet set;  // by rotation and incidence
    const ReportOrigin& origin;
    const ReportEstimates& estimates;

    [[nodiscard]] const SampleSet& sample() const { return set; }
    [[nodiscard]] bool measured() const { return !measuredBands(set).empty(); }
};

SampleSet sorted(SampleSet sample) {
    sortTables(sample);
    return sample;
}

/// "f as measured, turned 90 deg".
std::string titled(const std::string& words, Radians rotation) {
    const std::string turn = turnLabel(rotation);
    return words + (turn.empty() ? "" : ", " + turn);
}

void addIdentity(HtmlPage& page, const Reported& what) {
    page.section("identity", "Identity");
    page.facts(identityFacts(what.sample(), what.origin));
    const Facts further = furtherFacts(what.sample());
    if (further.empty()) return;
    page.heading("What else the file says");
    page.facts(further);
}

void addCalibration(HtmlPage& page, const Reported& what) {
    page.section("calibration", "Calibration");
    page.facts(calibrationFacts(what.sample()));
    if (what.origin.calibrations.empty()) {
        page.paragraph(what.origin.noCalibrations);
    } else {
        page.table(calibrationTable(what.sample(), what.origin));
    }
}

void addBudget(HtmlPage& page, const Reported& what) {
    page.section("uncertainty", "Uncertainty");
    const HtmlTable budget = budgetTable(what.sample());
    if (budget.rows.empty()) {
        page.paragraph("The file holds no uncertainty budget.");
    } else {
        page.table(budget);
        page.paragraph(
            "Each figure is the median over the incidences of a median over cells. Medians do not "
            "add, and a correction for tilt averages neighbours: what the cells have in the end "
            "stands in the next table. Type A was evaluated from repeats or "
            "statistics, type B from elsewhere; errors per cell average out over many cells, "
            "errors per state are one for an LED and band, common ones are one for the sample.");
    }
    page.table(achievedTable(what.sample()));
    if (const std::size_t cells = monteCarloCells(what.sample()); cells > 0) {
        page.paragraph("Where first order is wrong, distributions were propagated: in " +
                       std::to_string(cells) + " cells of all states.");
    }
}

void addVerdicts(HtmlPage& page, const Reported& what) {
    page.section("quality", "Quality");
    const HtmlTable verdicts = verdictTable(what.sample());
    if (verdicts.rows.empty()) {
        page.paragraph("The file holds no verdicts: nobody judged this measurement.");
    } else {
        page.table(verdicts);
    }
    page.heading("Reciprocity");
    const HtmlTable pairs = reciprocityTable(what.sample());
    if (pairs.rows.empty()) {
        page.paragraph("No pair of directions was measured both ways above the noise.");
    } else {
        page.table(pairs);
    }
}

/// Of one rotation, in the rig's frame.
void addMapsOf(HtmlPage& page, const SampleSet& part) {
    const Radians rotation = part.leds.front().rotation;
    const std::vector<Radians> incidences = incidencesOf(part);
    const SampleLookup lookup(part);
    const AtCellCentres cells(lookup);
    page.figure(hemisphereMaps(cells,
                               {.title = titled("f as measured", rotation),
                                .incidences = incidences,
                                .embedded = true}),
                "The reflected hemisphere from above, theta_o outward in equal steps to 90 "
                "degrees; the light stands on the right (azimuth 0). f in 1/sr on one logarithmic "
                "scale, each cell as it was measured; grey is missing, which is never 0.");
    page.figure(hemisphereMaps(RelativeUncertainty(cells),
                               {.title = titled("relative uncertainty", rotation),
                                .incidences = incidences,
                                .quantity = "u / f, k = 1",
                                .embedded = true}),
                "Combined standard uncertainty (k = 1) over f, likewise.");
}

void addSlicesOf(HtmlPage& page, const SampleSet& part) {
    const SampleLookup lookup(part);
    page.figure(slicePlots(AtCellCentres(lookup),
                           {.title = titled("f as measured", part.leds.front().rotation),
                            .incidences = incidencesOf(part)}),
                "f in 1/sr of the cells in the plane of incidence: theta_o below 0 on the side of "
                "the light (dotted), above 0 toward its mirror direction. Shaded: f +- U (k = 2, "
                "about 95 %). A gap is missing or not above 0.");
}

void addMaps(HtmlPage& page, const Reported& what) {
    page.section("maps", "BRDF over the hemisphere");
    if (!what.measured()) {
        page.paragraph("No band of any LED was measured: there is nothing to draw.");
        return;
    }
    const std::vector<Radians> rotations = rotationsOf(what.sample());
    if (rotations.size() > 1) {
        page.paragraph(
            "The sample was turned on the stage between measurements: each rotation "
            "has pictures of its own, as the rig saw it.");
    }
    for (const Radians one : rotations) addMapsOf(page, tablesAt(what.sample(), one));
    page.section("slices", "Plane of incidence");
    for (const Radians one : rotations) addSlicesOf(page, tablesAt(what.sample(), one));
}

void addReflectance(HtmlPage& page, const Reported& what) {
    page.section("reflectance", "Reflectance");
    page.table(cellAlbedoTable(what.sample()));
    page.paragraph(
        "The share of the light of one direction that is sent back into all directions that were "
        "measured, with U (k = 2). The columns beside it say what share of the projected solid "
        "angle has no answer: that adds nothing, so that the value is a lower bound. The mean is "
        "of "
        "light from all directions within the incidences; between them it follows a line in "
        "sin^2(theta_i), which may be off by what stands beside it, to either side.");
    if (what.estimates.surface != nullptr)
        page.table(filledAlbedoTable(what.sample(), *what.estimates.surface));
}

void addCoverage(HtmlPage& page, const Reported& what) {
    page.section("coverage", "What is missing, and what was flagged");
    page.table(coverageTable(what.sample()));
}

void addEstimator(HtmlPage& page, const Reported& what) {
    page.section("between", "Between and beyond the angles");
    const SampleEstimator* estimator = what.estimates.estimator;
    if (estimator == nullptr) {
        page.paragraph(what.estimates.noEstimator);
        return;
    }
    const HtmlTable sources = sourceTable(what.sample(), *estimator);
    const MethodChoice& choice = estimator->choice();
    page.paragraph(methodSentence(choice));
    page.paragraph(priorSentence(estimator->prior()));
    page.table(sources);
    if (!choice.scores.empty()) page.table(methodTable(choice));
    page.figure(slicePlots(*estimator,
                           {.title = "f where no LED stands",
                            .incidences = unmeasuredIncidences(what.sample())}),
                "Answers between the incidences and beyond the last one, as the plane of incidence "
                "above; the shaded U holds the method's own error where it is known.");
}

void addFits(HtmlPage& page, const Reported& what) {
    page.section("fits", "Fitted models");
    const Selection* fits = what.estimates.fits;
    if (fits == nullptr) {
        page.paragraph(what.estimates.noFits);
        return;
    }
    page.paragraph(fits->verdict);
    page.table(fitTable(*fits));
    page.table(parameterTable(*fits));
    if (!fits->worst.empty()) page.table(misfitTable(*fits));
}

}  // namespace

std::string sampleReport(SampleSet sample,
                         const ReportOrigin& origin,
                         const ReportEstimates& estimates) {
    const Reported what{sorted(std::move(sample)), origin, estimates};
    const std::string& name = what.sample().info.name;
    HtmlPage page("BRDF of " + (name.empty() ? std::string("a sample without a name") : name));
    addIdentity(page, what);
    addCalibration(page, what);
    addBudget(page, what);
    addVerdicts(page, what);
    addMaps(page, what);
    addReflectance(page, what);
    addCoverage(page, what);
    addEstimator(page, what);
    addFits(page, what);
    page.section("words", "Units and words");
    page.facts(glossary());
    return page.document();
}

}  // namespace gonio::proc
