#include "proc/export/source_of.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/open.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

const std::vector<double> kLedIncidences{0, 20, 40, 60};

std::vector<double> degreesOf(const std::vector<Radians>& angles) {
    std::vector<double> degrees;
    degrees.reserve(angles.size());
    for (const Radians angle : angles) degrees.push_back(fileDegrees(angle));
    return degrees;
}

/// The sample's rotations under one light: light azimuth a is rotation -a.
std::vector<double> rotationsOfLights(const std::set<double>& azimuthsDeg) {
    std::set<double> rotations;
    for (const double azimuth : azimuthsDeg) rotations.insert(fileDegrees(rotationOf(-azimuth)));
    return {rotations.begin(), rotations.end()};
}

std::vector<double> rotationsDeg(const BrdfFile& file) {
    if (const auto* sample = file.as<SampleSet>()) return degreesOf(rotationsOf(*sample));
    if (const auto* table = file.as<SpecularTable>()) return table->rotationDeg;
    std::set<double> azimuths;
    if (const auto* table = file.as<SphericalTable>(); table != nullptr && !table->isotropic()) {
        for (const SphericalBlock& block : table->blocks) azimuths.insert(block.lightAzimuthDeg);
    }
    if (const auto* table = file.as<TensorTable>(); table != nullptr && !table->isotropic()) {
        for (int azimuth = 0; azimuth < 360; azimuth += 30) azimuths.insert(azimuth);
    }
    return rotationsOfLights(azimuths);
}

/// So many that all tables of a sample can be held: every second, every third, ...
std::vector<double> held(const std::vector<double>& rotations, std::size_t incidences) {
    const std::size_t most =
        std::max<std::size_t>(1, kMostTables / std::max<std::size_t>(1, incidences));
    const std::size_t stride = (rotations.size() + most - 1) / most;
    std::vector<double> kept;
    for (std::size_t i = 0; i < rotations.size(); i += std::max<std::size_t>(1, stride)) {
        kept.push_back(rotations[i]);
    }
    return kept;
}

std::size_t lightAzimuthsOf(const BrdfFile& file, std::size_t rotations) {
    const auto* rows = file.as<BrdfRows>();
    if (rows == nullptr || rows->isotropic) return std::max<std::size_t>(1, rotations);
    std::set<long long> azimuths;
    for (const LightView& pair : rows->pairs) {
        azimuths.insert(std::llround(pair.in.phi().degrees() * 1e6));
    }
    return azimuths.size();
}

/// A cell of a measured sample holds the mean over its solid angle: all are as good as equal.
void addSolidAngle(ConversionSource& source) {
    const bool said = !source.about.at(key::kSolidAngle).empty();
    if (said || source.file->as<SampleSet>() == nullptr) return;
    const double mean = 2 * kPi / static_cast<double>(CellGrid::count());
    source.about.set(key::kSolidAngle, shortest(static_cast<float>(mean)));
}

}  // namespace

Result<ConversionSource> sourceOf(BrdfFile file, const BandChoice& choice) {
    Result<BrdfFile> kept = chosen(std::move(file), choice);
    if (!kept) return kept.error();
    ConversionSource source{.about = kept->about};
    source.about.values.erase(std::string(key::kCosine));  // what is written is f
    source.file = std::make_shared<const BrdfFile>(std::move(*kept));
    addSolidAngle(source);
    // X, Y, Z and wavelengths that are no bands can still be copied.
    if (auto bands = bandsOf(*source.file)) {
        source.bands = std::move(*bands);
    } else {
        source.noBands = bands.error().message;
    }
    if (auto lookup = lookupOver(*source.file)) {
        source.scatterer = std::move(*lookup);
    } else {
        source.noScatterer = lookup.error().message;
    }
    source.incidenceDeg = degreesOf(incidencesOf(*source.file));
    if (source.incidenceDeg.empty() || source.incidenceDeg.size() > kMostFileIncidences) {
        source.incidenceDeg = kLedIncidences;
    }
    const std::vector<double> rotations = rotationsDeg(*source.file);
    source.lightAzimuths = lightAzimuthsOf(*source.file, rotations.size());
    source.rotationDeg = held(rotations, source.incidenceDeg.size());
    if (source.rotationDeg.empty()) source.rotationDeg = {0};
    return source;
}

ConversionSource sourceOf(std::shared_ptr<const Scatterer> formula, Metadata about) {
    ConversionSource source{.incidenceDeg = kLedIncidences, .about = std::move(about)};
    if (formula->bandCount() == BandCount::Three) source.bands.assign(kBands.begin(), kBands.end());
    source.scatterer = std::move(formula);
    return source;
}

}  // namespace gonio::proc
