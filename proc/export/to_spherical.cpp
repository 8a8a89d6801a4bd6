// Anything as blocks of normal-relative directions: LightTools, Speos, SSDD, UTIA, .mbsdf.

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/export/conversion_steps.h"
#include "proc/export/spherical_fill.h"
#include "proc/formats/lighttools.h"
#include "proc/formats/mbsdf.h"
#include "proc/formats/speos.h"
#include "proc/formats/ssdd.h"
#include "proc/formats/utia.h"
#include "proc/table/specular_fill.h"

namespace gonio::proc {
namespace {

/// UTIA and .mbsdf have one grid each.
bool hasOwnGrid(Format to) { return to == Format::Utia || to == Format::Mbsdf; }

/// Blocks in the order of channels, light azimuths, incidences, all NaN.
SphericalTable evenGrid(const ConversionSource& source, const ConversionWish& wish) {
    SphericalTable grid;
    grid.channels = channelsFor(source);
    SphericalBlock block;
    block.azimuthDeg = stepsTo(360, wish.grid.stepOr(1));
    block.thetaDeg = stepsTo(90, wish.grid.stepOr(1));
    block.f.assign(block.azimuthDeg.size() * block.thetaDeg.size(),
                   std::numeric_limits<double>::quiet_NaN());
    for (block.channel = 0; block.channel < grid.channels.size(); ++block.channel) {
        for (const double rotation : source.rotationDeg) {
            block.lightAzimuthDeg = rotation == 0 ? 0 : 360 - rotation;
            for (const double incidence : incidencesFor(source, wish)) {
                block.incidenceDeg = incidence;
                grid.blocks.push_back(block);
            }
        }
    }
    return grid;
}

Result<SphericalTable> gridFor(const ConversionSource& source, const ConversionWish& wish) {
    if (wish.to == Format::Utia) return utiaGrid();
    if (wish.to == Format::Mbsdf) {
        const double step = wish.grid.stepOr(1);
        const auto cells = static_cast<std::size_t>(90 / step + 0.5);
        return mbsdfGrid(channelsFor(source), {.thetas = cells, .azimuths = 2 * cells});
    }
    return evenGrid(source, wish);
}

/// What each light direction sends back, band by band; its grid's own values do not say.
void addTotals(SphericalTable& table, const ConversionSource& source) {
    const auto surface = allBands(source);
    for (SphericalBlock& block : table.blocks) {
        const Direction wi = table.pairAt(block, 0, 0).in;
        block.tis = totalScatter(*surface, wi, kBands[block.channel]);
    }
}

bool hasMissing(const SphericalTable& table) {
    return std::any_of(table.blocks.begin(), table.blocks.end(), [](const SphericalBlock& block) {
        return std::any_of(block.f.begin(), block.f.end(), [](double f) { return std::isnan(f); });
    });
}

/// Missing values become 0: where there is a place for it, the file says so.
Result<Written> written(const SphericalTable& table, const ConversionWish& wish, Metadata about) {
    if (hasMissing(table) && wish.to != Format::Utia) about.set(key::kMissing, "0");
    switch (wish.to) {
        case Format::LightTools: return writeLightTools(table, about);
        case Format::Speos:
            return table.isotropic() && !wish.anisotropic ? writeSpeosBrdf(table, about)
                                                          : writeSpeosAnisotropic(table, about);
        case Format::Ssdd: return writeSsdd(table, about);
        case Format::Utia: return writeUtia(table, about);
        default: return writeMbsdf(table, about);
    }
}

}  // namespace

Converted toSpherical(const ConversionSource& source, const ConversionWish& wish) {
    const auto* table = mayCopy(source, wish) ? source.file->as<SphericalTable>() : nullptr;
    const bool own = !hasOwnGrid(wish.to) || (source.file && source.file->format == wish.to);
    if (table != nullptr && own) return onlyFile(written(*table, wish, source.about));
    if (auto answers = mustAnswer(source, wish.to); !answers) return answers.error();
    if (hasOwnGrid(wish.to)) {
        if (auto three = mustHaveThree(source, wish.to); !three) return three.error();
    }
    Result<SphericalTable> grid = gridFor(source, wish);
    if (!grid) return grid.error();
    FilledSpherical filled = fillSpherical(*allBands(source), std::move(*grid));
    if (!hasOwnGrid(wish.to)) addTotals(filled.table, source);
    Converted files = onlyFile(written(filled.table, wish, source.about));
    if (!files) return files;
    addPlainLosses(files->front().loss, source);
    const bool one = wish.to == Format::Mbsdf;
    files->front().loss.add(Loss::Dropped,
                            "rotations of the sample but the first",
                            one ? source.rotationDeg.size() - 1 : 0);
    addResampling(files->front(), source, {filled.nodes, 0, filled.extrapolated}, wish.to);
    return files;
}

}  // namespace gonio::proc
