#include "proc/export/resampling.h"

#include <algorithm>
#include <cmath>

#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

/// Below this share of the band's mean f, errors are relative to the share.
constexpr double kDark = 1e-3;

/// Mean of |f| of one band, over the probes that have it.
double meanOf(std::span<const Probe> probes, Band band) {
    double sum = 0;
    std::size_t count = 0;
    for (const Probe& probe : probes) {
        if (std::isnan(probe.f[band])) continue;
        sum += std::abs(probe.f[band]);
        ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace

std::vector<Probe> probesOf(const Scatterer& source,
                            std::span<const double> incidenceDeg,
                            std::span<const double> rotationDeg,
                            std::size_t stride) {
    std::vector<LightView> pairs;
    for (const double rotation : rotationDeg) {
        for (const double incidence : incidenceDeg) {
            const LedTable light{.incidence = Radians::fromDegrees(incidence),
                                 .rotation = rotationOf(rotation),
                                 .bands = {}};
            for (std::size_t cell = 0; cell < CellGrid::count(); cell += stride) {
                pairs.push_back(pairInSample(light, CellGrid::centre(cell)));
            }
        }
    }
    std::vector<Probe> probes(pairs.size());
    parallelFor(pairs.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            probes[i] = {pairs[i], source.answer(pairs[i]).f};
        }
    });
    return probes;
}

std::optional<ResamplingError> resamplingError(std::span<const Probe> probes,
                                               const Scatterer& written,
                                               std::span<const Band> bands) {
    std::vector<LedBands> answers(probes.size());
    parallelFor(probes.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            answers[i] = written.answer(probes[i].pair).f;
        }
    });
    ResamplingError error;
    double difference = 0;
    double all = 0;
    for (const Band band : bands) {
        const double dark = kDark * meanOf(probes, band);
        for (std::size_t i = 0; i < probes.size(); ++i) {
            const double f = probes[i].f[band];
            if (std::isnan(f)) continue;
            const double apart = std::abs(answers[i][band] - f);
            if (std::isnan(apart)) {
                ++error.lost;
                continue;
            }
            ++error.compared;
            const double cosine = std::abs(probes[i].pair.out.z());
            difference += apart * cosine;
            all += std::abs(f) * cosine;
            if (apart > 0) {
                error.largest = std::max(error.largest, apart / std::max(std::abs(f), dark));
            }
        }
    }
    if (error.compared == 0) return std::nullopt;
    error.weighted = all > 0 ? difference / all : 0;
    return error;
}

}  // namespace gonio::proc
