#pragma once
// Veiling glare taken off a radiance picture. A lens sends a share of each pixel's light elsewhere:
//     y = (1 - a - h) x + a sum(x) / N + h sum_j K(|i - j|) x_j / n_j,
//     K(r) = (1 + (r / R)^2)^-p,   n_j = sum_i K(|i - j|),
// sums over the N pixels that see the field: a goes to all of them alike, h into a halo of radius R
// and exponent p. No light is lost, so the field's sum is the same before and after. The multiple
// exposures of a bracket do not help against it, and white and black do not calibrate it away
// [Talvala2007; radiometry.md 2.3].
//
// x is found by fixed-point iteration, x <- (y - glare(x)) / (1 - a - h), each step of which leaves
// a share a + h of the error. The glare is worked out on a grid of 16 pixels, between whose nodes
// sources are split and sums interpolated. Pixels outside the field are left as they are. A pixel
// that was saturated throughout (NaN) stays NaN; as a source it counts as the brightest of its
// nearest neighbours that were not, which is the least that it can have been.

#include <vector>

#include "proc/optics/binning.h"
#include "proc/optics/lens_map.h"

namespace gonio::proc {

/// How a lens spreads light. Shares are of each pixel's light, 0..1.
struct GlareSpread {
    double everywhere = 0;    ///< a
    double halo = 0;          ///< h
    double radius = 64;       ///< R, sensor pixels
    double exponent = 1;      ///< p
    double uShare = 0;        ///< of share(), k = 1, from the fit
    double uRelative = 0.25;  ///< of each cell's correction, k = 1

    [[nodiscard]] double share() const { return everywhere + halo; }
    bool operator==(const GlareSpread&) const = default;
};

/// The pixels of a window that see the field. A field is convex, so that each row of it is one
/// span.
class FieldPixels {
public:
    FieldPixels(const LensMap& map, const Window& window, Radians field);

    struct Span {
        int begin = 0, end = 0;  ///< x of the first, and behind the last
    };
    [[nodiscard]] Span inRow(int y) const { return rows_[static_cast<std::size_t>(y)]; }
    [[nodiscard]] Size size() const { return size_; }
    [[nodiscard]] double count() const { return count_; }

private:
    Size size_;
    std::vector<Span> rows_;
    double count_ = 0;
};

/// K(r), r in the unit of `radius`.
[[nodiscard]] double haloShape(double r, double radius, double exponent);

class GlareFilter {
public:
    /// `field`: as Binning has it.
    GlareFilter(const GlareSpread& spread, const LensMap& map, const Window& window, Radians field);

    struct Cleaned {
        Image<float> radiance;
        double filled = 0;  ///< share of the field's light that saturated pixels were taken to have
    };
    /// The picture must have the window's size. With share() = 0: the picture itself.
    [[nodiscard]] Cleaned clean(const Image<float>& radiance) const;

    /// The state's cells without glare, and what that leaves unknown of each (CellSignal::uGlare):
    /// uRelative of the correction, and more where saturated pixels gave to it. A cell whose
    /// correction is more than 0.1 % is GlareCorrected.
    [[nodiscard]] CellSignal bin(const MergedState& state, const Binning& binning) const;

    [[nodiscard]] const GlareSpread& spread() const { return spread_; }

private:
    using Nodes = Image<float>;
    [[nodiscard]] Nodes nodeSums(const Image<float>& picture) const;
    [[nodiscard]] Nodes haloSums(const Nodes& sources) const;
    [[nodiscard]] Nodes glareAt(const Nodes& sources) const;

    GlareSpread spread_;
    FieldPixels field_;
    Nodes kernel_;   ///< K between nodes, (2 w - 1) x (2 h - 1)
    Nodes seeing_;   ///< of each node, the pixels of the field that are split to it
    Nodes landing_;  ///< n at each node
};

}  // namespace gonio::proc
