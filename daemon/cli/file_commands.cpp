// Commands on files: eval, convert, plot. None of them needs a rig or takes the store's lock.

#include <algorithm>
#include <cctype>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/material.h"
#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/points_csv.h"
#include "proc/formats/zemax.h"
#include "proc/report/hemisphere_map.h"
#include "proc/report/slice_plot.h"
#include "proc/table/specular_fill.h"

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

/// name.bsdf -> name_G.bsdf.
fs::path forBand(const fs::path& file, Band band) {
    fs::path out = file;
    out.replace_filename(file.stem().string() + "_" + std::string(1, "RGB"[index(band)]) +
                         file.extension().string());
    return out;
}

Result<void> convertToZemax(const CommonOptions& common,
                            const Material& from,
                            const fs::path& output,
                            Json& files) {
    if (from.table != nullptr) {  // as it is: nothing to resample
        const proc::Written written = proc::writeZemax(*from.table);
        if (Result<void> done = proc::writeFile(output, written.bytes); !done) return done;
        reportLoss(common, output, written.loss, files);
        return {};
    }
    std::vector<double> incidences;
    for (Radians i : from.incidences()) incidences.push_back(proc::fileDegrees(i));
    const auto grid = proc::SpecularGrid::oneDegree(incidences, proc::TableSymmetry::Asymmetrical);
    const bool mono = from.scatterer->bandCount() == BandCount::One;
    for (Band band : kBands) {
        if (mono && band != Band::R) break;
        proc::FilledTable filled = proc::fillTable(*from.scatterer, grid, band);
        if (!mono) filled.table.comments.push_back(proc::wavelengthComment(band));
        proc::Written written = proc::writeZemax(filled.table);
        written.loss.add("nodes without an answer, written as 0", filled.unanswered);
        written.loss.add("answers of exactly 0, which read back as missing", filled.exactZero);
        written.loss.add("uncertainties left out", filled.uncertain);
        const fs::path file = mono ? output : forBand(output, band);
        if (Result<void> done = proc::writeFile(file, written.bytes); !done) return done;
        reportLoss(common, file, written.loss, files);
    }
    return {};
}

/// What a plot is of: the sample's own name, the model, or the file's.
std::string titleOf(const std::string& f, const Material& material) {
    if (material.sample != nullptr && !material.sample->info.name.empty()) {
        return material.sample->info.name;
    }
    if (material.kind == "model") return f.substr(f.find(':') + 1);
    return fs::path(f).stem().string();
}

/// Letters, digits and a few signs, at most 80 of them.
std::string fileNameOf(std::string title) {
    constexpr std::size_t kLongest = 80;
    title.resize(std::min(title.size(), kLongest));
    for (char& c : title) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' ||
                           c == '_' || c == '-' || c == '+';
        if (!plain) c = '-';
    }
    return title;
}

}  // namespace

Result<void> eval(const CommonOptions& common, const EvalOptions& options) {
    const Result<Material> material = openMaterial(options.file, common.store);
    if (!material) return material.error();
    const Result<proc::Points> points = proc::readPoints(options.points);
    if (!points) return points.error();
    const std::vector<Answer> answers = answersAt(*material->scatterer, points->pairs);
    const std::string csv = proc::evalCsv(*points, answers, material->scatterer->bandCount());
    if (!options.output.empty()) return proc::writeFile(options.output, csv);
    std::cout << csv;
    return {};
}

Result<void> convert(const CommonOptions& common, const ConvertOptions& options) {
    const Result<Material> material = openMaterial(options.input, common.store);
    if (!material) return material.error();
    std::string to = options.to;
    if (to.empty()) {
        const std::string extension = options.output.extension().string();
        to = extension == ".bsdf"    ? "zemax"
             : extension == ".csv"   ? "csv"
             : extension == ".gonio" ? "gonio"
                                     : "";
    }
    Json files = Json::array();
    Result<void> done;
    if (to == "zemax") {
        done = convertToZemax(common, *material, options.output, files);
    } else if ((to == "csv" || to == "gonio") && material->sample == nullptr) {
        return Error{ErrorKind::Usage,
                     "convert: only a .gonio becomes " + to + "; '" + options.input + "' is a " +
                         material->kind};
    } else if (to == "csv") {
        done = proc::writeFile(options.output, proc::sampleCsv(*material->sample));
        files.push_back({{"file", options.output.string()}, {"lost", Json::array()}});
    } else if (to == "gonio") {
        done = proc::writeGonio(options.output, *material->sample);
        files.push_back({{"file", options.output.string()}, {"lost", Json::array()}});
    } else {
        return Error{ErrorKind::Usage,
                     "convert: '" + (to.empty() ? options.output.string() : to) +
                         "': which format? Use .bsdf, .csv or .gonio, or --to zemax|csv|gonio"};
    }
    if (!done) return done;
    if (common.json)
        std::cout << Json{{"schema", "gonio/convert/1"}, {"files", files}}.dump(
                         2, ' ', false, Json::error_handler_t::replace)
                  << "\n";
    return {};
}

Result<void> plot(const CommonOptions& common, const PlotOptions& options) {
    const Result<Material> material = openMaterial(options.file, common.store);
    if (!material) return material.error();
    const std::string title = titleOf(options.file, *material);
    const std::string name = fileNameOf(title);
    const proc::PlotRequest request{.title = title, .incidences = material->incidences()};
    std::error_code ignored;
    if (!options.output.empty()) fs::create_directories(options.output, ignored);
    const fs::path map = options.output / (name + ".map.svg");
    const fs::path slice = options.output / (name + ".slice.svg");
    if (auto done = proc::writeFile(map, proc::hemisphereMaps(*material->scatterer, request));
        !done)
        return done;
    if (auto done = proc::writeFile(slice, proc::slicePlots(*material->scatterer, request)); !done)
        return done;
    if (common.json) {
        std::cout << Json{{"schema", "gonio/plot/1"}, {"files", {map.string(), slice.string()}}}
                         .dump(2, ' ', false, Json::error_handler_t::replace)
                  << "\n";
    } else if (!common.quiet) {
        std::cout << map.string() << "\n" << slice.string() << "\n";
    }
    return {};
}

}  // namespace gonio::daemon
