#pragma once
// A bracket's frames, added up as they arrive. Of each (exposure, level) group it keeps one 32-bit
// word per pixel: in its upper 10 bits how many samples were usable, in its lower 22 the sum of
// their DN. Whole numbers: the sums are exact, whatever the order of the frames. What is fitted,
// weighed or made linear is so from these sums (merge.h), once for a group, not for a frame.
//
// Memory: 4 bytes per pixel and group, and of each frame its witness pixels (2 bytes each, at most
// 128 x 128 on a regular grid), by which frames are compared with each other (frame_residuals.h).
// A frame can be let go of once it was added. Eight groups of 1024 x 1024: 32 MiB, 256 KiB of
// witnesses.
//
// At most 1023 frames can be alike, and no more than 2^22 DN in all: 64 frames of a 16-bit sensor.

#include <cstdint>
#include <optional>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/frame.h"
#include "proc/core/result.h"
#include "proc/radiance/dark.h"
#include "proc/radiance/exposure_groups.h"
#include "proc/radiance/linearity.h"
#include "proc/radiance/noise.h"

namespace gonio::proc {

/// The usable samples of one group.
struct GroupSums {
    Nanoseconds granted{0};
    std::uint16_t level = 0;
    const DarkFrame* dark = nullptr;  ///< borrowed from the library
    double seconds = 0;               ///< t
    double tau = 0;                   ///< t L / 65535, or better where it is known better
    int frames = 0;
    Image<std::uint32_t> tallies;
};

/// One frame's DN at the witness pixels, row by row; kMasked where it is not usable.
struct Witness {
    static constexpr std::uint16_t kMasked = 0xFFFF;
    std::uint32_t number = 0;  ///< the frame's
    std::size_t group = 0;
    std::vector<std::uint16_t> dn;
};

/// Every `step`th pixel from `first` on, in both directions.
struct WitnessGrid {
    int step = 1, first = 0;
    Size size;  ///< how many

    [[nodiscard]] static WitnessGrid over(Size picture);
    [[nodiscard]] int at(int i) const { return first + i * step; }
};

struct BracketSums {
    Band band = Band::R;
    SensorNoise noise;
    Linearity linearity;
    BracketTraits traits;
    std::vector<GroupSums> groups;   ///< by exposure, then by level
    std::vector<Witness> witnesses;  ///< one for each frame, as they came
    WitnessGrid grid;

    /// Sensor pixels that one pixel is the mean of.
    [[nodiscard]] int members() const { return traits.window.binning * traits.window.binning; }
};

class MergeAccumulator {
public:
    /// Borrows `darks`, which must not change while the accumulator or its sums are in use.
    MergeAccumulator(Band band,
                     const DarkLibrary& darks,
                     const SensorNoise& noise,
                     Linearity linearity = {});

    /// Quality error, and nothing added, when the frame is of another state, window or gain than
    /// the first, is not lit in the band alone, has no dark frame, or is one too many.
    [[nodiscard]] Result<void> add(const Frame& frame);

    /// Empties it for another bracket, and keeps its memory for that.
    void restart(Band band);

    /// The group's effective time is that times `factor`.
    void scaleGroup(std::size_t group, double factor) { sums_.groups[group].tau *= factor; }

    [[nodiscard]] const BracketSums& sums() const { return sums_; }
    /// What it holds in memory, apart from the dark frames.
    [[nodiscard]] std::size_t bytes() const;

private:
    Result<std::size_t> groupOf(const Frame& frame);
    Image<std::uint32_t> freshTallies();

    const DarkLibrary& darks_;
    BracketSums sums_;
    bool begun_ = false;
    std::vector<Image<std::uint32_t>> spare_;  ///< tallies of brackets before
};

}  // namespace gonio::proc
