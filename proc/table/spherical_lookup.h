#pragma once
// The plain look-up of a SphericalTable: bilinear in (theta, azimuth) within a block, linear
// between the blocks of the two incidences at equal theta and equal azimuth from the light, and
// linear between light azimuths where there are several. A node answers its own number.
//
// Azimuths of a block wrap where they cover the circle; a plane-symmetrical table is mirrored. At
// theta 0 every azimuth is the same direction: the first node with data answers. An isotropic table
// turns with the light. wo below the surface is answered by the transmission blocks; without any,
// and for wi at or below the horizon: no answer, flag below_horizon. Outside the axes of theta,
// azimuth and incidence, and where a node that is needed has no data: no answer, without flags; a
// band is answered where the others are not. Of even cells the outermost values hold to the end of
// their cells, and the mean of the first ring stands at the normal. At incidence 0 a block of one
// azimuth answers for all of them; at others only at its own.
//
// At a node: flag and source `measured`; between nodes `interpolated`. Uncertainty is not known.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/band_channels.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

class SphericalLookup : public Scatterer {
public:
    /// File error for blocks whose sizes do not fit their axes, for axes that do not ascend, and
    /// for two blocks of one light and channel.
    [[nodiscard]] static Result<SphericalLookup> over(SphericalTable table, BandChannels channels);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return channels_.count; }
    [[nodiscard]] const SphericalTable& table() const { return table_; }

private:
    /// The blocks of one light azimuth, by incidence.
    struct Fan {
        std::vector<double> incidenceDeg;
        std::vector<std::size_t> block;
    };
    /// The blocks of one channel on one side of the surface, by light azimuth.
    struct Side {
        std::vector<double> lightAzimuthDeg;
        std::vector<Fan> fans;
    };
    /// A pair in the table's own coordinates, in degrees.
    struct Place {
        double lightAzimuth = 0, incidence = 0, azimuth = 0, theta = 0;
        bool pole = false;  ///< wo is the normal, or its opposite: the azimuth is any
    };
    struct Value {
        double f = 0;  ///< NaN: no answer
        bool node = true;
    };

    SphericalLookup(SphericalTable table, BandChannels channels);
    void arrange();
    [[nodiscard]] const Side& side(std::size_t channel, bool transmission) const {
        return sides_[2 * channel + (transmission ? 1 : 0)];
    }
    [[nodiscard]] Place placeOf(const LightView& pair) const;
    [[nodiscard]] Value inSide(const Side& side, const Place& place) const;
    [[nodiscard]] Value inFan(const Fan& fan, const Place& place) const;
    [[nodiscard]] Value inBlock(const SphericalBlock& block, const Place& place) const;

    SphericalTable table_;
    BandChannels channels_;
    bool isotropic_ = true;
    std::vector<Side> sides_;  ///< channel > transmission
};

}  // namespace gonio::proc
