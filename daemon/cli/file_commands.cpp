// Commands on files: info, eval, convert, plot. None of them needs a rig or takes the store's lock.

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/material.h"
#include "proc/core/number_text.h"
#include "proc/core/parallel.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/points_csv.h"
#include "proc/formats/zemax.h"
#include "proc/optics/cell_grid.h"
#include "proc/report/hemisphere_map.h"
#include "proc/report/slice_plot.h"
#include "proc/table/specular_fill.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json degreesOf(const std::vector<Radians>& angles) {
    Json list = Json::array();
    for (Radians angle : angles) list.push_back(std::round(angle.degrees() * 1e6) / 1e6);
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
    json["rig_seconds"] = info.rigSeconds;
    json["compute_seconds"] = info.computeSeconds;
    if (!info.truthSpec.empty()) json["truth"] = info.truthSpec;
    if (!info.budgetJson.empty()) json["budget"] = Json::parse(info.budgetJson, nullptr, false);
    Json leds = Json::array();
    for (const proc::LedTable& led : sample.leds) {
        Json entry;
        entry["theta_i_deg"] = std::round(led.incidence.degrees() * 1e6) / 1e6;
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
                      << (value.is_string() ? value.get<std::string>() : value.dump()) << "\n";
        }
    }
}

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
    std::vector<double> incidences;
    for (Radians i : from.incidences()) incidences.push_back(std::round(i.degrees() * 1e9) / 1e9);
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

}  // namespace

Result<void> info(const CommonOptions& common, const std::string& file) {
    const Result<Material> material = openMaterial(file, common.store);
    if (!material) return material.error();
    Json json = {{"schema", "gonio/info/1"}, {"file", file}, {"kind", material->kind}};
    json["incidences_deg"] = degreesOf(material->incidences());
    json["bands"] = material->scatterer->bandCount() == BandCount::One ? 1 : 3;
    if (material->sample != nullptr) json.update(sampleJson(*material->sample));
    if (material->table != nullptr) json.update(tableJson(*material->table));
    if (common.json) {
        std::cout << json.dump(2) << "\n";
    } else {
        json.erase("schema");
        printPlain(json, "");
    }
    return {};
}

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
        std::cout << Json{{"schema", "gonio/convert/1"}, {"files", files}}.dump(2) << "\n";
    return {};
}

Result<void> plot(const CommonOptions& common, const PlotOptions& options) {
    const Result<Material> material = openMaterial(options.file, common.store);
    if (!material) return material.error();
    std::string name = fs::path(options.file).stem().string();
    if (material->sample != nullptr && !material->sample->info.name.empty())
        name = material->sample->info.name;
    for (char& c : name) {
        if (c == '/' || c == ':' || c == ',' || c == '=') c = '-';
    }
    const proc::PlotRequest request{.title = name, .incidences = material->incidences()};
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
        std::cout
            << Json{{"schema", "gonio/plot/1"}, {"files", {map.string(), slice.string()}}}.dump(2)
            << "\n";
    } else if (!common.quiet) {
        std::cout << map.string() << "\n" << slice.string() << "\n";
    }
    return {};
}

}  // namespace gonio::daemon
