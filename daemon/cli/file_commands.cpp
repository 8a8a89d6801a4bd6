// Commands on files: eval, convert, export, plot. None of them needs a rig or takes the store's
// lock.

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/cli/output_name.h"
#include "daemon/estimators.h"
#include "daemon/exports.h"
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

void reportLoss(const CommonOptions& common,
                const fs::path& file,
                const proc::LossReport& loss,
                Json& files) {
    Json lost = Json::array();
    for (const auto& item : loss.items) {
        lost.push_back({{"what", item.what}, {"count", item.count}});
        if (!common.quiet) {
            std::cerr << file.string() << ": " << item.what << ": " << item.count << "\n";
        }
    }
    files.push_back({{"file", file.string()}, {"lost", lost}});
}

/// Writes what a surface becomes: STEM.EXT, or STEM_R.EXT ... where a file holds one band.
Result<void> writeExports(const CommonOptions& common,
                          const std::vector<ExportedFile>& exported,
                          const fs::path& output,
                          Json& files) {
    for (const ExportedFile& one : exported) {
        fs::path file = output;
        file.replace_filename(output.stem().string() + one.suffix + output.extension().string());
        if (Result<void> done = proc::writeFile(file, one.bytes); !done) return done;
        reportLoss(common, file, one.loss, files);
    }
    return {};
}

/// As it is, or with its nodes answered by the estimator.
Result<std::vector<ExportedFile>> exportedAs(const Estimated& opened,
                                             const std::string& estimator,
                                             ExportFormat format) {
    if (estimator == "none") return exportAs(opened.material, format);
    if (format == ExportFormat::Zemax) return exportFilled(opened.material, *opened.scatterer);
    return Error{ErrorKind::Usage,
                 "--estimator answers the nodes of a .bsdf; a " + std::string(name(format)) +
                     " holds what was measured: leave it out"};
}

/// The formats of a list such as "gonio,zemax"; all of them for an empty one.
Result<std::vector<ExportFormat>> formatsOf(const std::string& list) {
    if (list.empty()) {
        return std::vector{ExportFormat::Gonio, ExportFormat::Zemax, ExportFormat::Csv};
    }
    std::vector<ExportFormat> formats;
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        const Result<ExportFormat> format = parseExportFormat(word);
        if (!format) return format.error().in("export");
        formats.push_back(*format);
    }
    return formats;
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

Result<void> convert(const CommonOptions& common, const ConvertOptions& options) {
    const Result<Estimated> opened = openSurface(options.input, common.store, options.estimator);
    if (!opened) return opened.error();
    std::optional<ExportFormat> format = formatOfExtension(options.output.extension().string());
    if (!options.to.empty()) {
        const Result<ExportFormat> named = parseExportFormat(options.to);
        if (!named) return named.error().in("convert");
        format = *named;
    }
    if (!format) {
        return Error{ErrorKind::Usage,
                     "convert: '" + options.output.string() +
                         "': which format? Use .bsdf, .csv or .gonio, or --to zemax|csv|gonio"};
    }
    const auto exported = exportedAs(*opened, options.estimator, *format);
    if (!exported) return exported.error().in("convert: '" + options.input + "'");
    Json files = Json::array();
    Result<void> done = writeExports(common, *exported, options.output, files);
    if (!done) return done;
    if (common.json) printJson({{"schema", "gonio/convert/1"}, {"files", files}});
    return {};
}

Result<void> exportTo(const CommonOptions& common, const ExportOptions& options) {
    const auto formats = formatsOf(options.formats);
    if (!formats) return formats.error();
    const Result<Estimated> opened = openSurface(options.file, common.store, options.estimator);
    if (!opened) return opened.error();
    if (auto done = makeOutputFolder(options.output); !done) return done.error().in("export");
    const std::string stem = fileNameOf(titleOf(options.file, opened->material));
    Json files = Json::array();
    for (const ExportFormat format : *formats) {
        const bool other = opened->material.sample == nullptr || options.estimator != "none";
        if (options.formats.empty() && other && format != ExportFormat::Zemax) {
            continue;  // nobody asked for what this surface cannot become
        }
        const auto exported = exportedAs(*opened, options.estimator, format);
        if (!exported) return exported.error().in("export: '" + options.file + "'");
        const fs::path file = options.output / (stem + std::string(extension(format)));
        if (Result<void> done = writeExports(common, *exported, file, files); !done) return done;
    }
    if (common.json) {
        printJson({{"schema", "gonio/export/1"}, {"files", files}});
    } else if (!common.quiet) {
        for (const Json& one : files) std::cout << one["file"].get<std::string>() << "\n";
    }
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
