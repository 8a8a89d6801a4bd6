#pragma once
// Pixels -> cells by overlapping area. With S = g f cos(theta_o) dOmega/dA the signal of a pixel
// and a the part of its area inside the cell, the bin
//     sum(a S / cos(theta_o)) / sum(a dOmega/dA)
// is g times the solid-angle mean of f over the cell: cosine and pixel solid angle, which sample
// and white share, are divided out before the mean, so that only the lens's smooth vignetting
// remains in g. Overlap by the corners: a pixel with all four in one cell lies inside; others by 4
// x 4 points.
//
// A cell that is not seen whole (theta_o beyond the field, or the picture's edge) is Blocked; one
// that has lost more than 2 % of its area to pixels saturated in every frame is Saturated: both are
// missing. A pixel that two cells share correlates their noise; this is neglected.

#include <cstdint>
#include <span>
#include <vector>

#include "proc/core/flags.h"
#include "proc/optics/cell_grid.h"
#include "proc/optics/lens_map.h"
#include "proc/radiance/merge.h"

namespace gonio::proc {

/// One state over CellGrid: electrons per second and cell-independent solid angle. Missing: NaN.
struct CellSignal {
    std::vector<double> signal;
    std::vector<double> variance;
    std::vector<double> nEff;  ///< effective number of independent pixels
    std::vector<Flags> flags;  ///< Measured, or why not
    /// Standard uncertainty of the glare that was taken off (glare.h): one error for all cells.
    std::vector<double> uGlare;
    /// Of the pixels that it was binned from, in the middle of the field, in steradian; 0: of none.
    double pixelSolidAngle = 0;

    [[nodiscard]] static CellSignal missing(std::size_t cells);
    [[nodiscard]] std::size_t size() const { return signal.size(); }
    [[nodiscard]] bool present(std::size_t cell) const { return flags[cell].has(Flag::Measured); }
};

class Binning {
public:
    /// `field`: rows of cells that end beyond it are blocked.
    Binning(const LensMap& map, const Window& window, Radians field);

    /// The picture must have the window's size.
    [[nodiscard]] CellSignal bin(const MergedState& state) const {
        return bin(state.radiance, state.variance);
    }
    [[nodiscard]] CellSignal bin(const Image<float>& radiance, const Image<float>& variance) const;
    /// The signals of two pictures that are NaN at the same pixels.
    struct Both {
        CellSignal first;
        std::vector<double> second;
    };
    [[nodiscard]] Both bin(const Image<float>& radiance,
                           const Image<float>& variance,
                           const Image<float>& second) const;
    /// Sensor area inside the cell, in pixels of the window.
    [[nodiscard]] double pixelsIn(std::size_t cell) const { return pixelsIn_[cell]; }

private:
    /// What a pixel gives to a cell.
    struct Share {
        std::uint32_t pixel = 0;
        float weight = 0;      // its area inside the cell, 0..1, over cos(theta_o)
        float solidAngle = 0;  // of that area, steradian
    };
    [[nodiscard]] std::span<const Share> sharesOf(std::size_t cell) const;
    struct Picture {
        std::span<const float> radiance, variance;
        std::span<const float> second;  // may be empty
    };
    /// The second picture's signal; NaN where the cell is not present.
    double bin(const Picture& picture, std::size_t cell, CellSignal& out) const;
    [[nodiscard]] CellSignal blank() const;

    Window window_;
    double pixelSolidAngle_ = 0;
    std::vector<Share> shares_;            // sorted by cell
    std::vector<std::size_t> firstShare_;  // by cell, and one behind
    std::vector<double> pixelsIn_;         // by cell
    int visibleRows_ = 0;
};

}  // namespace gonio::proc
