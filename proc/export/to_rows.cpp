// Anything as a list of directions: BiRD, ASTM, pab-opto, ALTA, CSV.

#include <algorithm>
#include <cmath>

#include "proc/export/conversion_steps.h"
#include "proc/export/sample_fill.h"
#include "proc/formats/alta.h"
#include "proc/formats/astm.h"
#include "proc/formats/bird.h"
#include "proc/formats/pab.h"
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
    if (table == nullptr || table->colour == TableColour::LedBands) return std::nullopt;
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

/// A file for each light.
Converted toPab(const BrdfRows& rows, const Metadata& about) {
    Result<WrittenPab> written = writePab(rows, about);
    if (!written) return written.error();
    std::vector<ConvertedFile> files;
    for (PabFile& file : written->files) files.push_back({file.suffix, std::move(file.bytes), {}});
    if (!files.empty()) files.front().loss = std::move(written->loss);
    if (files.size() == 1) files.front().suffix.clear();
    return files;
}

Converted written(const BrdfRows& rows, Format to, const Metadata& about) {
    switch (to) {
        case Format::Bird: return onlyFile(writeBird(rows, about));
        case Format::Astm: return onlyFile(writeAstm(rows, about));
        case Format::Pab: return toPab(rows, about);
        case Format::Alta: return onlyFile(writeAlta(rows, about));
        default: return onlyFile(writeScatteredCsv(rows, about));
    }
}

/// What tables say beside their values, and lists of directions do not.
void addTableLosses(LossReport& loss, const BrdfFile& file) {
    std::size_t totals = 0;
    if (const auto* table = file.as<SpecularTable>()) {
        for (const TablePlane& plane : table->planes) totals += plane.tis.size();
    }
    if (const auto* table = file.as<SphericalTable>()) {
        for (const SphericalBlock& block : table->blocks) totals += std::isnan(block.tis) ? 0U : 1U;
    }
    loss.add(Loss::Dropped, "TIS as stated", totals);
    std::size_t cells = 0;
    if (const auto* sample = file.as<SampleSet>()) {
        for (const LedTable& led : sample->leds) {
            for (const CellSamples& band : led.bands) {
                cells += static_cast<std::size_t>(std::count_if(
                    band.nEff.begin(), band.nEff.end(), [](double n) { return n > 1; }));
            }
        }
    }
    loss.add(Loss::Dropped, "effective numbers of pixels", cells);
}

}  // namespace

Converted toRows(const ConversionSource& source, const ConversionWish& wish) {
    Result<Rows> rows = rowsFor(source, wish);
    if (!rows) return rows.error();
    Converted files = written(rows->rows, wish.to, source.about);
    if (!files || files->empty()) return files;
    LossReport& loss = files->front().loss;
    if (source.file) addTableLosses(loss, *source.file);
    if (!rows->asked) return files;
    loss.items.insert(
        loss.items.begin(),
        {Loss::Resampled, "values asked at the cells of each incidence", rows->asked->nodes});
    addSideLosses(loss, source);
    loss.add(Loss::Extrapolated, "values from beyond what was measured", rows->asked->extrapolated);
    return files;
}

}  // namespace gonio::proc
