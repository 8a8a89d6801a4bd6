// gonio convert, export: surfaces as files of other formats.

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "daemon/cli/output_name.h"
#include "daemon/cli/written_files.h"
#include "daemon/conversion_input.h"
#include "proc/core/log.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Result<std::optional<bool>> parseCosine(const std::string& text) {
    if (text.empty()) return std::optional<bool>();
    if (text == "yes" || text == "no") return std::optional(text == "yes");
    return Error{ErrorKind::Usage, "--cosine '" + text + "': wanted yes or no"};
}

Result<ConversionInput> inputOf(const ConvertOptions& options) {
    ConversionInput input{
        .f = options.input,
        .estimator = options.estimator,
        .black = options.black,
        .repeats = options.repeats,
        .readings = {.planeSymmetrical = options.plane, .zeroAtShadow = options.zeroAtShadow}};
    if (!options.from.empty()) {
        const auto from = proc::parseFormat(options.from);
        if (!from) return from.error().in("--from");
        input.from = *from;
    }
    if (!options.bands.empty()) {
        auto bands = proc::parseBandChoice(options.bands);
        if (!bands) return bands.error();
        input.bands = std::move(*bands);
    }
    const auto cosine = parseCosine(options.cosine);
    if (!cosine) return cosine.error();
    input.cosine = *cosine;
    return input;
}

Result<proc::ConversionWish> wishOf(const ConvertOptions& options) {
    proc::ConversionWish wish{.half = options.half};
    const auto to =
        options.to.empty() ? proc::formatToWrite(options.output) : proc::parseFormat(options.to);
    if (!to) return options.to.empty() ? to.error() : to.error().in("--to");
    wish.to = *to;
    wish.anisotropic = options.output.extension() == ".anisotropicbsdf";
    if (!options.grid.empty()) {
        auto grid = proc::parseTargetGrid(options.grid);
        if (!grid) return grid.error();
        wish.grid = std::move(*grid);
    }
    return wish;
}

/// The formats of a list such as "gonio,zemax".
Result<std::vector<proc::Format>> formatsOf(const std::string& list) {
    if (list.empty()) {
        return std::vector{proc::Format::Gonio, proc::Format::Zemax, proc::Format::Csv};
    }
    std::vector<proc::Format> formats;
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        const Result<proc::Format> format = proc::parseFormat(word);
        if (!format) return format.error().in("export");
        formats.push_back(*format);
    }
    return formats;
}

/// The format's extension, after its name where another of the formats has the same one.
std::string endingOf(proc::Format format, const std::vector<proc::Format>& all) {
    const std::string extension(factsOf(format).extension);
    const auto alike = std::count_if(all.begin(), all.end(), [&](proc::Format other) {
        return factsOf(other).extension == extension;
    });
    return alike > 1 ? "." + std::string(name(format)) + extension : extension;
}

void warn(const std::string& f, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) log::warning(f + ": " + warning);
}

}  // namespace

Result<void> convert(const CommonOptions& common, const ConvertOptions& options) {
    const auto input = inputOf(options);
    if (!input) return input.error().in("convert");
    const auto wish = wishOf(options);
    if (!wish) return wish.error().in("convert");
    const auto opened = openConversion(*input, common.store);
    if (!opened) return opened.error();
    warn(options.input, opened->warnings);
    const auto converted = proc::convertTo(opened->source, *wish);
    if (!converted) return converted.error().in("convert: '" + options.input + "'");
    Json files = Json::array();
    Result<void> done = writeConverted(common, *converted, options.output, files);
    if (!done) return done;
    if (common.json) {
        printJson({{"schema", "gonio/convert/1"},
                   {"format", name(wish->to)},
                   {"files", files},
                   {"warnings", opened->warnings}});
    }
    return {};
}

Result<void> exportTo(const CommonOptions& common, const ExportOptions& options) {
    const auto formats = formatsOf(options.formats);
    if (!formats) return formats.error();
    const auto opened =
        openConversion({.f = options.file, .estimator = options.estimator}, common.store);
    if (!opened) return opened.error();
    warn(options.file, opened->warnings);
    if (auto done = makeOutputFolder(options.output); !done) return done.error().in("export");
    const std::string stem = fileNameOf(opened->title);
    Json files = Json::array();
    for (const proc::Format format : *formats) {
        const auto converted = proc::convertTo(opened->source, {.to = format});
        if (!converted) {
            if (options.formats.empty()) continue;  // nobody asked for what this cannot become
            return converted.error().in("export: '" + options.file + "'");
        }
        const fs::path file = options.output / (stem + endingOf(format, *formats));
        if (auto done = writeConverted(common, *converted, file, files); !done) return done;
    }
    if (common.json) {
        printJson({{"schema", "gonio/export/1"}, {"files", files}});
    } else if (!common.quiet) {
        for (const Json& one : files) std::cout << one["file"].get<std::string>() << "\n";
    }
    return {};
}

}  // namespace gonio::daemon
