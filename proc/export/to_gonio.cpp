// Anything as a measured sample.

#include "proc/export/conversion_steps.h"
#include "proc/export/sample_fill.h"
#include "proc/formats/gonio_exr.h"
#include "proc/table/rows_of.h"

namespace gonio::proc {
namespace {

Result<ConvertedFile> encoded(const SampleSet& set) {
    Result<std::string> bytes = encodeGonio(set);
    if (!bytes) return bytes.error();
    return ConvertedFile{"", std::move(*bytes), {}};
}

/// Rows into the cells that hold their directions.
Result<ConvertedFile> ofRows(const BrdfRows& rows, const ConversionSource& source) {
    BrdfRows named = rows;
    if (named.channels.size() == 1 && source.bands.size() == 1) {
        named.channels[0].name = Channel::of(source.bands[0]).name;
    }
    Result<SampleOfRows> sample = sampleOf(named, source.about);
    if (!sample) return sample.error();
    Result<ConvertedFile> file = encoded(sample->set);
    if (!file) return file;
    file->loss.add(Loss::Resampled, "values moved to the centre of their cell", sample->offCentre);
    file->loss.add(Loss::Resampled, "values averaged with others of their cell", sample->averaged);
    file->loss.add(Loss::Dropped, "values at or below the horizon", sample->leftOut);
    file->loss.add(
        Loss::Resampled, "bands made of neighbouring wavelengths", sample->bandsResampled ? 3 : 0);
    return file;
}

Result<ConvertedFile> ofAnswers(const ConversionSource& source, const ConversionWish& wish) {
    const SampleGrid grid{.incidenceDeg = incidencesFor(source, wish),
                          .rotationDeg = source.rotationDeg,
                          .bands = source.bands};
    const FilledSample filled = fillSample(*allBands(source), grid, source.about);
    Result<ConvertedFile> file = encoded(filled.set);
    if (!file) return file;
    if (source.file) addPlainLosses(file->loss, source);
    addResampling(
        *file, source, {filled.asked, filled.unanswered, filled.extrapolated}, Format::Gonio);
    return file;
}

}  // namespace

Converted toGonio(const ConversionSource& source, const ConversionWish& wish) {
    if (!source.noBands.empty()) return Error{ErrorKind::Usage, source.noBands};
    if (source.bands.empty()) {
        return Error{ErrorKind::Usage,
                     "one value per pair, and neither its wavelength nor its name tells of which "
                     "band: say --bands r, g or b (g=2 of the second of several)"};
    }
    const bool copy = mayCopy(source, wish);
    const auto* sample = copy ? source.file->as<SampleSet>() : nullptr;
    const auto* rows = copy ? source.file->as<BrdfRows>() : nullptr;
    if (sample == nullptr && rows == nullptr) {
        if (auto answers = mustAnswer(source, Format::Gonio); !answers) return answers.error();
    }
    Result<ConvertedFile> file = sample != nullptr ? encoded(*sample)
                                 : rows != nullptr ? ofRows(*rows, source)
                                                   : ofAnswers(source, wish);
    if (!file) return file.error();
    if (!source.about.at("colour").empty()) {
        file->loss.add(Loss::Dropped, "wavelengths: linear sRGB stands in the LEDs' bands", 1);
    }
    return std::vector{std::move(*file)};
}

}  // namespace gonio::proc
