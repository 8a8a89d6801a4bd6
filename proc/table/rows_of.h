#pragma once
// Rows of values out of what is measured on a grid, and a measured sample out of rows.
//
// Each cell of a sample is a row, missing ones too; of tables each node with data, each direction
// once, on the side of the plane of incidence that the table holds. Nodes on the horizon are left
// out.
//
// Back, a row's value goes into the cell that holds its direction in the frame of its light; the
// value of several is their mean, of the part that is random as independent and of the systematic
// one as common. A sample's own rows give it back to the bit, but for nEff, which rows do not have
// (a cell gets the number of its values), and for the normal: there a light has no azimuth, and a
// set of several rotations gets all rows of the normal into its table of each. Isotropic rows of
// lights at several azimuths are turned to phi_i = 0; of one azimuth it is the rotation.

#include "proc/core/result.h"
#include "proc/table/brdf_rows.h"
#include "proc/table/metadata.h"
#include "proc/table/sample_set.h"
#include "proc/table/specular_table.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Channels are the bands that any LED has. Isotropic where the set has no two rotations.
[[nodiscard]] BrdfRows rowsOf(const SampleSet& set);

/// One channel, `channel`, or X, Y and Z. Transmission goes to the other side of the surface.
[[nodiscard]] BrdfRows rowsOf(const SpecularTable& table, const Channel& channel = {});

/// Blocks that follow one another with one light and the same axes share their rows.
[[nodiscard]] BrdfRows rowsOf(const SphericalTable& table);

struct SampleOfRows {
    SampleSet set;
    std::size_t values = 0;     ///< in the rows, in the bands that are taken
    std::size_t leftOut = 0;    ///< of these, with light or view at or below the horizon
    std::size_t offCentre = 0;  ///< of these, further than 1e-6 from the centre of their cell
    std::size_t averaged = 0;   ///< of these, with others in their cell
    bool bandsResampled = false;
};

/// Lights further than this from each other, as unit vectors, are two.
inline constexpr double kSameLightDistance = 1e-6;

/// Channels as bandChannels() assigns them; a single one that is named R, G or B is that band, any
/// other single one is all three. Usage error for channels that are no bands, and for more lights
/// than kMostTables.
[[nodiscard]] Result<SampleOfRows> sampleOf(const BrdfRows& rows, const Metadata& about);

}  // namespace gonio::proc
