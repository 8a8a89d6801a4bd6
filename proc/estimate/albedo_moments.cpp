#include "proc/estimate/albedo_moments.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gonio::proc {

AlbedoMoments momentsOf(const Answer& answer, double cosThetaOut, KnownUncertainty& known) {
    AlbedoMoments moments;
    for (std::size_t band = 0; band < 3; ++band) {
        const double f = answer.f.value[band];
        if (!std::isfinite(f)) continue;
        moments.sum[AlbedoMoments::Light + band] = f;
        moments.sum[AlbedoMoments::Answered + band] = 1;
        const auto of = [band](const std::optional<LedBands>& u) {
            return u ? u->value[band] : std::numeric_limits<double>::quiet_NaN();
        };
        const double random = of(answer.uRandom);
        const double systematic = of(answer.uSystematic);
        known.random = known.random && !std::isnan(random);
        known.systematic = known.systematic && !std::isnan(systematic);
        moments.sum[AlbedoMoments::Systematic + band] = systematic;
        moments.sum[AlbedoMoments::Random + band] = random * random * cosThetaOut;
    }
    return moments;
}

Albedo albedoOf(const AlbedoMoments& total,
                const std::array<double, 3>& error,
                const KnownUncertainty& known,
                double independentCell) {
    Albedo albedo;
    for (std::size_t band = 0; band < 3; ++band) {
        BandAlbedo& one = albedo.bands[band];
        const double answered = total.of(AlbedoMoments::Answered, band);
        one.missing = std::clamp(1 - answered / kPi, 0.0, 1.0);
        if (!(answered > 0)) {
            one.value = one.errorBound = std::numeric_limits<double>::quiet_NaN();
            continue;
        }
        one.value = total.of(AlbedoMoments::Light, band);
        one.errorBound = error[band];
        if (known.random) {
            one.uRandom = std::sqrt(independentCell * total.of(AlbedoMoments::Random, band));
        }
        if (known.systematic) one.uSystematic = total.of(AlbedoMoments::Systematic, band);
    }
    return albedo;
}

std::optional<double> BandAlbedo::u() const {
    if (!uRandom && !uSystematic) return std::nullopt;
    return std::hypot(uRandom.value_or(0), uSystematic.value_or(0));
}

}  // namespace gonio::proc
