#pragma once
// The nearest of those that were offered, at most so many and within a distance. Equal distances
// are ordered by position, so that the list does not depend on the order of offers: what a tree
// finds and what a walk over all finds is the same to the bit.

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace gonio::proc {

struct NearPosition {
    double squaredDistance = 0;
    std::uint32_t position = 0;

    auto operator<=>(const NearPosition&) const = default;
};

/// At most how many, and how far at most (that distance included; infinity: no limit).
struct NearestLimits {
    std::size_t count = 1;
    double maxSquaredDistance = 0;
};

class NearestList {
public:
    explicit NearestList(const NearestLimits& limits) : limits_(limits) {}

    void offer(const NearPosition& candidate) {
        if (limits_.count == 0 || !(candidate.squaredDistance <= limits_.maxSquaredDistance))
            return;
        if (heap_.size() == limits_.count) {
            if (!(candidate < heap_.front())) return;
            std::pop_heap(heap_.begin(), heap_.end());
            heap_.back() = candidate;
        } else {
            heap_.push_back(candidate);
        }
        std::push_heap(heap_.begin(), heap_.end());
    }

    /// What is farther need not be offered.
    [[nodiscard]] double reach() const {
        if (limits_.count == 0) return -1;
        const bool full = heap_.size() == limits_.count;
        return full ? heap_.front().squaredDistance : limits_.maxSquaredDistance;
    }

    /// Nearest first.
    [[nodiscard]] std::vector<NearPosition> sorted() && {
        std::sort_heap(heap_.begin(), heap_.end());
        return std::move(heap_);
    }

private:
    NearestLimits limits_;
    std::vector<NearPosition> heap_;  ///< the farthest first
};

}  // namespace gonio::proc
