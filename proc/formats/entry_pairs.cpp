#include "proc/formats/entry_pairs.h"

#include <algorithm>
#include <bit>

namespace gonio::proc {
namespace {

bool sameAngles(const EntryColumns& c, std::size_t a, std::size_t b) {
    return c.thetaOut[a] == c.thetaOut[b] && c.phiOut[a] == c.phiOut[b] &&
           c.thetaIn[a] == c.thetaIn[b] && c.phiIn[a] == c.phiIn[b];
}

/// The number of the pair under way in which each channel was seen last.
class SeenChannels {
public:
    explicit SeenChannels(std::size_t channels) : lastPair_(channels, kNever) {}

    /// True where it was not there yet.
    bool take(std::size_t channel, std::uint32_t pair) {
        if (lastPair_[channel] == pair) return false;
        lastPair_[channel] = pair;
        return true;
    }

private:
    static constexpr std::uint32_t kNever = UINT32_MAX;
    std::vector<std::uint32_t> lastPair_;
};

EntryPairs ofNeighbours(const EntryColumns& columns) {
    EntryPairs pairs;
    const std::size_t entries = columns.channel.size();
    pairs.pairOf.reserve(entries);
    SeenChannels seen(columns.channels);
    for (std::size_t i = 0; i < entries; ++i) {
        auto pair = static_cast<std::uint32_t>(pairs.firstOf.size());
        const bool same = i > 0 && sameAngles(columns, i - 1, i);
        if (!same || !seen.take(columns.channel[i], pair - 1)) {
            pairs.firstOf.push_back(static_cast<std::uint32_t>(i));
            seen.take(columns.channel[i], pair);
        } else {
            --pair;
        }
        pairs.pairOf.push_back(pair);
    }
    return pairs;
}

bool slowestChannels(const EntryColumns& columns) {
    const std::size_t entries = columns.channel.size();
    if (entries % columns.channels != 0) return false;
    const std::size_t block = entries / columns.channels;
    for (std::size_t i = 0; i < entries; ++i) {
        if (columns.channel[i] != columns.channel[i - i % block]) return false;
        if (!sameAngles(columns, i, i % block)) return false;
    }
    // Each block another channel: they are as many as there are channels, all of which occur.
    std::vector<bool> seen(columns.channels, false);
    for (std::size_t i = 0; i < entries; i += block) {
        if (seen[columns.channel[i]]) return false;
        seen[columns.channel[i]] = true;
    }
    return true;
}

EntryPairs ofBlocks(const EntryColumns& columns) {
    EntryPairs pairs;
    const std::size_t block = columns.channel.size() / columns.channels;
    pairs.pairOf.reserve(columns.channel.size());
    for (std::size_t i = 0; i < columns.channel.size(); ++i) {
        pairs.pairOf.push_back(static_cast<std::uint32_t>(i % block));
    }
    for (std::size_t i = 0; i < block; ++i) {
        pairs.firstOf.push_back(static_cast<std::uint32_t>(i));
    }
    return pairs;
}

std::uint64_t mixed(std::uint64_t hash, double value) {
    // -0 and 0 are equal.
    const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);
    hash = (hash ^ bits) * 0x9E3779B97F4A7C15ULL;
    return hash ^ (hash >> 29);
}

/// Open addressing over the latest pair of each set of angles.
class AnglesIndex {
public:
    explicit AnglesIndex(const EntryColumns& columns)
        : columns_(columns), slots_(std::bit_ceil(2 * columns.channel.size() + 1), kFree) {}

    /// The slot of these angles: free, or with the pair that had them last.
    std::uint32_t& slotOf(std::size_t entry, const std::vector<std::uint32_t>& firstOf) {
        std::uint64_t hash = mixed(0, columns_.thetaOut[entry]);
        hash = mixed(hash, columns_.phiOut[entry]);
        hash = mixed(hash, columns_.thetaIn[entry]);
        hash = mixed(hash, columns_.phiIn[entry]);
        std::size_t at = hash & (slots_.size() - 1);
        while (slots_[at] != kFree && !sameAngles(columns_, entry, firstOf[slots_[at]])) {
            at = (at + 1) & (slots_.size() - 1);
        }
        return slots_[at];
    }
    static constexpr std::uint32_t kFree = UINT32_MAX;

private:
    const EntryColumns& columns_;
    std::vector<std::uint32_t> slots_;
};

/// Which channels of which pairs there are; open addressing, one slot per entry and more.
class TakenChannels {
public:
    explicit TakenChannels(std::size_t entries) : slots_(std::bit_ceil(2 * entries + 1), kFree) {}

    /// True where it was not there yet.
    bool take(std::uint32_t pair, std::uint32_t channel) {
        const std::uint64_t key = std::uint64_t{pair} << 32 | channel;
        std::size_t at = (key * 0x9E3779B97F4A7C15ULL >> 20) & (slots_.size() - 1);
        while (slots_[at] != kFree && slots_[at] != key) at = (at + 1) & (slots_.size() - 1);
        if (slots_[at] == key) return false;
        slots_[at] = key;
        return true;
    }

private:
    static constexpr std::uint64_t kFree = UINT64_MAX;
    std::vector<std::uint64_t> slots_;
};

EntryPairs bySearch(const EntryColumns& columns) {
    EntryPairs pairs;
    pairs.pairOf.reserve(columns.channel.size());
    AnglesIndex index(columns);
    TakenChannels taken(columns.channel.size());
    for (std::size_t i = 0; i < columns.channel.size(); ++i) {
        std::uint32_t& slot = index.slotOf(i, pairs.firstOf);
        if (slot == AnglesIndex::kFree || !taken.take(slot, columns.channel[i])) {
            slot = static_cast<std::uint32_t>(pairs.firstOf.size());
            pairs.firstOf.push_back(static_cast<std::uint32_t>(i));
            taken.take(slot, columns.channel[i]);
        }
        pairs.pairOf.push_back(slot);
    }
    return pairs;
}

}  // namespace

EntryPairs pairEntries(const EntryColumns& columns) {
    EntryPairs pairs = ofNeighbours(columns);
    if (pairs.firstOf.size() * columns.channels == columns.channel.size()) return pairs;
    if (slowestChannels(columns)) return ofBlocks(columns);
    return bySearch(columns);
}

}  // namespace gonio::proc
