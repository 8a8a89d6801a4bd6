#pragma once
// What a file format could not hold. Every writer returns one; an empty report means that reading
// the file back gives the same.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::proc {

enum class Loss {
    Resampled,     ///< asked at other directions than the source's own
    Clamped,       ///< moved into what the format can hold
    Masked,        ///< missing: written as the format says that there is no value
    Extrapolated,  ///< answered from beyond what was measured
    Dropped,       ///< not in the file at all
};
/// "resampled", ...
[[nodiscard]] std::string_view name(Loss kind);

struct LossReport {
    struct Item {
        Loss kind = Loss::Dropped;
        std::string what;       ///< "nodes without data, written as 0"
        std::size_t count = 0;  ///< of values, unless `what` says of what
        /// Relative to the source, where it was measured: the largest, and weighted by f
        /// cos(theta_o).
        std::optional<double> largestError{};
        std::optional<double> weightedError{};

        bool operator==(const Item&) const = default;
    };
    std::vector<Item> items;

    /// Ignores a count of 0; what is there already is counted on.
    void add(Loss kind, std::string what, std::size_t count);
};

/// Bytes of a file and what they leave out.
struct Written {
    std::string bytes;
    LossReport loss;
};

}  // namespace gonio::proc
