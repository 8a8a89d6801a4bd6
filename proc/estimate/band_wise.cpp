#include "proc/estimate/band_wise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::proc {
namespace {

/// One band's part of an uncertainty; known of the whole as soon as it is of one band.
void take(std::optional<LedBands>& into, const std::optional<LedBands>& from, Band band) {
    if (!from) return;
    if (!into) into = LedBands::all(std::numeric_limits<double>::quiet_NaN());
    (*into)[band] = (*from)[band];
}

}  // namespace

Answer BandWise::answer(const LightView& pair) const {
    Answer all = Answer::none({}, Source::Measured);
    Flags unanswered;
    bool any = false;
    for (const Band band : kBands) {
        const auto& own = bands_[index(band)];
        if (!own) continue;
        const Answer one = own->answer(pair);
        if (std::isnan(one.f[band])) {
            unanswered = unanswered | one.flags;
            continue;
        }
        any = true;
        all.f[band] = one.f[band];
        take(all.uRandom, one.uRandom, band);
        take(all.uSystematic, one.uSystematic, band);
        all.flags = all.flags | one.flags;
        all.source = std::max(all.source, one.source);
    }
    if (!any) return Answer::none(unanswered, Source::Interpolated);
    if (all.source != Source::Measured) all.flags.clear(Flag::Measured);
    return all;
}

}  // namespace gonio::proc
