// `gonio report`: a measured sample as one HTML file.

#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/cli/output_name.h"
#include "daemon/cli/progress.h"
#include "daemon/estimators.h"
#include "daemon/report_source.h"
#include "daemon/utc_now.h"
#include "proc/fit/selection.h"
#include "proc/formats/file_bytes.h"
#include "proc/report/sample_report.h"
#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

using Families = std::vector<const proc::Family*>;

/// One for each kind of floor and lobe that surfaces show.
constexpr const char* kUsualModels =
    "lambert,oren-nayar,ggx,lambert+ggx,lambert+beckmann,lambert+ggx+ggx";

/// Empty: none is wanted.
Result<Families> familiesOf(const std::string& models) {
    if (models == "none") return Families{};
    return proc::familiesNamed(models == "usual" ? kUsualModels : models);
}

/// What the report shows, with what keeps it alive.
struct Estimates {
    Estimated estimated;
    proc::Selection fits;
    proc::ReportEstimates shown;
};

Result<void> addEstimator(Estimates& all, const Material& material, const std::string& name) {
    if (name == "none") {
        all.shown.noEstimator = "Nothing was asked between and beyond the angles.";
        return {};
    }
    auto made = estimated(material, {.name = name});
    if (!made && made.error().kind == ErrorKind::Quality) {
        all.shown.noEstimator =
            "Nothing can be said between and beyond the angles: " + made.error().message + ".";
        return {};
    }
    if (!made) return made.error();
    all.estimated = std::move(*made);
    all.shown.estimator = all.estimated.sample;
    all.shown.surface = all.estimated.scatterer.get();
    if (all.shown.estimator != nullptr) return {};
    all.shown.noEstimator =
        proc::rotationsOf(*material.sample).size() > 1
            ? "The sample was measured at several rotations: each has an estimator of its own, and "
              "between two of them answers are linear in the light's azimuth. What "
              "is known of their errors is in the uncertainties that 'gonio eval' writes; this "
              "report does not list it."
            : "The method '" + name + "' says nothing of its own errors.";
    return {};
}

void addFits(Estimates& all, const Material& material, const Families& families) {
    if (families.empty()) {
        all.shown.noFits = "No models were fitted.";
        return;
    }
    const proc::BrdfData data = proc::fitDataOf(*material.sample);
    if (data.valueCount() == 0) {
        all.shown.noFits = "No model can be fitted: no cell holds a value that is good for it.";
        return;
    }
    all.fits = proc::selectModel(families, data);
    all.shown.fits = &all.fits;
}

}  // namespace

Result<void> report(const CommonOptions& common, const ReportOptions& options) {
    const Result<Families> families = familiesOf(options.models);
    if (!families) return families.error().in("report");
    Result<ReportSource> source = openForReport(options.file, common.store);
    if (!source) return source.error().in("report");
    const std::filesystem::path output =
        options.output.empty()
            ? std::filesystem::path(fileNameOf(titleOf(options.file, source->material)) + ".html")
            : options.output;
    if (auto writable = checkOutputFile(output); !writable) return writable.error().in("report");
    Progress progress("report", !common.quiet && !common.json);
    constexpr int kSteps = 3;
    progress.show({.step = 0, .steps = kSteps, .what = "estimator"});
    Estimates estimates;
    auto added = addEstimator(estimates, source->material, options.estimator);
    if (!added) return added.error().in("report: '" + options.file + "'");
    progress.show({.step = 1, .steps = kSteps, .what = "models"});
    addFits(estimates, source->material, *families);
    progress.show({.step = 2, .steps = kSteps, .what = "answers between the angles, pictures"});
    source->origin.madeUtc = utcNow();
    source->origin.madeBy = "gonio " GONIO_VERSION;
    const std::string html =
        proc::sampleReport(*source->material.sample, source->origin, estimates.shown);
    progress.clear();
    if (auto done = proc::writeFile(output, html); !done) return done.error().in("report");
    if (common.json) {
        printJson(
            {{"schema", "gonio/report/1"}, {"file", output.string()}, {"bytes", html.size()}});
    } else if (!common.quiet) {
        std::cout << output.string() << "\n";
    }
    return {};
}

}  // namespace gonio::daemon
