#pragma once
// What is summed over directions to make an albedo: for each band the light, the projected solid
// angle that was answered, and the uncertainties, as far as they were answered with.

#include <array>
#include <cstddef>

#include "proc/core/scatterer.h"
#include "proc/estimate/albedo.h"

namespace gonio::proc {

struct AlbedoMoments {
    enum Kind : std::size_t {
        Light = 0,       ///< f cos dw
        Answered = 3,    ///< cos dw
        Systematic = 6,  ///< u_systematic cos dw
        Random = 9,      ///< (u_random cos)^2 dw
        kCount = 12
    };
    std::array<double, kCount> sum{};

    [[nodiscard]] double of(Kind kind, std::size_t band) const { return sum[kind + band]; }
    void add(double weight, const AlbedoMoments& other) {
        for (std::size_t i = 0; i < kCount; ++i) sum[i] += weight * other.sum[i];
    }
};

/// Whether every answer that was used carried its uncertainties.
struct KnownUncertainty {
    bool random = true;
    bool systematic = true;
};

/// Of one direction, per unit of projected solid angle.
[[nodiscard]] AlbedoMoments momentsOf(const Answer& answer,
                                      double cosThetaOut,
                                      KnownUncertainty& known);

/// `error` bounds the light of each band.
[[nodiscard]] Albedo albedoOf(const AlbedoMoments& total,
                              const std::array<double, 3>& error,
                              const KnownUncertainty& known,
                              double independentCell);

}  // namespace gonio::proc
