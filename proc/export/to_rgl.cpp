// Anything as an RGL tensor file, which renderers load as a measured material.

#include "proc/export/conversion_steps.h"
#include "proc/export/tensor_fit.h"
#include "proc/formats/rgl.h"

namespace gonio::proc {
namespace {

/// What answers between its incidences is asked at the usual ones; a table of a few incidences at
/// its own, as renderers are better between them than a look-up is.
TensorFitOptions optionsFor(const ConversionSource& source, const ConversionWish& wish) {
    TensorFitOptions options;
    const bool few = source.file && !incidencesOf(*source.file).empty() && !source.estimated;
    if (wish.grid.incidenceDeg) {
        options.thetaInDeg = *wish.grid.incidenceDeg;
    } else if (few) {
        options.thetaInDeg = source.incidenceDeg;
    }
    if (source.rotationDeg.size() > 1) {
        options.phiInDeg.clear();
        for (int phi = -180; phi <= 180; phi += 15) options.phiInDeg.push_back(phi);
    }
    return options;
}

}  // namespace

Converted toRgl(const ConversionSource& source, const ConversionWish& wish) {
    const auto* table = mayCopy(source, wish) ? source.file->as<TensorTable>() : nullptr;
    if (table == nullptr) {
        if (auto answers = mustAnswer(source, Format::Rgl); !answers) return answers.error();
        if (auto three = mustHaveThree(source, Format::Rgl); !three) return three.error();
    }
    const FittedTensor fitted =
        table != nullptr ? FittedTensor{} : fitTensor(*allBands(source), optionsFor(source, wish));
    Result<Written> written = writeRgl(table != nullptr ? *table : fitted.table, source.about);
    if (!written) return written.error();
    ConvertedFile file = fileOf(std::move(*written));
    if (table != nullptr) return std::vector{std::move(file)};
    addPlainLosses(file.loss, source);
    file.loss.add(
        Loss::Extrapolated, "values that stand for directions without an answer", fitted.filled);
    file.loss.add(Loss::Clamped, "negative values, written as 0", fitted.negative);
    addResampling(file, source, {fitted.nodes, 0, fitted.extrapolated}, Format::Rgl);
    return std::vector{std::move(file)};
}

}  // namespace gonio::proc
