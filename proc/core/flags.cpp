#include "proc/core/flags.h"

#include <array>
#include <cstddef>

namespace gonio {
namespace {

constexpr std::array<std::string_view, kFlagCount> kFlagNames{"measured",
                                                              "saturated",
                                                              "below_noise",
                                                              "blocked",
                                                              "below_horizon",
                                                              "reciprocity",
                                                              "interpolated",
                                                              "prior",
                                                              "model",
                                                              "extrapolated",
                                                              "glare_corrected",
                                                              "tilt_corrected",
                                                              "drift_corrected",
                                                              "not_planned"};

constexpr std::array<std::string_view, 7> kSourceNames{
    "measured", "reciprocity", "interpolated", "prior", "model", "extrapolated", "analytic"};

}  // namespace

std::string_view name(Flag flag) { return kFlagNames[static_cast<std::size_t>(flag)]; }

std::string describe(Flags flags) {
    std::string text;
    for (int bit = 0; bit < kFlagCount; ++bit) {
        const auto flag = static_cast<Flag>(bit);
        if (!flags.has(flag)) continue;
        if (!text.empty()) text += ',';
        text += name(flag);
    }
    return text;
}

std::string_view name(Source source) { return kSourceNames[static_cast<std::size_t>(source)]; }

}  // namespace gonio
