#include "daemon/conversion_input.h"

#include "daemon/estimators.h"
#include "daemon/material.h"
#include "proc/export/cosine.h"
#include "proc/export/source_of.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/rt300s_brdf.h"

namespace gonio::daemon {
namespace {

constexpr std::string_view kModel = "model:";

Result<OpenedConversion> ofFormula(const ConversionInput& input) {
    const bool asked = input.from || input.cosine || !input.bands.bands.empty() ||
                       input.bands.srgb || input.estimator != "none";
    if (asked) {
        return Error{ErrorKind::Usage,
                     "'" + input.f +
                         "' is a formula: it needs no --from, --bands, --cosine or "
                         "--estimator"};
    }
    Result<Material> model = openMaterial(input.f, {});
    if (!model) return model.error();
    const std::string spec = input.f.substr(kModel.size());
    proc::Metadata about;
    about.set("model", spec);
    return OpenedConversion{proc::sourceOf(model->scatterer, std::move(about)), spec, {}};
}

Result<proc::FileRead<proc::Rt300sScan>> readScan(const std::filesystem::path& path) {
    const Result<std::string> text = proc::readFile(path);
    if (!text) return text.error();
    return proc::parseRt300sCsv(*text, path.string());
}

/// Readings, those of repeats beside them, less those of the empty stage.
Result<proc::BrdfFile> lessBlack(const ConversionInput& input, const std::filesystem::path& path) {
    std::vector<std::filesystem::path> paths{path};
    paths.insert(paths.end(), input.repeats.begin(), input.repeats.end());
    std::vector<proc::Rt300sScan> scans;
    proc::BrdfFile file{.format = proc::Format::Rt300s};
    for (const auto& one : paths) {
        auto scan = readScan(one);
        if (!scan) return scan.error();
        if (scans.empty()) file.about = std::move(scan->about);
        for (const std::string& warning : scan->warnings) {
            const std::string whose = paths.size() > 1 ? one.filename().string() + ": " : "";
            file.warnings.push_back(whose + warning);
        }
        scans.push_back(std::move(scan->content));
    }
    const auto black = readScan(input.black);
    if (!black) return black.error();
    auto made = proc::rt300sBrdf(scans, black->content, input.readings);
    if (!made) return made.error().in(path.string());
    for (std::string& warning : proc::warningsOf(*made))
        file.warnings.push_back(std::move(warning));
    file.content = std::move(made->table);
    file.about.set(proc::key::kReference, "black: " + input.black.filename().string());
    return file;
}

Result<proc::BrdfFile> readFor(const ConversionInput& input, const std::filesystem::path& path) {
    if (!input.black.empty() && input.from.value_or(proc::Format::Rt300s) != proc::Format::Rt300s) {
        return Error{ErrorKind::Usage,
                     "--black is for RT-300S readings, not for --from " +
                         std::string(proc::name(*input.from))};
    }
    if (!input.black.empty()) return lessBlack(input, path);
    if (!input.repeats.empty()) {
        return Error{ErrorKind::Usage,
                     "--repeat is for RT-300S readings, beside --black BLANK.csv"};
    }
    return proc::readBrdf(path, input.from);
}

}  // namespace

Result<OpenedConversion> openConversion(const ConversionInput& input,
                                        const std::filesystem::path& store) {
    if (input.f.starts_with(kModel)) return ofFormula(input);
    const Result<std::filesystem::path> path = fileOf(input.f, store);
    if (!path) return path.error();
    Result<proc::BrdfFile> file = readFor(input, *path);
    if (!file) return file.error();
    const std::string named = "'" + input.f + "'";
    if (input.cosine) {
        file = proc::withCosineTold(std::move(*file), *input.cosine);
        if (!file) return file.error().in(named);
    }
    OpenedConversion opened{.source = {}, .title = path->stem().string(), .warnings = {}};
    opened.warnings = file->warnings;
    if (const std::string_view name = file->about.at(proc::key::kSample); !name.empty()) {
        opened.title = name;
    }
    Result<proc::ConversionSource> source = proc::sourceOf(std::move(*file), input.bands);
    if (!source) return source.error().in(named);
    opened.source = std::move(*source);
    if (input.estimator == "none") return opened;
    Result<Estimated> estimator = estimated(*opened.source.file, {.name = input.estimator});
    if (!estimator) return estimator.error().in(named);
    opened.source.scatterer = std::move(estimator->scatterer);
    opened.source.estimated = true;
    return opened;
}

}  // namespace gonio::daemon
