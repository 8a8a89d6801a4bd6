#pragma once
// The inner loop of MERL's reader: a plane of 1.5 million doubles at the speed of a copy.

#include <cstddef>
#include <string_view>
#include <vector>

namespace gonio::proc {

struct MerlPlane {
    std::vector<double> f;     ///< stored value times scale; NaN where it is negative
    std::size_t negative = 0;  ///< how many
    bool finite = true;        ///< all stored values are
};

/// `bytes`: little-endian doubles at any alignment.
[[nodiscard]] MerlPlane decodeMerlPlane(std::string_view bytes, double scale);

}  // namespace gonio::proc
