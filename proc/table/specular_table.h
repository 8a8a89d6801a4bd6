#pragma once
// A BRDF on a grid of specular-relative coordinates, as Zemax files hold it: for each rotation of
// the sample and each incidence, f in 1/sr at (azimuth, radial) about the mirror direction
// (proc/core/coordinates.h). The axes are the file's own numbers, in degrees, ascending.
//
// Where there is no data: a value of exactly 0, a NaN, and every node at or below the horizon. Such
// a node is missing, not black.

#include <cstddef>
#include <string>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/direction.h"

namespace gonio::proc {

enum class TableSymmetry {
    PlaneSymmetrical,  ///< azimuths 0..180, mirrored on reading
    Asymmetrical,      ///< azimuths 0..360, one rotation
    Asymmetrical4D     ///< azimuths 0..360, several rotations
};

enum class ScatterKind {
    Brdf,
    Btdf
};

/// Xyz planes are CIE tristimulus values, never the LED bands.
enum class TableColour {
    Monochrome,
    Xyz,
    LedBands  ///< R, G, B: no Zemax file
};
[[nodiscard]] constexpr std::size_t planeCount(TableColour colour) {
    return colour == TableColour::Monochrome ? 1 : 3;
}

/// One node: positions on the four axes.
struct TableNode {
    std::size_t rotation = 0, incidence = 0, azimuth = 0, radial = 0;
};

/// One colour of a table.
struct TablePlane {
    std::vector<double> f;    ///< 1/sr, rotation > incidence > azimuth > radial (fastest)
    std::vector<double> tis;  ///< fraction of the incident power, rotation > incidence
};

struct SpecularTable {
    TableSymmetry symmetry = TableSymmetry::PlaneSymmetrical;
    ScatterKind kind = ScatterKind::Brdf;
    TableColour colour = TableColour::Monochrome;
    std::vector<double> rotationDeg{0}, incidenceDeg, azimuthDeg, radialDeg;
    std::vector<TablePlane> planes;     ///< one, or X, Y, Z, or R, G, B
    std::vector<std::string> comments;  ///< free text: wavelength, sample, instrument

    /// Nodes of one plane.
    [[nodiscard]] std::size_t nodeCount() const;
    [[nodiscard]] std::size_t index(TableNode node) const;
    [[nodiscard]] std::size_t tisIndex(TableNode node) const;

    /// The light and the view of a node; of transmission the view on the other side, across the
    /// surface from where reflection would be. Rotation r turns the sample by +r under a fixed
    /// light: in the sample's frame the light stands at azimuth -r. The light of incidence 0 is the
    /// normal.
    [[nodiscard]] LightView pairAt(TableNode node) const;
    /// Above the horizon by more than rounding; for BTDF the other side of the surface counts.
    [[nodiscard]] bool canHoldData(TableNode node) const;
    [[nodiscard]] bool hasData(std::size_t plane, TableNode node) const;
    /// In every plane.
    [[nodiscard]] bool hasData(TableNode node) const;
    /// f of R, G, B; of a monochrome table the same thrice. Of an XYZ table it is none of them.
    [[nodiscard]] LedBands bandsAt(TableNode node) const;
    /// The first radial is the centre of a cell that begins at the pole, the mirror direction.
    [[nodiscard]] bool hasOpenPole() const;
    /// The node's direction stands in the table a second time: the pole of an incidence at another
    /// azimuth than the first, or the azimuth of the first one after a full turn.
    [[nodiscard]] bool repeatsDirection(TableNode node) const;
};

}  // namespace gonio::proc
