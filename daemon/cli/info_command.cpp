// gonio info: what a file holds, for people and for machines.

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/budget_table.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/estimator_facts.h"
#include "daemon/cli/file_facts_json.h"
#include "daemon/cli/output.h"
#include "daemon/estimators.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/sniff.h"
#include "proc/optics/cell_grid.h"
#include "proc/quality/verdict.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json degreesOf(const std::vector<Radians>& angles) {
    Json list = Json::array();
    for (Radians angle : angles) list.push_back(proc::fileDegrees(angle));
    return list;
}

Json sampleJson(const proc::SampleSet& sample) {
    Json json;
    const proc::SampleInfo& info = sample.info;
    json["name"] = info.name;
    json["rig"] = info.rigSerial;
    json["calibration"] = info.calibrationId;
    json["date"] = info.dateUtc;
    json["effort"] = info.effort;
    json["notes"] = info.operatorNotes;
    json["software"] = info.softwareVersion;
    json["reference"] = info.referenceCertificate;
    json["profile_hash"] = info.profileHash;
    json["session"] = info.session;
    json["qc"] = Json::parse(proc::verdictsText(proc::readVerdicts(info.qcVerdicts)));
    json["interruptions"] = info.interruptions;
    json["requested_uncertainty"] =
        info.requestedUncertainty ? Json(*info.requestedUncertainty) : Json();
    json["achieved_uncertainty"] =
        info.achievedUncertainty ? Json(*info.achievedUncertainty) : Json();
    json["wavelengths_nm"] = kBandNanometres;
    json["extra"] = info.extra;
    json["rig_seconds"] = info.rigSeconds;
    json["compute_seconds"] = info.computeSeconds;
    if (!info.truthSpec.empty()) json["truth"] = info.truthSpec;
    if (!info.budgetJson.empty()) json["budget"] = budgetJson(proc::readBudget(info.budgetJson));
    Json leds = Json::array();
    for (const proc::LedTable& led : sample.leds) {
        Json entry;
        entry["theta_i_deg"] = proc::fileDegrees(led.incidence);
        entry["rotation_deg"] = proc::fileDegrees(led.rotation);
        for (Band b : kBands) {
            const proc::CellSamples& cells = led.bands[index(b)];
            int measured = 0;
            double solidAngle = 0, reflected = 0;
            for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                if (!cells.present(cell)) continue;
                ++measured;
                const double omega = proc::CellGrid::solidAngle(cell);
                solidAngle += omega;
                reflected += cells.f[cell] * proc::CellGrid::centre(cell).z() * omega;
            }
            entry[std::string(letter(b))] = {{"measured_cells", measured},
                                             {"solid_angle_sr", solidAngle},
                                             {"reflected_fraction_within_measured", reflected}};
        }
        leds.push_back(entry);
    }
    json["leds"] = leds;
    return json;
}

Json tableJson(const proc::SpecularTable& table) {
    Json json;
    json["incidences_deg"] = table.incidenceDeg;
    json["rotations_deg"] = table.rotationDeg;
    json["azimuths"] = table.azimuthDeg.size();
    json["radials"] = table.radialDeg.size();
    json["plane_symmetrical"] = table.symmetry == proc::TableSymmetry::PlaneSymmetrical;
    json["planes"] = table.planes.size();
    Json tis = Json::array();
    for (const proc::TablePlane& plane : table.planes) tis.push_back(plane.tis);
    json["tis_as_written"] = tis;
    json["comments"] = table.comments;
    return json;
}

/// A nested document as indented lines, for people.
void printPlain(const Json& json, const std::string& indent) {
    for (const auto& [key, value] : json.items()) {
        if (value.is_object() ||
            (value.is_array() && !value.empty() && value.front().is_structured())) {
            std::cout << indent << key << ":\n";
            printPlain(value, indent + "  ");
        } else {
            std::cout << indent << key << ": "
                      << (value.is_string()
                              ? value.get<std::string>()
                              : value.dump(-1, ' ', false, Json::error_handler_t::replace))
                      << "\n";
        }
    }
}

/// Each verdict as one line under its name.
Json withReadableVerdicts(Json facts) {
    const auto found = facts.find("qc");
    if (found == facts.end() || found->empty()) return facts;
    Json lines = Json::object();
    for (const proc::Verdict& verdict : proc::readVerdicts(found->dump())) {
        const std::string line = proc::described(verdict);
        lines[verdict.name] = line.substr(std::min(line.size(), verdict.name.size() + 2));
    }
    *found = std::move(lines);
    return facts;
}

