#pragma once
// What a file of a BRDF holds, and whether to believe it: ranges, angles, shares of what is
// measured, missing and negative, the totals that it states against those that its own values have,
// energy, and reciprocity.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "proc/formats/brdf_file.h"

namespace gonio::proc {

/// Of directions above the horizon that may hold a value, each once.
struct ChannelFacts {
    Channel channel;
    std::size_t directions = 0;
    std::size_t measured = 0;       ///< the rest are missing
    std::size_t negative = 0;       ///< of the measured ones
    double least = 0, largest = 0;  ///< f, 1/sr; NaN: nothing measured
};

/// Of one light direction: the share of its power that is sent back, or through.
struct TotalFacts {
    std::string channel;
    double incidenceDeg = 0, lightAzimuthDeg = 0;
    bool transmission = false;
    std::optional<double> stated;  ///< by the file
    /// Integral of f cos(theta_o) over the values; what is missing counts as 0. NaN: not to be had.
    double recomputed = 0;
};

/// Pairs of directions that the file holds both ways, in the LEDs' bands.
struct ReciprocityFacts {
    std::size_t pairs = 0;
    double median = 0, p95 = 0;  ///< of |f(a, b) - f(b, a)| over their mean
};

struct Range {
    double from = 0, to = 0;
};

struct FileFacts {
    bool reflection = false, transmission = false;
    std::string symmetry;  ///< "isotropic", "plane-symmetrical", "several light azimuths", ...
    std::vector<double> incidencesDeg;  ///< empty: all of them
    std::size_t lights = 0;             ///< light directions; 0: all of them
    std::optional<Range> thetaOutDeg;   ///< of what is measured
    std::vector<ChannelFacts> channels;
    std::vector<TotalFacts> totals;
    std::optional<ReciprocityFacts> reciprocity;
    std::vector<std::string> warnings;  ///< the reader's and our own
};

/// A stated total that differs by more than this from the recomputed one is warned of.
inline constexpr double kTotalTolerance = 0.05;
/// Likewise a median of the reciprocity.
inline constexpr double kReciprocityTolerance = 0.1;

[[nodiscard]] FileFacts fileFacts(const BrdfFile& file);

}  // namespace gonio::proc
