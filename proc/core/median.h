#pragma once
// The middle of some numbers: the upper one of the two middles of an even count, so that it is
// always one of them. NaN of none.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace gonio {

template <class T>
[[nodiscard]] T median(std::vector<T> values) {
    if (values.empty()) return static_cast<T>(std::nan(""));
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace gonio
