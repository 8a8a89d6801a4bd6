#include "proc/radiance/merge.h"

#include <algorithm>
#include <vector>

#include "proc/core/parallel.h"
#include "proc/radiance/group_noise.h"
#include "proc/radiance/merge_blocks.h"

namespace gonio::proc {
namespace {

class Merger {
public:
    Merger(const BracketSums& sums, MergedState& out)
        : sums_(sums),
          bracket_{.electronsPerDn = sums.noise.electronsPerDn,
                   .members = static_cast<double>(sums.members())},
          out_(out) {
        for (const GroupSums& group : sums.groups) {
            figures_.push_back(figuresOf(group, sums));
            bracket_.frames += group.frames;
        }
    }

    void rows(IndexRange range, std::span<BlockTotals> sums) const {
        std::vector<GroupBlock> groups(sums_.groups.size());
        const int width = sums_.traits.size.width;
        for (std::size_t y = range.begin; y < range.end; ++y) {
            for (int x = 0; x < width; x += static_cast<int>(kBlock))
                merged(BlockAt{x, static_cast<int>(y)}, groups, sums[y]);
        }
    }

private:
    void merged(const BlockAt& at, std::vector<GroupBlock>& groups, BlockTotals& sum) const {
        for (std::size_t g = 0; g < groups.size(); ++g) readGroup(sums_, g, at, groups[g]);
        const BlockTotals totals = mergeBlock(groups,
                                              figures_,
                                              bracket_,
                                              {.radiance = at.of(out_.radiance),
                                               .variance = at.of(out_.variance),
                                               .used = at.of(out_.used),
                                               .saturated = at.of(out_.saturated)});
        sum.chiSquare += totals.chiSquare;
        sum.freedom += totals.freedom;
        sum.unused += totals.unused;
    }

    const BracketSums& sums_;
    std::vector<GroupFigures> figures_;
    BracketFigures bracket_;
    MergedState& out_;
};

MergedState blank(const BracketSums& sums) {
    MergedState state;
    const Size size = sums.traits.size;
    state.radiance = Image<float>(size);
    state.variance = Image<float>(size);
    state.used = Image<std::uint8_t>(size);
    state.saturated = Image<std::uint8_t>(size);
    state.window = sums.traits.window;
    state.led = sums.traits.led;
    state.band = sums.band;
    return state;
}

}  // namespace

Result<MergedState> mergeSums(const BracketSums& sums) {
    if (sums.groups.empty())
        return Error{.kind = ErrorKind::Quality, .message = "merge: the bracket has no frames"};
    MergedState state = blank(sums);
    const Merger merger(sums, state);
    const auto height = static_cast<std::size_t>(sums.traits.size.height);
    std::vector<BlockTotals> rows(height);  // added in order: the sum is the same on any cores
    parallelFor(height, [&](IndexRange range) { merger.rows(range, rows); });
    for (const BlockTotals& row : rows) {
        state.allSaturatedPixels += static_cast<std::size_t>(row.unused);
        state.freedom += static_cast<std::size_t>(row.freedom);
        state.chiSquare += row.chiSquare;
    }
    return state;
}

Result<MergedState> merge(std::span<const Frame> bracket,
                          Band band,
                          const DarkLibrary& darks,
                          const SensorNoise& noise,
                          const Linearity& linearity) {
    MergeAccumulator accumulator(band, darks, noise, linearity);
    for (const Frame& frame : bracket)
        if (Result<void> added = accumulator.add(frame); !added) return added.error();
    return mergeSums(accumulator.sums());
}

}  // namespace gonio::proc
