// Anything as a list of directions: BiRD, ASTM, pab-opto, ALTA, CSV.

#include <algorithm>

#include "proc/export/conversion_steps.h"
#include "proc/export/sample_fill.h"
#include "proc/formats/bird.h"
#include "proc/formats/scattered_csv.h"
#include "proc/table/rows_of.h"

namespace gonio::proc {
namespace {

struct Rows {
    BrdfRows rows;
    std::optional<Asked> asked;  ///< where they are not the source's own values
};

std::optional<BrdfRows> ownRows(const ConversionSource& source) {
    const BrdfFile& file = *source.file;
    if (const auto* rows = file.as<BrdfRows>()) return *rows;
    if (const auto* sample = file.as<SampleSet>()) return rowsOf(*sample);
    if (const auto* spherical = file.as<SphericalTable>()) return rowsOf(*spherical);
    const auto* table = file.as<SpecularTable>();
    if (table == nullptr) return std::nullopt;
    return rowsOf(*table, channelsFor(source).front());
}

/// Answers at the cells of each incidence.
Rows answered(const ConversionSource& source, const ConversionWish& wish) {
    SampleGrid grid{.incidenceDeg = incidencesFor(source, wish),
                    .rotationDeg = source.rotationDeg,
                    .bands = source.bands};
    if (grid.bands.empty()) grid.bands = {Band::R};
    const FilledSample filled = fillSample(*allBands(source), grid, source.about);
    Rows made{rowsOf(filled.set), Asked{filled.asked, filled.unanswered, filled.extrapolated}};
    if (source.monochrome()) made.rows.channels = channelsFor(source);
    return made;
}

Result<Rows> rowsFor(const ConversionSource& source, const ConversionWish& wish) {
    if (mayCopy(source, wish)) {
        if (auto own = ownRows(source)) return Rows{std::move(*own), {}};
    }
    if (auto answers = mustAnswer(source, wish.to); !answers) return answers.error();
    return answered(source, wish);
}

std::vector<ConvertedFile> one(Written file) {
    return {ConvertedFile{"", std::move(file.bytes), std::move(file.loss)}};
}

std::vector<ConvertedFile> written(const BrdfRows& rows, Format to, const Metadata& about) {
    return to == Format::Bird ? one(writeBird(rows, about)) : one(writeScatteredCsv(rows, about));
}

}  // namespace

Converted toRows(const ConversionSource& source, const ConversionWish& wish) {
    Result<Rows> rows = rowsFor(source, wish);
    if (!rows) return rows.error();
    std::vector<ConvertedFile> files = written(rows->rows, wish.to, source.about);
    if (rows->asked) {
        files.front().loss.items.insert(
            files.front().loss.items.begin(),
            {Loss::Resampled, "values asked at the cells of each incidence", rows->asked->nodes});
        files.front().loss.add(
            Loss::Extrapolated, "values from beyond what was measured", rows->asked->extrapolated);
    }
    return files;
}

}  // namespace gonio::proc
