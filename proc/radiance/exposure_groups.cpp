#include "proc/radiance/exposure_groups.h"

#include <map>
#include <string>
#include <utility>

namespace gonio::proc {
namespace {

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "merge: " + what};
}

std::string named(const Frame& frame) { return "frame " + std::to_string(frame.number); }

/// Empty message: a frame of a bracket lit in `band` can be so.
std::string notLit(const Frame& frame, Band band) {
    const std::string letterOf(letter(band));
    if (!frame.led || frame.levels[band] == 0)
        return named(frame) + " was not lit in band " + letterOf + "; leave dark frames out";
    if (frame.levels != LedLevels::only(band, frame.levels[band]))
        return named(frame) + " was lit in more than band " + letterOf;
    if (frame.exposure.granted.count() <= 0) return named(frame) + " has no exposure time";
    return {};
}

/// Empty message: the lit frame belongs to the bracket.
std::string misfit(const Frame& frame, const BracketTraits& bracket) {
    if (frame.led != bracket.led) {
        return "LED " + std::to_string(bracket.led) + " and LED " + std::to_string(*frame.led) +
               " in one bracket";
    }
    if (frame.window != bracket.window || frame.pixels.size() != bracket.size)
        return named(frame) + " has another window than the first";
    if (frame.gainDb != bracket.gainDb) return named(frame) + " has another gain than the first";
    return {};
}

}  // namespace

Result<BracketTraits> traitsOf(const Frame& first, Band band) {
    if (first.pixels.empty()) return refused(named(first) + " has no pixels");
    if (std::string why = notLit(first, band); !why.empty()) return refused(why);
    return BracketTraits{.led = *first.led,
                         .window = first.window,
                         .size = first.pixels.size(),
                         .gainDb = first.gainDb};
}

Result<void> checkBelongs(const Frame& frame, const BracketTraits& bracket, Band band) {
    if (std::string why = notLit(frame, band); !why.empty()) return refused(why);
    if (std::string why = misfit(frame, bracket); !why.empty()) return refused(why);
    return {};
}

double effectiveSeconds(const Frame& frame, Band band) {
    return frame.exposure.seconds() * frame.levels[band] / 65535.0;
}

Result<std::vector<ExposureGroup>> exposureGroups(std::span<const Frame> bracket,
                                                  Band band,
                                                  const DarkLibrary& darks) {
    if (bracket.empty()) return refused("the bracket has no frames");
    const Result<BracketTraits> traits = traitsOf(bracket.front(), band);
    if (!traits) return traits.error();
    std::map<std::pair<Nanoseconds, std::uint16_t>, ExposureGroup> groups;
    for (const Frame& frame : bracket) {
        if (Result<void> belongs = checkBelongs(frame, *traits, band); !belongs)
            return belongs.error();
        ExposureGroup& group = groups[{frame.exposure.granted, frame.levels[band]}];
        if (group.dark == nullptr) {
            Result<const DarkFrame*> dark = darks.find(frame);
            if (!dark) return dark.error().in("merge");
            group.dark = *dark;
            group.seconds = frame.exposure.seconds();
            group.tau = effectiveSeconds(frame, band);
        }
        group.frames.push_back(&frame);
    }
    std::vector<ExposureGroup> sorted;
    sorted.reserve(groups.size());
    for (auto& [key, group] : groups) sorted.push_back(std::move(group));
    return sorted;
}

}  // namespace gonio::proc
