#pragma once
// Work split over the machine's cores. The result never depends on the number of threads: each
// index is computed alone.

#include <cstddef>
#include <functional>

namespace gonio {

/// Half-open range of indices.
struct IndexRange {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// Calls `work` on disjoint ranges that cover [0, count), on all cores; returns when all are done.
/// `work` must not throw.
void parallelFor(std::size_t count, const std::function<void(IndexRange)>& work);

}  // namespace gonio
