#include "daemon/exports.h"

#include <array>
#include <cctype>

#include "proc/formats/file_degrees.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/points_csv.h"
#include "proc/formats/zemax.h"
#include "proc/table/rotations.h"
#include "proc/table/specular_fill.h"

namespace gonio::daemon {
namespace {

struct Format {
    ExportFormat format;
    std::string_view name;
    std::string_view extension;
};

constexpr std::array<Format, 3> kFormats{{{ExportFormat::Gonio, "gonio", ".gonio"},
                                          {ExportFormat::Zemax, "zemax", ".bsdf"},
                                          {ExportFormat::Csv, "csv", ".csv"}}};

const Format& entry(ExportFormat format) { return kFormats[static_cast<std::size_t>(format)]; }

std::string suffixOf(Band band) {
    return std::string("_") + static_cast<char>(std::toupper(letter(band).front()));
}

ExportedFile zemaxFile(const Scatterer& from, const proc::SpecularGrid& grid, Band band) {
    const bool mono = from.bandCount() == BandCount::One;
    proc::FilledTable filled = proc::fillTable(from, grid, band);
    if (!mono) filled.table.comments.push_back(proc::wavelengthComment(band));
    proc::Written written = proc::writeZemax(filled.table);
    written.loss.add(
        proc::Loss::Masked, "nodes without an answer, written as 0", filled.unanswered);
    written.loss.add(
        proc::Loss::Masked, "answers of exactly 0, which read back as missing", filled.exactZero);
    written.loss.add(proc::Loss::Dropped, "uncertainties left out", filled.uncertain);
    written.loss.add(proc::Loss::Extrapolated,
                     "answers beyond what was measured, extrapolated",
                     filled.extrapolated);
    return {mono ? "" : suffixOf(band), std::move(written.bytes), std::move(written.loss)};
}

/// The stage's rotations, where the sample was ever turned.
void turnAsMeasured(proc::SpecularGrid& grid, const Material& surface) {
    std::vector<double> deg;
    if (surface.table != nullptr) {
        deg = surface.table->rotationDeg;
    } else if (surface.sample != nullptr) {
        for (const Radians one : proc::rotationsOf(*surface.sample)) {
            deg.push_back(proc::fileDegrees(one));
        }
    }
    if (deg.empty() || (deg.size() == 1 && deg.front() == 0)) return;
    grid.symmetry = proc::TableSymmetry::Asymmetrical4D;
    grid.rotationDeg = std::move(deg);
}

std::vector<ExportedFile> zemaxFiles(const Material& surface,
                                     const Scatterer& from,
                                     std::optional<Band> only) {
    std::vector<double> incidences;
    for (Radians i : surface.incidences()) incidences.push_back(proc::fileDegrees(i));
    auto grid = proc::SpecularGrid::oneDegree(incidences, proc::TableSymmetry::Asymmetrical);
    turnAsMeasured(grid, surface);
    const bool mono = from.bandCount() == BandCount::One;
    std::vector<ExportedFile> files;
    for (Band band : kBands) {
        const bool wanted = mono ? band == Band::R : !only || *only == band;
        if (wanted) files.push_back(zemaxFile(from, grid, band));
    }
    return files;
}

}  // namespace

std::string_view name(ExportFormat format) { return entry(format).name; }
std::string_view extension(ExportFormat format) { return entry(format).extension; }

Result<ExportFormat> parseExportFormat(std::string_view text) {
    for (const Format& known : kFormats) {
        if (known.name == text) return known.format;
    }
    return Error{ErrorKind::Usage,
                 "format '" + std::string(text) + "': wanted gonio, zemax or csv"};
}

std::optional<ExportFormat> formatOfExtension(std::string_view extension) {
    for (const Format& known : kFormats) {
        if (known.extension == extension) return known.format;
    }
    return std::nullopt;
}

Result<std::vector<ExportedFile>> exportAs(const Material& surface,
                                           ExportFormat format,
                                           std::optional<Band> only) {
    if (format == ExportFormat::Zemax && surface.table != nullptr) {  // as it is
        proc::Written written = proc::writeZemax(*surface.table);
        return std::vector<ExportedFile>{{"", std::move(written.bytes), std::move(written.loss)}};
    }
    if (format == ExportFormat::Zemax) return zemaxFiles(surface, *surface.scatterer, only);
    if (surface.sample == nullptr) {
        return Error{
            ErrorKind::Usage,
            "only a .gonio becomes " + std::string(name(format)) + "; this is a " + surface.kind};
    }
    if (format == ExportFormat::Csv) {
        return std::vector<ExportedFile>{{"", proc::sampleCsv(*surface.sample), {}}};
    }
    Result<std::string> bytes = proc::encodeGonio(*surface.sample);
    if (!bytes) return bytes.error();
    return std::vector<ExportedFile>{{"", std::move(*bytes), {}}};
}

std::vector<ExportedFile> exportFilled(const Material& surface, const Scatterer& estimator) {
    return zemaxFiles(surface, estimator, {});
}

}  // namespace gonio::daemon
