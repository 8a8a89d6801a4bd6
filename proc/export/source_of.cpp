#include "proc/export/source_of.h"

#include "proc/formats/file_degrees.h"
#include "proc/formats/open.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

const std::vector<double> kLedIncidences{0, 20, 40, 60};

std::vector<double> degreesOf(const std::vector<Radians>& angles) {
    std::vector<double> degrees;
    for (const Radians angle : angles) degrees.push_back(fileDegrees(angle));
    return degrees;
}

std::vector<double> rotationsDeg(const BrdfFile& file) {
    std::vector<double> degrees{0};
    if (const auto* sample = file.as<SampleSet>()) degrees = degreesOf(rotationsOf(*sample));
    if (const auto* table = file.as<SpecularTable>()) degrees = table->rotationDeg;
    return degrees.empty() ? std::vector<double>{0} : degrees;
}

}  // namespace

Result<ConversionSource> sourceOf(BrdfFile file, const BandChoice& choice) {
    Result<BrdfFile> kept = chosen(std::move(file), choice);
    if (!kept) return kept.error();
    ConversionSource source{.about = kept->about};
    source.about.values.erase(std::string(key::kCosine));  // what is written is f
    source.file = std::make_shared<const BrdfFile>(std::move(*kept));
    // X, Y, Z and wavelengths that are no bands can still be copied.
    if (auto bands = bandsOf(*source.file)) source.bands = std::move(*bands);
    if (auto lookup = lookupOver(*source.file)) source.scatterer = std::move(*lookup);
    source.incidenceDeg = degreesOf(incidencesOf(*source.file));
    if (source.incidenceDeg.empty() || source.incidenceDeg.size() > kMostFileIncidences) {
        source.incidenceDeg = kLedIncidences;
    }
    source.rotationDeg = rotationsDeg(*source.file);
    return source;
}

ConversionSource sourceOf(std::shared_ptr<const Scatterer> formula, Metadata about) {
    ConversionSource source{.incidenceDeg = kLedIncidences, .about = std::move(about)};
    if (formula->bandCount() == BandCount::Three) source.bands.assign(kBands.begin(), kBands.end());
    source.scatterer = std::move(formula);
    return source;
}

}  // namespace gonio::proc
