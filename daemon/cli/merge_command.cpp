// `gonio merge F... -o OUT`.

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/channel_merging.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/output.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/format.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/scattered_csv.h"
#include "proc/optics/cell_grid.h"
#include "proc/quality/verdict.h"
#include "proc/table/rotations.h"
#include "proc/table/rows_of.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kShownOutliers = 100;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json toJson(const proc::Consistency& found) {
    return {{"chi_square", found.chiSquare},
            {"freedom", found.freedom},
            {"per_freedom", number(found.perFreedom())},
            {"probability", found.probability()},
            {"median_relative", number(found.medianRelative)},
            {"outliers", found.outliers}};
}

Json toJson(const MergeCheck& check) {
    Json json{{"name", check.name},
              {"rotation_deg", check.rotation ? Json(proc::fileDegrees(*check.rotation)) : Json()}};
    json["cells"] = toJson(check.cells);
    json["light"] = check.light ? toJson(*check.light) : Json();
    return json;
}

Json toJson(const FileState& one) {
    return {{"file", one.file},
            {"rotation_deg", proc::fileDegrees(one.rotation)},
            {"incidence_deg", proc::fileDegrees(one.state.incidence)},
            {"band", letter(one.state.band)},
            {"scale", one.state.scale},
            {"u", one.state.u},
            {"away", one.state.away}};
}

Json toJson(const FileOutlier& one) {
    const Direction wo = proc::CellGrid::centre(one.outlier.cell);
    return {{"file", one.file},
            {"rotation_deg", proc::fileDegrees(one.rotation)},
            {"incidence_deg", proc::fileDegrees(one.outlier.incidence)},
            {"band", letter(one.outlier.band)},
            {"theta_o_deg", proc::fileDegrees(wo.theta())},
            {"phi_o_deg", proc::fileDegrees(wo.phi())},
            {"away", one.outlier.away},
            {"relative", number(one.outlier.relative)}};
}

Json channelsJson(const std::optional<std::array<proc::ChannelCount, 3>>& channels) {
    if (!channels) return {};
    Json json;
    for (const Band band : kBands) {
        const proc::ChannelCount& count = (*channels)[index(band)];
        json[std::string(letter(band))] = {{"partners", count.partners},
                                           {"estimated", count.estimated},
                                           {"missing", count.missing}};
    }
    return json;
}

Json documentOf(const Merged& merged, const MergeCommandOptions& options) {
    Json json{{"schema", "gonio/merge/1"},
              {"how", merged.how},
              {"files", options.files},
              {"output", options.output.string()}};
    Json rotations = Json::array();
    for (const Radians one : proc::rotationsOf(merged.sample))
        rotations.push_back(proc::fileDegrees(one));
    json["rotations_deg"] = rotations;
    const auto achieved = merged.sample.info.achievedUncertainty;
    json["median_relative_uncertainty"] = achieved ? Json(*achieved) : Json();
    json["channels"] = channelsJson(merged.channels);
    for (const char* list : {"checks", "states", "outliers"}) json[list] = Json::array();
    for (const MergeCheck& one : merged.checks) json["checks"].push_back(toJson(one));
    for (const FileState& one : merged.states) json["states"].push_back(toJson(one));
    for (const FileOutlier& one : merged.outliers) {
        if (json["outliers"].size() == kShownOutliers) break;
        json["outliers"].push_back(toJson(one));
    }
    json["outlier_count"] = merged.outliers.size();
    json["notes"] = merged.notes;
    json["qc"] = Json::parse(proc::verdictsText(proc::readVerdicts(merged.sample.info.qcVerdicts)));
    return json;
}

