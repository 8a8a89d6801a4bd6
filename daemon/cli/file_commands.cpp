// Commands on files: eval, plot. None of them needs a rig or takes the store's lock.

#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/cli/output_name.h"
#include "daemon/estimators.h"
#include "daemon/material.h"
#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/points_csv.h"
#include "proc/report/hemisphere_map.h"
#include "proc/report/slice_plot.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::vector<Answer> answersAt(const Scatterer& scatterer, const std::vector<LightView>& pairs) {
    std::vector<Answer> answers(pairs.size());
    parallelFor(pairs.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i)
            answers[i] = scatterer.answer(pairs[i]);
    });
    return answers;
}

}  // namespace

Result<void> eval(const CommonOptions& common, const EvalOptions& options) {
    const Result<Effort> effort = parseEffort(options.effort);
    if (!effort) return effort.error().in("eval");
    const Result<proc::Precision> precision = proc::parsePrecision(options.precision);
    if (!precision) return precision.error().in("eval");
    const Result<proc::Points> points = proc::readPoints(options.points);
    if (!points) return points.error();
    const Result<Estimated> opened =
        openEstimated(options.file,
                      common.store,
                      {.name = options.estimator, .effort = *effort, .prior = options.prior},
                      {.effort = *effort, .precision = *precision});
    if (!opened) return opened.error();
    if (*precision == proc::Precision::Float && opened->material.kind != "model") {
        return Error{ErrorKind::Usage,
                     "eval: '" + options.file + "': --precision float is for model:SPEC alone"};
    }
    const std::vector<Answer> answers = answersAt(*opened->scatterer, points->pairs);
    const std::string csv = proc::evalCsv(*points, answers, opened->scatterer->bandCount());
    if (!options.output.empty()) return proc::writeFile(options.output, csv);
    std::cout << csv;
    return {};
}

Result<void> plot(const CommonOptions& common, const PlotOptions& options) {
    const Result<Material> material = openMaterial(options.file, common.store);
    if (!material) return material.error();
    const std::string title = titleOf(options.file, *material);
    const std::string name = fileNameOf(title);
    const proc::PlotRequest request{.title = title, .incidences = material->incidences()};
    if (auto done = makeOutputFolder(options.output); !done) return done.error().in("plot");
    const fs::path map = options.output / (name + ".map.svg");
    const fs::path slice = options.output / (name + ".slice.svg");
    if (auto done = proc::writeFile(map, proc::hemisphereMaps(*material->scatterer, request));
        !done)
        return done;
    if (auto done = proc::writeFile(slice, proc::slicePlots(*material->scatterer, request)); !done)
        return done;
    if (common.json) {
        printJson({{"schema", "gonio/plot/1"}, {"files", {map.string(), slice.string()}}});
    } else if (!common.quiet) {
        std::cout << map.string() << "\n" << slice.string() << "\n";
    }
    return {};
}

}  // namespace gonio::daemon
