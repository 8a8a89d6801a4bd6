// Anything as Zemax tables, one file for each band.

#include "proc/export/conversion_steps.h"
#include "proc/formats/named_band.h"
#include "proc/formats/zemax.h"
#include "proc/table/specular_fill.h"

namespace gonio::proc {
namespace {

ConvertedFile written(SpecularTable table, const ConversionSource& source, const Channel& channel) {
    Metadata about = source.about;
    const bool says = wavelengthIn(about.comments).has_value();
    if (channel.nanometres && !says) {
        about.comments.push_back(wavelengthComment(*channel.nanometres));
    }
    table.comments = metadataLines(about);
    Written file = writeZemax(table);
    return fileOf(std::move(file));
}

/// The surface's own symmetry and rotations, in steps of one degree or as the grid says.
SpecularGrid gridFor(const ConversionSource& source, const ConversionWish& wish) {
    const auto* table = source.file ? source.file->as<SpecularTable>() : nullptr;
    const auto* spherical = source.file ? source.file->as<SphericalTable>() : nullptr;
    const bool plane = (table != nullptr && table->symmetry == TableSymmetry::PlaneSymmetrical) ||
                       (spherical != nullptr && spherical->planeSymmetrical);
    const bool turned = source.rotationDeg.size() > 1 || source.rotationDeg.front() != 0;
    const double step = wish.grid.stepOr(1);
    return {.symmetry = turned  ? TableSymmetry::Asymmetrical4D
                        : plane ? TableSymmetry::PlaneSymmetrical
                                : TableSymmetry::Asymmetrical,
            .rotationDeg = source.rotationDeg,
            .incidenceDeg = incidencesFor(source, wish),
            .azimuthDeg = stepsTo(plane && !turned ? 180 : 360, step),
            .radialDeg = stepsTo(180, step)};
}

ConvertedFile ofBand(const ConversionSource& source,
                     const ConversionWish& wish,
                     std::optional<Band> band) {
    const Band asked = band.value_or(Band::R);
    FilledTable filled = fillTable(*bandOf(source, asked), gridFor(source, wish), asked);
    const Channel channel = source.monochrome() ? channelsFor(source).front() : Channel::of(asked);
    ConvertedFile file = written(std::move(filled.table), source, channel);
    if (!source.monochrome()) file.suffix = bandSuffix(asked);
    file.loss.add(
        Loss::Masked, "values of exactly 0, which read back as missing", filled.exactZero);
    addPlainLosses(file.loss, source);
    addResampling(
        file, source, {filled.nodes, filled.unanswered, filled.extrapolated}, Format::Zemax, asked);
    return file;
}

/// The format has no table of the LEDs' bands: a monochrome one of each.
std::vector<ConvertedFile> bandByBand(const SpecularTable& table, const ConversionSource& source) {
    std::vector<ConvertedFile> files;
    const bool colour = !source.about.at("colour").empty();  // sRGB has no wavelengths
    for (const Band band : kBands) {
        SpecularTable one = table;
        one.colour = TableColour::Monochrome;
        one.planes = {table.planes[index(band)]};
        files.push_back(written(std::move(one), source, colour ? Channel{} : Channel::of(band)));
        files.back().suffix = bandSuffix(band);
    }
    return files;
}

}  // namespace

Converted toZemax(const ConversionSource& source, const ConversionWish& wish) {
    const auto* table = mayCopy(source, wish) ? source.file->as<SpecularTable>() : nullptr;
    if (table != nullptr && table->colour == TableColour::LedBands) {
        return bandByBand(*table, source);
    }
    if (table != nullptr) {
        return std::vector{written(*table, source, channelsOf(*source.file).front())};
    }
    if (auto answers = mustAnswer(source, Format::Zemax); !answers) return answers.error();
    if (source.bands.empty()) return std::vector{ofBand(source, wish, {})};
    std::vector<ConvertedFile> files;
    for (const Band band : source.bands) files.push_back(ofBand(source, wish, band));
    return files;
}

}  // namespace gonio::proc
