#include "proc/export/band_rows.h"

#include <cmath>

#include "proc/table/band_channels.h"

namespace gonio::proc {

Result<BrdfRows> onlyBands(const BrdfRows& rows, std::span<const Band> bands) {
    const Result<BandChannels> found = bandChannels(rows.channels);
    if (!found) return found.error();
    BrdfRows kept;
    kept.pairs = rows.pairs;
    kept.isotropic = rows.isotropic;
    for (const Band band : bands) kept.channels.push_back(Channel::of(band));
    for (std::size_t pair = 0; pair < rows.pairs.size(); ++pair) {
        for (const Band band : bands) {
            const ChannelBlend& blend = found->bands[index(band)];
            const auto of = [&](const std::vector<double>& values) {
                return blend.of([&](std::size_t c) { return values[rows.index(pair, c)]; });
            };
            kept.f.push_back(of(rows.f));
            if (!rows.uRandom.empty()) {
                const double low = (1 - blend.t) * rows.uRandom[rows.index(pair, blend.low)];
                const double high = blend.t * rows.uRandom[rows.index(pair, blend.high)];
                kept.uRandom.push_back(blend.t == 0 ? low : std::hypot(low, high));
            }
            if (!rows.uSystematic.empty()) kept.uSystematic.push_back(of(rows.uSystematic));
            if (!rows.flags.empty()) {
                kept.flags.push_back(rows.flagsAt(pair, blend.low) |
                                     rows.flagsAt(pair, blend.high));
            }
        }
    }
    return kept;
}

}  // namespace gonio::proc