std::vector<std::vector<std::string>> checkRows(const Merged& merged) {
    std::vector<std::vector<std::string>> rows{{"agreement of",
                                                "chi-square per degree",
                                                "degrees",
                                                "probability",
                                                "median from mean",
                                                "outliers"}};
    const auto add = [&](const std::string& name, const proc::Consistency& found) {
        const bool any = found.freedom > 0;
        rows.push_back({name,
                        any ? fixed(found.perFreedom(), 3) : "-",
                        std::to_string(found.freedom),
                        any ? fixed(found.probability(), 4) : "-",
                        std::isfinite(found.medianRelative) ? perCent(found.medianRelative) : "-",
                        std::to_string(found.outliers)});
    };
    for (const MergeCheck& check : merged.checks) {
        const std::string at =
            check.rotation ? " at " + shortest(proc::fileDegrees(*check.rotation)) + " degrees"
                           : "";
        add(check.name + at + ": cells", check.cells);
        if (check.light) add(check.name + at + ": light", *check.light);
    }
    return rows;
}

void printReport(const Merged& merged, const MergeCommandOptions& options) {
    std::cout << merged.how << " of " << options.files.size()
              << " files: " << options.output.string() << "\n";
    if (merged.channels) {
        for (const Band band : kBands) {
            const proc::ChannelCount& count = (*merged.channels)[index(band)];
            std::cout << letter(band) << ": " << count.partners << " measured, " << count.estimated
                      << " estimated, " << count.missing << " missing\n";
        }
    }
    if (!merged.checks.empty()) printTable(checkRows(merged));
    constexpr std::size_t kPrinted = 10;
    for (std::size_t i = 0; i < std::min(kPrinted, merged.outliers.size()); ++i) {
        const FileOutlier& one = merged.outliers[i];
        const Direction wo = proc::CellGrid::centre(one.outlier.cell);
        std::cout << one.file << ": " << letter(one.outlier.band) << " at incidence "
                  << shortest(proc::fileDegrees(one.outlier.incidence)) << ", view "
                  << fixed(wo.theta().degrees(), 1) << "/" << fixed(wo.phi().degrees(), 1)
                  << " degrees is off by " << perCent(one.outlier.relative) << ", "
                  << fixed(one.outlier.away, 1) << " u\n";
    }
    if (merged.outliers.size() > kPrinted)
        std::cout << "and " << merged.outliers.size() - kPrinted << " more outliers\n";
}

Result<std::string> bytesOf(const Merged& merged, proc::Format format) {
    const bool scattered = merged.sample.leds.empty();
    if (format == proc::Format::Csv) {
        if (scattered) return channelCsv(merged.rows);
        const proc::Metadata about = proc::metadataOf(merged.sample.info);
        return proc::writeScatteredCsv(proc::rowsOf(merged.sample), about).bytes;
    }
    if (scattered) {
        return Error{ErrorKind::Usage,
                     "merge: these files hold values at directions of their own, and no cells with "
                     "uncertainties, as a .gonio does: -o OUT.csv"};
    }
    return proc::encodeGonio(merged.sample);
}

}  // namespace

Result<void> merge(const CommonOptions& common, const MergeCommandOptions& options) {
    const auto format = proc::formatToWrite(options.output);
    if (!format || (*format != proc::Format::Gonio && *format != proc::Format::Csv)) {
        return Error{ErrorKind::Usage,
                     "merge: '" + options.output.string() + "': wanted OUT.gonio or OUT.csv"};
    }
    const auto inputs = readMergeInputs(options.files, common.store);
    if (!inputs) return inputs.error();
    const Result<Merged> done = merged(*inputs,
                                       {.plane = options.plane,
                                        .isotropic = options.isotropic,
                                        .reciprocal = options.reciprocal,
                                        .anyCalibration = options.anyCalibration});
    if (!done) return done.error();
    const Result<std::string> bytes = bytesOf(*done, *format);
    if (!bytes) return bytes.error();
    if (Result<void> written = proc::writeFile(options.output, *bytes); !written) return written;
    for (const std::string& note : done->notes) log::warning("merge: " + note);
    for (const proc::Verdict& one : proc::readVerdicts(done->sample.info.qcVerdicts)) {
        if (one.grade == proc::Grade::Warned || one.grade == proc::Grade::Refused)
            log::warning(proc::described(one));
    }
    if (common.json) {
        printJson(documentOf(*done, options));
    } else if (!common.quiet) {
        printReport(*done, options);
    }
    return {};
}

}  // namespace gonio::daemon
