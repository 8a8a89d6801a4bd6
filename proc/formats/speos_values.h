#pragma once
// What the readers of all Speos files do to a table once its numbers are there.

#include <cstdint>

#include "proc/formats/file_read.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// The comment by which our own text files say where azimuth 0 is.
inline constexpr std::string_view kSpeosOwnComment = "phi 0 is the mirror direction of the light";

/// Azimuth of the mirror direction where nothing else tells it.
inline constexpr double kSpeosTextMirrorDeg = 0;
inline constexpr double kSpeosBinaryMirrorDeg = 180;

/// How a file came to its azimuths.
enum class SpeosOrigin : std::uint8_t {
    OwnText,
    Text,
    Binary
};

/// In [0, 360): the sample turned by an anisotropy angle has the light at minus that.
[[nodiscard]] double lightAzimuthOf(double anisotropyDeg);

/// Divides f cos(theta) by the cosine. Where that is 0 to rounding there is no value: NaN.
void divideByCosine(SphericalBlock& block);

/// Sets the azimuth of the mirror direction, and adds the warnings: of that choice, of negative
/// values, of totals that differ from the tables' own by more than kSpeosTotalDiffers.
void settle(FileRead<SphericalTable>& read, SpeosOrigin origin);
inline constexpr double kSpeosTotalDiffers = 0.02;

}  // namespace gonio::proc
