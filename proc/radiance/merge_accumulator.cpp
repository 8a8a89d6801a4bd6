#include "proc/radiance/merge_accumulator.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "proc/radiance/merge_blocks.h"
#include "proc/radiance/saturation.h"

namespace gonio::proc {
namespace {

constexpr int kMostWitnesses = 128;  // in either direction

Error refused(const std::string& what) {
    return {.kind = ErrorKind::Quality, .message = "merge: " + what};
}

/// How many frames can be alike before the sum of their largest usable samples overflows.
std::uint32_t mostAlike(const SensorNoise& noise) {
    const double largest = std::clamp(std::ceil(noise.ceilingDn()), 1.0, 65535.0);
    return std::min(kMostAlike, kLargestSum / static_cast<std::uint32_t>(largest));
}

/// 1 for each pixel of the row that is usable, hot ones by their own verdict.
void markRow(const Frame& frame,
             const DarkFrame& dark,
             int y,
             const SensorNoise& noise,
             std::span<std::uint8_t> usable) {
    markUsable(frame.pixels, y, noise, usable);
    for (const HotPixel& hot : dark.hotInRow(y)) {
        const bool good = usableReference(frame.pixels, hot.x, y, noise, hot.excessDn);
        usable[static_cast<std::size_t>(hot.x)] = good ? 1 : 0;
    }
}

/// The row's witness pixels. A hot one says more of itself than of the light.
void addWitnesses(const Frame& frame,
                  const DarkFrame& dark,
                  int y,
                  std::span<std::uint8_t> usable,
                  const WitnessGrid& grid,
                  std::vector<std::uint16_t>& out) {
    for (const HotPixel& hot : dark.hotInRow(y)) usable[static_cast<std::size_t>(hot.x)] = 0;
    for (int i = 0; i < grid.size.width; ++i) {
        const int x = grid.at(i);
        const bool good = usable[static_cast<std::size_t>(x)] == 1;
        out.push_back(good ? frame.pixels.at(x, y) : Witness::kMasked);
    }
}

}  // namespace

WitnessGrid WitnessGrid::over(Size picture) {
    const int longest = std::max(picture.width, picture.height);
    WitnessGrid grid;
    grid.step = (longest + kMostWitnesses - 1) / kMostWitnesses;
    grid.first = (std::min(grid.step, std::min(picture.width, picture.height)) - 1) / 2;
    const auto count = [&](int length) {
        return (length - grid.first + grid.step - 1) / grid.step;
    };
    grid.size = {count(picture.width), count(picture.height)};
    return grid;
}

MergeAccumulator::MergeAccumulator(Band band,
                                   const DarkLibrary& darks,
                                   const SensorNoise& noise,
                                   Linearity linearity)
    : darks_(darks) {
    sums_.band = band;
    sums_.noise = noise;
    sums_.linearity = std::move(linearity);
}

void MergeAccumulator::restart(Band band) {
    for (GroupSums& group : sums_.groups) spare_.push_back(std::move(group.tallies));
    sums_.band = band;
    sums_.groups.clear();
    sums_.witnesses.clear();
    begun_ = false;
}

/// All zero, in memory of before if it fits.
Image<std::uint32_t> MergeAccumulator::freshTallies() {
    while (!spare_.empty()) {
        Image<std::uint32_t> tallies = std::move(spare_.back());
        spare_.pop_back();
        if (tallies.size() != sums_.traits.size) continue;
        std::fill(tallies.pixels().begin(), tallies.pixels().end(), 0U);
        return tallies;
    }
    return Image<std::uint32_t>(sums_.traits.size);
}

/// The place of the frame's group, which is made when it is the first of its kind.
Result<std::size_t> MergeAccumulator::groupOf(const Frame& frame) {
    const std::uint16_t level = frame.levels[sums_.band];
    const auto key = std::pair(frame.exposure.granted, level);
    auto& groups = sums_.groups;
    const auto at = std::lower_bound(
        groups.begin(), groups.end(), key, [](const GroupSums& group, const auto& wanted) {
            return std::pair(group.granted, group.level) < wanted;
        });
    const auto index = static_cast<std::size_t>(at - groups.begin());
    if (at != groups.end() && std::pair(at->granted, at->level) == key) return index;
    const Result<const DarkFrame*> dark = darks_.find(frame);
    if (!dark) return dark.error().in("merge");
    groups.insert(at,
                  {.granted = frame.exposure.granted,
                   .level = level,
                   .dark = *dark,
                   .seconds = frame.exposure.seconds(),
                   .tau = effectiveSeconds(frame, sums_.band),
                   .frames = 0,
                   .tallies = freshTallies()});
    for (Witness& witness : sums_.witnesses)
        if (witness.group >= index) ++witness.group;
    return index;
}

Result<void> MergeAccumulator::add(const Frame& frame) {
    if (!begun_) {
        const Result<BracketTraits> traits = traitsOf(frame, sums_.band);
        if (!traits) return traits.error();
        sums_.traits = *traits;
        sums_.grid = WitnessGrid::over(traits->size);
    }
    if (Result<void> belongs = checkBelongs(frame, sums_.traits, sums_.band); !belongs)
        return belongs;
    const Result<std::size_t> index = groupOf(frame);
    if (!index) return index.error();
    GroupSums& group = sums_.groups[*index];
    if (const std::uint32_t most = mostAlike(sums_.noise);
        static_cast<std::uint32_t>(group.frames) >= most) {
        return refused("more than " + std::to_string(most) + " frames of the same exposure");
    }
    begun_ = true;
    ++group.frames;
    Witness& witness = sums_.witnesses.emplace_back();
    witness.number = frame.number;
    witness.group = *index;
    witness.dn.reserve(sums_.grid.size.pixels());
    std::vector<std::uint8_t> usable(static_cast<std::size_t>(sums_.traits.size.width));
    for (int y = 0; y < sums_.traits.size.height; ++y) {
        markRow(frame, *group.dark, y, sums_.noise, usable);
        addUsable(frame.pixels.row(y), usable, group.tallies.row(y));
        if (y >= sums_.grid.first && (y - sums_.grid.first) % sums_.grid.step == 0)
            addWitnesses(frame, *group.dark, y, usable, sums_.grid, witness.dn);
    }
    return {};
}

std::size_t MergeAccumulator::bytes() const {
    std::size_t bytes = 0;
    for (const GroupSums& group : sums_.groups)
        bytes += group.tallies.pixels().size() * sizeof(std::uint32_t);
    for (const Image<std::uint32_t>& tallies : spare_)
        bytes += tallies.pixels().size() * sizeof(std::uint32_t);
    for (const Witness& witness : sums_.witnesses)
        bytes += witness.dn.size() * sizeof(std::uint16_t);
    return bytes;
}

}  // namespace gonio::proc
