#pragma once
// A k-d tree over points of three coordinates, built once: exact nearest neighbours by Euclidean
// distance, ties by position. nanoflann's tree lies behind it. Searches may run on several threads
// at once. Of no points it finds none.

#include <array>
#include <memory>
#include <vector>

#include "proc/table/nearest_list.h"

namespace gonio::proc {

using Place3 = std::array<double, 3>;

/// Summed in the order of the coordinates.
[[nodiscard]] double squaredDistance(const Place3& a, const Place3& b);

class PlaceTree {
public:
    /// A position is an index into `places`; fewer than 2^32 of them, all finite.
    explicit PlaceTree(std::vector<Place3> places);
    ~PlaceTree();
    PlaceTree(PlaceTree&&) noexcept;
    PlaceTree& operator=(PlaceTree&&) noexcept;

    /// Nearest first, at most `count`.
    [[nodiscard]] std::vector<NearPosition> nearest(const Place3& at, std::size_t count) const;

private:
    struct Index;
    std::unique_ptr<const Index> index_;
};

}  // namespace gonio::proc
