// `gonio fit`: analytic models fitted to a file, ranked, and the choice among them.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/commands.h"
#include "daemon/cli/evaluation_time.h"
#include "daemon/cli/fit_report.h"
#include "daemon/cli/goal_options.h"
#include "daemon/cli/output.h"
#include "daemon/material.h"
#include "driver/steady_clock.h"
#include "proc/core/number_text.h"
#include "proc/fit/residual_map.h"
#include "proc/fit/selection.h"
#include "proc/formats/brdf_file.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/scattered_csv.h"
#include "proc/report/hemisphere_map.h"
#include "proc/table/rows_of.h"
#include "proc/table/sample_lookup.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Error usage(const std::string& what) { return {ErrorKind::Usage, "fit: " + what}; }

Result<proc::FitWeights> weightsOf(const std::string& text) {
    if (text == "uncertainty") return proc::FitWeights{.uncertainty = true, .cosine = false};
    if (text == "cosine") return proc::FitWeights{.uncertainty = false, .cosine = true};
    if (text == "both") return proc::FitWeights{.uncertainty = true, .cosine = true};
    if (text == "none") return proc::FitWeights{.uncertainty = false, .cosine = false};
    return usage("--weights '" + text + "', wanted uncertainty, cosine, both or none");
}

/// "none", "huber", "cauchy:2".
Result<void> readRobust(const std::string& text, proc::ModelFitOptions& options) {
    const std::size_t colon = text.find(':');
    const std::string loss = text.substr(0, colon);
    const auto scale =
        colon == std::string::npos ? std::optional(3.0) : parseDouble(text.substr(colon + 1));
    const bool known = loss == "none" || loss == "huber" || loss == "cauchy";
    if (!known || !scale || *scale <= 0) {
        return usage("--robust '" + text + "', wanted none, huber or cauchy, with :SCALE above 0");
    }
    options.loss = loss == "huber"    ? proc::RobustLoss::Huber
                   : loss == "cauchy" ? proc::RobustLoss::Cauchy
                                      : proc::RobustLoss::None;
    options.lossScale = *scale;
    return {};
}

/// Data that can be fitted, or why not, naming the file.
Result<proc::BrdfData> checked(Result<proc::BrdfData> data, const std::string& file) {
    if (!data) return data.error().in("'" + file + "'");
    if (data->valueCount() > 0) return data;
    const std::string why =
        data->leftOut == 0 ? "it has no rows"
                           : "all " + std::to_string(data->leftOut) +
                                 " directions are missing, flagged, below the horizon or without "
                                 "a positive uncertainty";
    return Error{ErrorKind::File, "fit: '" + file + "': no value can be fitted: " + why};
}

Result<proc::BrdfData> dataOf(const CommonOptions& common, const FitOptions& options) {
    const std::optional<double> assumed = parsePercent(options.assumed);
    if (!assumed)
        return usage("--assume '" + options.assumed +
                     "', wanted a share above 0 % and up to 100 %, such as 5%");
    const std::optional<double> floor = options.floor.empty() ? 0 : parsePercent(options.floor);
    if (!floor)
        return usage("--floor '" + options.floor +
                     "', wanted a share above 0 % and up to 100 %, such as 1%");
    const proc::DataOptions wanted{.assumedRelative = *assumed, .relativeFloor = *floor};
    if (options.file.starts_with("model:")) {
        return usage("'" + options.file + "' is a formula already; a measured file is wanted");
    }
    const auto path = fileOf(options.file, common.store);
    if (!path) return path.error();
    const Result<proc::BrdfFile> file = proc::readBrdf(*path);
    if (!file) return file.error();
    if (const auto* sample = file->as<proc::SampleSet>()) {
        return checked(proc::fitDataOf(*sample, wanted), options.file);
    }
    if (const auto* table = file->as<proc::SpecularTable>()) {
        return checked(proc::fitDataOf(*table, wanted), options.file);
    }
    if (const auto* rows = file->as<proc::BrdfRows>()) {
        return checked(proc::fitDataOf(*rows, wanted), options.file);
    }
    if (const auto* table = file->as<proc::SphericalTable>()) {
        return checked(proc::fitDataOf(proc::rowsOf(*table), wanted), options.file);
    }
    return usage("'" + options.file + "' is a " + std::string(factsOf(file->format).title) +
                 ", which holds no measured directions of its own: gonio convert it to .gonio");
}

