#include "proc/radiance/exposure_groups.h"

#include <map>
#include <string>
#include <utility>

namespace gonio::proc {
namespace {

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "merge: " + what};
}

/// Empty message: the frame belongs to the state of the first.
std::string misfit(const Frame& frame, const Frame& first, Band band) {
    const std::string which = "frame " + std::to_string(frame.number);
    const std::string letterOf(letter(band));
    if (!frame.led || frame.levels[band] == 0)
        return which + " was not lit in band " + letterOf + "; leave dark frames out";
    if (frame.levels != LedLevels::only(band, frame.levels[band]))
        return which + " was lit in more than band " + letterOf;
    if (frame.led != first.led) {
        return "LED " + std::to_string(*first.led) + " and LED " + std::to_string(*frame.led) +
               " in one bracket";
    }
    if (frame.window != first.window || frame.pixels.size() != first.pixels.size())
        return which + " has another window than the first";
    if (frame.gainDb != first.gainDb) return which + " has another gain than the first";
    if (frame.exposure.granted.count() <= 0) return which + " has no exposure time";
    return {};
}

}  // namespace

Result<std::vector<ExposureGroup>> exposureGroups(std::span<const Frame> bracket,
                                                  Band band,
                                                  const DarkLibrary& darks) {
    if (bracket.empty() || bracket.front().pixels.empty())
        return refused("the bracket has no frames");
    std::map<std::pair<Nanoseconds, std::uint16_t>, ExposureGroup> groups;
    for (const Frame& frame : bracket) {
        if (std::string why = misfit(frame, bracket.front(), band); !why.empty())
            return refused(why);
        const std::uint16_t level = frame.levels[band];
        ExposureGroup& group = groups[{frame.exposure.granted, level}];
        if (group.dark == nullptr) {
            Result<const DarkFrame*> dark = darks.find(frame);
            if (!dark) return dark.error().in("merge");
            group.dark = *dark;
            group.seconds = frame.exposure.seconds();
            group.tau = group.seconds * level / 65535.0;
        }
        group.frames.push_back(&frame);
    }
    std::vector<ExposureGroup> sorted;
    sorted.reserve(groups.size());
    for (auto& [key, group] : groups) sorted.push_back(std::move(group));
    return sorted;
}

}  // namespace gonio::proc
