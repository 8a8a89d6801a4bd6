#include "proc/table/band_channels.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

std::optional<std::size_t> named(std::span<const Channel> channels, std::string_view name) {
    const auto found = std::find_if(channels.begin(), channels.end(), [&](const Channel& channel) {
        return channel.name == name;
    });
    if (found == channels.end()) return std::nullopt;
    return static_cast<std::size_t>(found - channels.begin());
}

std::string described(std::span<const Channel> channels) {
    constexpr std::size_t kMost = 8;
    std::string text;
    for (const Channel& channel : channels.first(std::min(kMost, channels.size()))) {
        if (!text.empty()) text += ", ";
        text += channel.nanometres     ? shortest(*channel.nanometres) + " nm"
                : channel.name.empty() ? "unnamed"
                                       : channel.name;
    }
    return text + (channels.size() > kMost ? ", ..." : "");
}

/// The channels about a wavelength; empty where none is near and it is not enclosed.
std::optional<ChannelBlend> about(std::span<const Channel> channels, double nm) {
    std::optional<std::size_t> below;
    std::optional<std::size_t> above;
    const auto at = [&](std::size_t i) { return *channels[i].nanometres; };
    for (std::size_t i = 0; i < channels.size(); ++i) {
        if (!channels[i].nanometres) continue;
        if (at(i) <= nm && (!below || at(i) > at(*below))) below = i;
        if (at(i) >= nm && (!above || at(i) < at(*above))) above = i;
    }
    if (below && above) {
        const double span = at(*above) - at(*below);
        return ChannelBlend{*below, *above, span > 0 ? (nm - at(*below)) / span : 0};
    }
    const auto nearest = below ? below : above;
    if (!nearest || std::abs(at(*nearest) - nm) > kBandReachNm) return std::nullopt;
    return ChannelBlend{*nearest, *nearest, 0};
}

Error noBands(std::span<const Channel> channels) {
    return {ErrorKind::Usage,
            "channels " + described(channels) +
                " are not the bands R, G, B (630, 525, 465 nm): --bands 2 takes the second of them "
                "alone"};
}

}  // namespace

Result<BandChannels> bandChannels(std::span<const Channel> channels) {
    BandChannels found;
    if (channels.empty()) return Error{ErrorKind::File, "no channel of values"};
    if (named(channels, "X") || named(channels, "Y") || named(channels, "Z")) {
        return Error{ErrorKind::Usage,
                     "X, Y, Z are no bands of the LEDs: --bands srgb converts them to linear sRGB"};
    }
    if (channels.size() == 1) {
        found.count = BandCount::One;
        return found;
    }
    for (const Band band : kBands) {
        ChannelBlend& blend = found.bands[index(band)];
        if (const auto place = named(channels, Channel::of(band).name)) {
            blend = {*place, *place, 0};
            continue;
        }
        const auto near = about(channels, nanometres(band));
        if (!near) return noBands(channels);
        blend = *near;
        const double nm = *channels[blend.low].nanometres;
        found.resampled = found.resampled || blend.t > 0 || std::abs(nm - nanometres(band)) > 1;
    }
    return found;
}

}  // namespace gonio::proc
