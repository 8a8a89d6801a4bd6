#include "proc/table/scattered_of.h"

#include <algorithm>

#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

using Bands = std::vector<Band>;

bool usableIn(const LedTable& led, const Bands& bands, std::size_t cell) {
    return std::all_of(
        bands.begin(), bands.end(), [&](Band band) { return led.bands[index(band)].usable(cell); });
}

/// One band of several stands for itself, a single one for all three.
LedBands spread(const Bands& bands, const LedBands& values) {
    return bands.size() == 1 ? LedBands::all(values[bands.front()]) : values;
}

ScatteredSample sampleAt(const LedTable& led, const Bands& bands, std::size_t cell) {
    LedBands f, uRandom, uSystematic;
    Flags flags;
    for (const Band band : bands) {
        const Measured<double> value = led.bands[index(band)].at(cell);
        f[band] = value.value;
        uRandom[band] = value.uRandom;
        uSystematic[band] = value.uSystematic;
        flags = flags | value.flags;
    }
    return {.pair = pairInSample(led, CellGrid::centre(cell)),
            .f = spread(bands, f),
            .uRandom = spread(bands, uRandom),
            .uSystematic = spread(bands, uSystematic),
            .flags = flags};
}

Result<Scattered> scatteredFrom(const std::vector<ScatteredSample>& samples,
                                ScatteredSet into,
                                std::size_t leftOut) {
    Scattered made{std::move(into), leftOut};
    if (const auto added = made.set.add(samples); !added) return added.error();
    return made;
}

PairSymmetry symmetryOf(const SpecularTable& table) {
    if (table.rotationDeg.size() > 1) return PairSymmetry::None;
    return table.symmetry == TableSymmetry::PlaneSymmetrical ? PairSymmetry::Plane
                                                             : PairSymmetry::Isotropic;
}

}  // namespace

Result<Scattered> scatteredOf(const SampleSet& sample,
                              std::optional<Band> only,
                              std::optional<PairSymmetry> symmetry) {
    const Bands bands = only ? Bands{*only} : Bands(kBands.begin(), kBands.end());
    std::vector<ScatteredSample> samples;
    std::size_t leftOut = 0;
    for (const LedTable& led : sample.leds) {
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            if (usableIn(led, bands, cell)) {
                samples.push_back(sampleAt(led, bands, cell));
            } else {
                ++leftOut;
            }
        }
    }
    const bool turned = rotationsOf(sample).size() > 1;
    const PairSymmetry least = turned ? PairSymmetry::None : PairSymmetry::Isotropic;
    return scatteredFrom(
        samples,
        ScatteredSet(symmetry.value_or(least), only ? BandCount::One : BandCount::Three),
        leftOut);
}

Result<Scattered> scatteredOf(const SpecularTable& table) {
    if (table.kind == ScatterKind::Btdf || table.colour == TableColour::Xyz) {
        return Error{
            ErrorKind::Usage,
            "scattered samples: a table of f in reflection and of the LED bands is wanted"};
    }
    std::vector<ScatteredSample> samples;
    std::size_t leftOut = 0;
    for (TableNode n; n.rotation < table.rotationDeg.size(); ++n.rotation) {
        for (n.incidence = 0; n.incidence < table.incidenceDeg.size(); ++n.incidence) {
            for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
                for (n.radial = 0; n.radial < table.radialDeg.size(); ++n.radial) {
                    if (!table.canHoldData(n) || table.repeatsDirection(n)) continue;
                    if (!table.hasData(n)) {
                        ++leftOut;
                        continue;
                    }
                    samples.push_back({.pair = table.pairAt(n),
                                       .f = table.bandsAt(n),
                                       .uRandom = {},
                                       .uSystematic = {}});
                }
            }
        }
    }
    const auto bands = table.planes.size() == 3 ? BandCount::Three : BandCount::One;
    return scatteredFrom(samples, ScatteredSet(symmetryOf(table), bands), leftOut);
}

}  // namespace gonio::proc
