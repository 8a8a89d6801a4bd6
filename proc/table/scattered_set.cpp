#include "proc/table/scattered_set.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "proc/table/pair_tree.h"

namespace gonio::proc {
namespace {

/// A walk over so few costs less than a tree.
constexpr std::size_t kFew = 64;
constexpr std::size_t kPendingShare = 16;

bool allFinite(const LedBands& bands) {
    return std::all_of(
        bands.value.begin(), bands.value.end(), [](double v) { return std::isfinite(v); });
}

bool isUncertainty(const std::optional<LedBands>& u) {
    return !u || std::all_of(u->value.begin(), u->value.end(), [](double v) {
        return std::isfinite(v) && v >= 0;
    });
}

/// What is wrong with a sample; empty where nothing is.
std::string complaint(const ScatteredSample& sample) {
    if (!allFinite(sample.f)) return "f is not finite";
    if (!isUncertainty(sample.uRandom)) return "u_random is not a finite number of at least 0";
    if (!isUncertainty(sample.uSystematic))
        return "u_systematic is not a finite number of at least 0";
    return "";
}

NearestLimits limitsOf(const NeighbourQuery& query) {
    const bool none = !(query.maxDistance >= 0);
    return {none ? 0 : query.count, query.maxDistance * query.maxDistance};
}

}  // namespace

Result<SampleId> ScatteredSet::add(const ScatteredSample& sample) {
    return add(std::span(&sample, 1));
}

Result<SampleId> ScatteredSet::add(std::span<const ScatteredSample> samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (const std::string wrong = complaint(samples[i]); !wrong.empty()) {
            return Error{ErrorKind::File,
                         "scattered samples: sample " + std::to_string(i + 1) + " of " +
                             std::to_string(samples.size()) + ": " + wrong};
        }
    }
    const SampleId first = nextId_;
    samples_.insert(samples_.end(), samples.begin(), samples.end());
    live_.resize(samples_.size(), 1);
    while (ids_.size() < samples_.size()) ids_.push_back(nextId_++);
    size_ += samples.size();
    rebuildIfDue();
    return first;
}

bool ScatteredSet::remove(SampleId id) {
    const std::size_t position = positionOf(id);
    if (position == ids_.size()) return false;
    live_[position] = 0;
    --size_;
    rebuildIfDue();
    return true;
}

/// ids_.size() where there is none.
std::size_t ScatteredSet::positionOf(SampleId id) const {
    const auto at = std::lower_bound(ids_.begin(), ids_.end(), id);
    const auto position = static_cast<std::size_t>(at - ids_.begin());
    const bool there = at != ids_.end() && *at == id && live_[position] != 0;
    return there ? position : ids_.size();
}

const ScatteredSample* ScatteredSet::find(SampleId id) const {
    const std::size_t position = positionOf(id);
    return position == ids_.size() ? nullptr : &samples_[position];
}

std::vector<SampleId> ScatteredSet::ids() const {
    std::vector<SampleId> all;
    all.reserve(size_);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
        if (live_[i] != 0) all.push_back(ids_[i]);
    }
    return all;
}

void ScatteredSet::rebuildIfDue() {
    const std::size_t pending = samples_.size() - inTree_;
    const std::size_t removed = samples_.size() - size_;
    if (pending > std::max(kFew, samples_.size() / kPendingShare) ||
        removed > std::max(kFew, samples_.size() / 2) || size_ == 0) {
        rebuild();
    }
}

void ScatteredSet::rebuild() {
    dropRemoved();
    tree_.reset();
    inTree_ = size_;
    if (size_ == 0) return;
    std::vector<LightView> pairs;
    pairs.reserve(size_);
    for (const ScatteredSample& sample : samples_) pairs.push_back(sample.pair);
    tree_ = std::make_shared<const PairTree>(std::move(pairs), symmetry_);
}

void ScatteredSet::dropRemoved() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        if (live_[i] == 0) continue;
        samples_[kept] = samples_[i];
        ids_[kept++] = ids_[i];
    }
    samples_.resize(kept);
    ids_.resize(kept);
    live_.assign(kept, 1);
}

NearestList ScatteredSet::walk(const LightView& at, std::size_t from, NearestList found) const {
    for (std::size_t i = from; i < samples_.size(); ++i) {
        if (live_[i] == 0) continue;
        found.offer(
            {squaredDistance(at, samples_[i].pair, symmetry_), static_cast<std::uint32_t>(i)});
    }
    return found;
}

std::vector<Neighbour> ScatteredSet::neighbours(NearestList found) const {
    std::vector<Neighbour> all;
    for (const NearPosition& near : std::move(found).sorted()) {
        all.push_back({ids_[near.position], std::sqrt(near.squaredDistance)});
    }
    return all;
}

std::vector<Neighbour> ScatteredSet::nearest(const LightView& at,
                                             const NeighbourQuery& query) const {
    NearestList found(limitsOf(query));
    if (tree_) found = tree_->search(at, live_, std::move(found));
    return neighbours(walk(at, inTree_, std::move(found)));
}

std::vector<Neighbour> ScatteredSet::nearestByBruteForce(const LightView& at,
                                                         const NeighbourQuery& query) const {
    return neighbours(walk(at, 0, NearestList(limitsOf(query))));
}

std::size_t ScatteredSet::treeBytes() const { return tree_ ? tree_->bytes() : 0; }

std::size_t ScatteredSet::sampleBytes() const {
    return samples_.capacity() * sizeof(ScatteredSample) + ids_.capacity() * sizeof(SampleId) +
           live_.capacity();
}

}  // namespace gonio::proc