std::vector<std::vector<std::string>> tableOf(const proc::Selection& selection) {
    std::vector<std::vector<std::string>> rows{{"model",
                                                "params",
                                                "held-out rms",
                                                "energy rms",
                                                "chi2/dof",
                                                "BIC",
                                                "ns",
                                                "pareto",
                                                "status"}};
    const auto perCentOr = [](std::optional<double> value) { return value ? perCent(*value) : ""; };
    for (std::size_t i = 0; i < selection.ranked.size(); ++i) {
        const proc::RankedFit& one = selection.ranked[i];
        const proc::ModelFit& fit = one.fit;
        const bool usable = fit.usable();
        std::string status(name(fit.status));
        if (usable) status = one.rejected ? "rejected" : "possible";
        if (usable && !selection.chosen) status = "misfits";
        if (selection.chosen == i) status = "chosen";
        rows.push_back({fit.family->name(),
                        std::to_string(fit.parameterCount()),
                        perCentOr(fit.heldOutRms()),
                        perCentOr(fit.heldOutEnergyRms()),
                        usable ? fixed(fit.chiSquarePerDof(), 3) : "",
                        usable ? fixed(fit.bic(), 0) : "",
                        one.nanoseconds ? fixed(*one.nanoseconds, 1) : "",
                        one.pareto ? "yes" : "",
                        status});
    }
    return rows;
}

/// Of the chosen fit; of the best where none was chosen.
const proc::ModelFit* shownFit(const proc::Selection& selection) {
    const auto shown = selection.chosen ? selection.chosen : selection.best;
    return shown ? &selection.ranked[*shown].fit : nullptr;
}

void printFit(const proc::ModelFit& fit) {
    std::vector<std::vector<std::string>> rows{
        {"parameter", "value", "u_random", "u_systematic", "unit"}};
    const auto digits = [](double value) {
        std::ostringstream text;
        text.precision(5);
        if (std::isfinite(value)) text << value;
        return text.str();
    };
    for (const proc::FittedParameter& p : fit.parameters) {
        const std::string band = p.band ? "_" + std::string(letter(*p.band)) : "";
        rows.push_back({p.name + band,
                        digits(p.value),
                        digits(p.uRandom),
                        digits(p.uSystematic),
                        p.unit == "1" ? "" : p.unit});
    }
    std::cout << "\n" << fit.spec << "\n";
    printTable(rows);
    for (const std::string& warning : fit.warnings) std::cout << "note: " << warning << "\n";
}

Result<void> writeReport(const fs::path& folder,
                         const proc::Selection& selection,
                         const proc::BrdfData& data,
                         const Json& json) {
    if (auto done = proc::writeFile(folder / "fit.json", json.dump(2) + "\n"); !done) return done;
    if (auto done = proc::writeFile(folder / "fit.md", fitMarkdown(selection)); !done) return done;
    const proc::ModelFit* fit = shownFit(selection);
    if (fit == nullptr) return {};
    const std::string csv =
        proc::writeScatteredCsv(proc::rowsOf(proc::residualMap(*fit, data)), {}).bytes;
    if (auto done = proc::writeFile(folder / "residuals.csv", csv); !done) return done;
    const proc::SampleLookup sizes(proc::residualSizeMap(*fit, data));
    const std::string map =
        proc::hemisphereMaps(sizes,
                             {.title = "How far " + fit->family->name() + " is from the data",
                              .incidences = data.incidences,
                              .quantity = "|f - model| / u"});
    return proc::writeFile(folder / "residuals.svg", map);
}

}  // namespace

Result<void> fit(const CommonOptions& common, const FitOptions& options) {
    const auto families = proc::familiesNamed(options.models);
    if (!families) return families.error();
    proc::SelectionOptions selectionOptions;
    const auto weights = weightsOf(options.weights);
    if (!weights) return weights.error();
    selectionOptions.fit.weights = *weights;
    if (auto done = readRobust(options.robust, selectionOptions.fit); !done) return done;
    const driver::SteadyClock clock;
    selectionOptions.nanoseconds = [&clock](const std::string& spec) {
        return evaluationNanoseconds(spec, clock);
    };
    const Result<proc::BrdfData> data = dataOf(common, options);
    if (!data) return data.error();
    if (auto done = makeOutputFolder(options.output); !done) return done.error().in("fit");
    const proc::Selection selection = proc::selectModel(*families, *data, selectionOptions);
    const Json json = fitJson(selection, *data);
    if (!options.output.empty()) {
        if (auto done = writeReport(options.output, selection, *data, json); !done) return done;
    }
    if (common.json) {
        printJson(json);
        return {};
    }
    std::cout << data->valueCount() << " values in " << data->rows.size() << " directions, "
              << data->leftOut << " directions left out\n\n";
    printTable(tableOf(selection));
    if (const proc::ModelFit* shown = shownFit(selection)) printFit(*shown);
    std::cout << "\n" << selection.verdict << "\n";
    return {};
}

}  // namespace gonio::daemon
