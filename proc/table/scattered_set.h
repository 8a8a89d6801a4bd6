#pragma once
// BRDF samples at any pairs of directions, in no order, with the nearest ones to a pair.
//
// Nearest by the distance of pair_distance.h under the set's symmetry, ordered by (distance, id).
// A tree is built over the samples; those added since are walked through, and the tree is built
// anew when they are more than 64 and more than a sixteenth of the set. A removed sample stays in
// the tree, unseen, until more than half of it are such. All that happens in add and remove: a
// const set may be asked from several threads at once.
//
// At the door: f of every band finite (noise may make it 0 or negative, which is kept), u finite
// and not negative. Missing values are not samples.

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/table/nearest_list.h"
#include "proc/table/pair_distance.h"

namespace gonio::proc {

class PairTree;

/// One BRDF sample; u are standard (k = 1) and empty where nothing is known of them.
struct ScatteredSample {
    LightView pair;
    LedBands f;  ///< 1/sr
    std::optional<LedBands> uRandom;
    std::optional<LedBands> uSystematic;
    Flags flags{Flag::Measured};
};

/// Counts up from 0 in the order of adding; never given twice.
using SampleId = std::uint64_t;

struct Neighbour {
    SampleId id = 0;
    double distance = 0;

    bool operator==(const Neighbour&) const = default;
};

/// At most `count` neighbours, none farther than `maxDistance` (which may be infinite).
struct NeighbourQuery {
    std::size_t count = 1;
    double maxDistance = std::numeric_limits<double>::infinity();
};

class ScatteredSet {
public:
    explicit ScatteredSet(PairSymmetry symmetry = PairSymmetry::None,
                          BandCount bands = BandCount::Three)
        : symmetry_(symmetry), bands_(bands) {}

    /// Its id; a File error for what is refused at the door.
    Result<SampleId> add(const ScatteredSample& sample);
    /// All or none; the id of the first one (the others follow), or the next one's where there are
    /// none.
    Result<SampleId> add(std::span<const ScatteredSample> samples);
    /// False where there is no such sample.
    bool remove(SampleId id);

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] PairSymmetry symmetry() const { return symmetry_; }
    /// One: f is the same in the three bands.
    [[nodiscard]] BandCount bandCount() const { return bands_; }
    /// Null where there is no such sample; valid until the next add or remove.
    [[nodiscard]] const ScatteredSample* find(SampleId id) const;
    /// Of all samples, ascending.
    [[nodiscard]] std::vector<SampleId> ids() const;

    [[nodiscard]] std::vector<Neighbour> nearest(const LightView& at,
                                                 const NeighbourQuery& query) const;
    /// The same by a walk over all samples: the slow twin.
    [[nodiscard]] std::vector<Neighbour> nearestByBruteForce(const LightView& at,
                                                             const NeighbourQuery& query) const;

    /// Of the tree with its own copy of the pairs.
    [[nodiscard]] std::size_t treeBytes() const;
    /// Of the samples with their ids.
    [[nodiscard]] std::size_t sampleBytes() const;

private:
    [[nodiscard]] std::size_t positionOf(SampleId id) const;
    [[nodiscard]] NearestList walk(const LightView& at, std::size_t from, NearestList found) const;
    [[nodiscard]] std::vector<Neighbour> neighbours(NearestList found) const;
    void rebuildIfDue();
    void rebuild();
    void dropRemoved();

    PairSymmetry symmetry_;
    BandCount bands_;
    SampleId nextId_ = 0;
    std::size_t size_ = 0;  ///< without removed ones
    // By position: in the order of ids, removed ones included.
    std::vector<ScatteredSample> samples_;
    std::vector<SampleId> ids_;
    std::vector<unsigned char> live_;
    std::size_t inTree_ = 0;                ///< positions below this are in the tree
    std::shared_ptr<const PairTree> tree_;  ///< never changes: copies of the set share it
};

}  // namespace gonio::proc
