#pragma once
// BRDF values at any pairs of directions, in the order of a file: what formats hold that list
// directions (BiRD, ASTM, pab-opto, ALTA, CSV) read into and write from. Directions are in the
// sample's frame; a wo below the horizon is transmission.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "proc/core/direction.h"
#include "proc/core/flags.h"
#include "proc/core/scatterer.h"
#include "proc/table/channel.h"

namespace gonio::proc {

/// Per pair and channel, channel fastest: value [pair * channels.size() + channel].
struct BrdfRows {
    std::vector<Channel> channels;
    std::vector<LightView> pairs;
    std::vector<double> f;        ///< 1/sr; NaN: no value
    std::vector<double> uRandom;  ///< 1/sr, k = 1; empty: not known; NaN: not known of this one
    /// Likewise. Empty beside a uRandom that is not: that one is the combined uncertainty.
    std::vector<double> uSystematic;
    std::vector<Flags> flags;  ///< empty: all values are measured ones
    bool isotropic = true;     ///< azimuths tell of their difference alone

    [[nodiscard]] std::size_t index(std::size_t pair, std::size_t channel) const {
        return pair * channels.size() + channel;
    }
    /// Not NaN.
    [[nodiscard]] bool hasData(std::size_t pair, std::size_t channel) const;
    [[nodiscard]] Flags flagsAt(std::size_t pair, std::size_t channel) const;
    /// Combined standard uncertainty; empty where it is not known.
    [[nodiscard]] std::optional<double> uAt(std::size_t pair, std::size_t channel) const;
};

/// The lights of all pairs stand at one azimuth, those at the normal apart, which have none: what a
/// list of directions looks like that takes its sample as isotropic.
[[nodiscard]] bool lightsAtOneAzimuth(std::span<const LightView> pairs);

}  // namespace gonio::proc
