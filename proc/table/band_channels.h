#pragma once
// Which channels of a file answer for the LEDs' bands. One channel is monochrome; R, G and B by
// name are the bands, whatever their wavelengths; of wavelengths each band takes the two that
// enclose its own, linearly, or one within 25 nm. Tristimulus values are none of the bands: only a
// named conversion makes them so.

#include <array>
#include <cstddef>
#include <span>

#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/channel.h"

namespace gonio::proc {

/// (1 - t) of channel `low` and t of channel `high`.
struct ChannelBlend {
    std::size_t low = 0, high = 0;
    double t = 0;

    /// Value of a blend of numbers by channel; a channel of no weight is not asked.
    template <class Value>
    [[nodiscard]] double of(const Value& value) const {
        if (t == 0) return value(low);
        return (1 - t) * value(low) + t * value(high);
    }
};

struct BandChannels {
    BandCount count = BandCount::Three;
    std::array<ChannelBlend, 3> bands;  ///< R, G, B; the same thrice for one channel

    /// A band lies between two wavelengths, or not at that of its channel by more than 1 nm.
    bool resampled = false;
};

/// Widest distance of a channel that answers for a band alone.
inline constexpr double kBandReachNm = 25;

/// Usage error that names what the channels are, and what to do.
[[nodiscard]] Result<BandChannels> bandChannels(std::span<const Channel> channels);

}  // namespace gonio::proc
