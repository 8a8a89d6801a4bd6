// Anything as a MERL table.

#include "proc/export/conversion_steps.h"
#include "proc/export/half_difference_fill.h"
#include "proc/formats/merl.h"

namespace gonio::proc {

Converted toMerl(const ConversionSource& source, const ConversionWish& wish) {
    const auto* table = mayCopy(source, wish) ? source.file->as<HalfDifferenceTable>() : nullptr;
    if (table != nullptr) {
        Written file = writeMerl(*table, source.about);
        return std::vector{fileOf(std::move(file))};
    }
    if (auto answers = mustAnswer(source, Format::Merl); !answers) return answers.error();
    if (auto three = mustHaveThree(source, Format::Merl); !three) return three.error();
    const FilledHalfDifference filled = fillHalfDifference(*allBands(source));
    Written written = writeMerl(filled.table, source.about);
    ConvertedFile file = fileOf(std::move(written));
    addPlainLosses(file.loss, source);
    file.loss.add(
        Loss::Dropped, "rotations of the sample but the first", source.rotationDeg.size() - 1);
    if (source.monochrome()) {
        file.loss.add(Loss::Dropped, "wavelength: one value stands in R, G and B", 1);
    }
    addResampling(file, source, {filled.nodes, 0, filled.extrapolated}, Format::Merl);
    return std::vector{std::move(file)};
}

}  // namespace gonio::proc
