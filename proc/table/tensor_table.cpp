#include "proc/table/tensor_table.h"

#include <cmath>

namespace gonio::proc {

int TensorTable::reduction() const {
    if (isotropic()) return 1;
    const double span = static_cast<double>(phiIn.back()) - static_cast<double>(phiIn.front());
    const double parts = std::round(2 * kPi / span);
    return parts >= 1 && parts <= 4 ? static_cast<int>(parts) : 0;
}

SquarePoint squareOf(Radians theta, Radians phi) {
    const double y = (phi.value() + kPi) / (2 * kPi);
    return {.x = std::sqrt(2 * theta.value() / kPi), .y = y - std::floor(y)};
}

Direction directionOf(const SquarePoint& at) {
    return Direction::fromSpherical(Radians(at.x * at.x * kPi / 2), Radians((2 * at.y - 1) * kPi));
}

SquarePoint nodeOf(const GridStack& grid, std::size_t i) {
    return {.x = static_cast<double>(i % grid.width) / static_cast<double>(grid.width - 1),
            .y = static_cast<double>(i / grid.width) / static_cast<double>(grid.height - 1)};
}

}  // namespace gonio::proc
