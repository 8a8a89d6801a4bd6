#pragma once
// One block of an SSDD file as the file has it, and the tables that come of it.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "proc/core/result.h"
#include "proc/table/channel.h"
#include "proc/table/specular_table.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

struct SsddGrid {
    bool transmission = false;
    std::string colourModel;  ///< "monochrome", "rgb", "xyz", "spectrum"
    std::vector<Channel> channels;
    std::string parameters;  ///< "spherical_coordinate_system", ...
    bool symmetrical = false, reciprocal = false;
    std::array<std::vector<double>, 5> list;  ///< PARAM0..PARAM4, degrees
    std::vector<double> values;               ///< PARAM3 > 2 > 1 > 0 > channel

    [[nodiscard]] std::size_t index(std::size_t p0,
                                    std::size_t p1,
                                    std::size_t p2,
                                    std::size_t p3) const {
        const std::size_t point =
            p0 + list[0].size() * (p1 + list[1].size() * (p2 + list[2].size() * p3));
        return point * channels.size();
    }
};

/// Takes incidences of 90 degrees and beyond, and incoming azimuths that repeat the first after a
/// turn, out of a grid; a sentence for each kind that there was.
[[nodiscard]] std::vector<std::string> withoutGrazingLight(SsddGrid& grid);

/// Appends the blocks of a spherical grid; the table has the mirror direction at 180.
void appendSpherical(const SsddGrid& grid, SphericalTable& table);

/// A specular grid; the message of what it cannot hold as an error, without a place.
[[nodiscard]] Result<SpecularTable> specularTable(const SsddGrid& grid);

}  // namespace gonio::proc
