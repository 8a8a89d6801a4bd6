#pragma once
// How a frame can be well formed and wrong: every chunk and CRC of it is sound, and in all but two
// cases the rig says that all is well.

#include <cstdint>

namespace gonio::sim {

enum class FrameFlaw : std::uint8_t {
    None,
    PreviousAgain,       ///< the picture of the frame before
    Black,               ///< every pixel 0
    Unlit,               ///< the LED was not lit
    LateSettings,        ///< taken with the settings of the frame before, and its LEADER says so
    HiddenLateSettings,  ///< likewise, and its LEADER says otherwise
    OldExposure,         ///< as long as the frame before
    Reflex,              ///< a spot of it is saturated
    LedDrift,            ///< the current left its tolerance: an event, and validity bit1 says so
};

/// The current of a drifted LED rises by one part in so many.
inline constexpr int kDriftedPart = 20;

}  // namespace gonio::sim