Json rawJson(const proc::RawCapture& capture) {
    Json json = {{"kind", "graw"}, {"about", capture.info}};
    Json states = Json::array();
    for (const proc::RawState& state : capture.states) {
        const proc::MergedState& merged = state.merged;
        Json bracket = Json::array();
        for (const proc::RawExposure& exposure : state.bracket) {
            Json celsius = Json::array();
            for (const auto& c : exposure.celsius) celsius.push_back(c ? Json(*c) : Json());
            bracket.push_back(
                {{"exposure_us", static_cast<double>(exposure.granted.count()) * 1e-3},
                 {"level", exposure.level},
                 {"frames", exposure.frames},
                 {"black_level", exposure.blackLevel},
                 {"celsius", celsius}});
        }
        states.push_back(
            {{"led", merged.led},
             {"band", std::string(letter(merged.band))},
             {"width", merged.radiance.width()},
             {"height", merged.radiance.height()},
             {"pixels_saturated_in_every_frame", merged.allSaturatedPixels},
             {"chi_square_per_freedom",
              merged.freedom > 0 ? Json(merged.chiSquare / static_cast<double>(merged.freedom))
                                 : Json()},
             {"bracket", bracket}});
    }
    json["states"] = states;
    return json;
}

struct Info {
    Json file;
    std::vector<proc::StateBudget> budget;    ///< of a measured sample
    std::optional<EstimatorFacts> estimator;  ///< where one was asked for
    std::optional<proc::FileFacts> values;    ///< of a file
};

Json aboutJson(const proc::Metadata& about) {
    Json json = Json::object();
    for (const auto& [name, value] : about.values) json[name] = value;
    return json;
}

/// Of a format that is none of our own.
Json otherJson(const proc::BrdfFile& file) {
    return {{"title", factsOf(file.format).title},
            {"about", aboutJson(file.about)},
            {"comments", file.about.comments}};
}

Result<Info> infoOfModel(const CommonOptions& common, const InfoOptions& options) {
    const Result<Estimated> opened =
        openEstimated(options.file, common.store, {.name = options.estimator});
    if (!opened) return opened.error();
    Info info{{{"kind", "model"}}, {}, {}, {}};
    info.file["incidences_deg"] = degreesOf(opened->incidences());
    info.file["bands"] = opened->scatterer->bandCount() == BandCount::One ? 1 : 3;
    if (options.estimator != "none") info.estimator = estimatorFacts(*opened, options.estimator);
    return info;
}

Result<Info> infoOfRaw(const std::filesystem::path& path, const InfoOptions& options) {
    if (options.estimator != "none") {
        return Error{ErrorKind::Usage,
                     "info: '" + options.file + "' is a raw capture: it has no --estimator"};
    }
    const Result<proc::RawCapture> capture = proc::readGraw(path);
    if (!capture) return capture.error();
    return Info{rawJson(*capture), {}, {}, {}};
}

Result<Info> infoOf(const CommonOptions& common, const InfoOptions& options) {
    if (options.file.starts_with("model:")) return infoOfModel(common, options);
    const auto path = fileOf(options.file, common.store);
    if (!path) return path.error();
    const Result<proc::Format> format =
        options.from.empty() ? proc::sniffFile(*path) : proc::parseFormat(options.from);
    if (!format) return format.error();
    if (*format == proc::Format::Graw) return infoOfRaw(*path, options);
    Result<proc::BrdfFile> file = proc::readBrdf(*path, *format);
    if (!file) return file.error();
    Info info{{{"kind", name(*format)}}, {}, {}, proc::fileFacts(*file)};
    info.file["incidences_deg"] = info.values->incidencesDeg;
    info.file["bands"] = proc::channelsOf(*file).size();
    const auto* sample = file->as<proc::SampleSet>();
    const auto* table = *format == proc::Format::Zemax ? file->as<proc::SpecularTable>() : nullptr;
    if (sample != nullptr) {
        info.file.update(sampleJson(*sample));
        info.budget = proc::readBudget(sample->info.budgetJson);
    } else if (table != nullptr) {
        info.file.update(tableJson(*table));
    } else {
        info.file.update(otherJson(*file));
    }
    if (options.estimator != "none") {
        const auto opened = estimated(std::move(*file), {.name = options.estimator});
        if (!opened) return opened.error().in("info: '" + options.file + "'");
        info.estimator = estimatorFacts(*opened, options.estimator);
    }
    return info;
}

}  // namespace

Result<void> info(const CommonOptions& common, const InfoOptions& options) {
    const Result<Info> found = infoOf(common, options);
    if (!found) return found.error();
    if (common.json) {
        Json json = {{"schema", "gonio/info/1"}, {"file", options.file}};
        json.update(found->file);
        if (found->values) json["values"] = toJson(*found->values);
        if (found->estimator) json["estimator"] = toJson(*found->estimator);
        printJson(json);
        return {};
    }
    std::cout << "file: " << options.file << "\n";
    Json plain = withReadableVerdicts(found->file);
    const std::string budget = budgetTable(found->budget);
    if (!budget.empty()) plain.erase("budget");
    printPlain(plain, "");
    if (!budget.empty()) {
        std::cout << "budget, standard uncertainties, medians over cells and states:\n" << budget;
    }
    if (found->values) printFacts(*found->values);
    if (found->estimator) print(*found->estimator);
    return {};
}

}  // namespace gonio::daemon
