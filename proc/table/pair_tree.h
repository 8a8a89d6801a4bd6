#pragma once
// A k-d tree over pairs of directions, built once: exact nearest neighbours by the distance of
// pair_distance.h, in any symmetry. nanoflann's tree lies behind it. Searches may run on several
// threads at once.

#include <memory>
#include <vector>

#include "proc/table/nearest_list.h"
#include "proc/table/pair_distance.h"

namespace gonio::proc {

class PairTree {
public:
    /// A position is an index into `pairs`; fewer than 2^32 of them.
    PairTree(std::vector<LightView> pairs, PairSymmetry symmetry);
    ~PairTree();
    PairTree(const PairTree&) = delete;
    PairTree& operator=(const PairTree&) = delete;

    /// `found`, after an offer of all positions that can be in it and are not 0 in `live`.
    [[nodiscard]] NearestList search(const LightView& at,
                                     const std::vector<unsigned char>& live,
                                     NearestList found) const;

    /// Of the nodes, the coordinates and the order of the points.
    [[nodiscard]] std::size_t bytes() const;

private:
    struct Index;
    std::unique_ptr<const Index> index_;
};

}  // namespace gonio::proc
