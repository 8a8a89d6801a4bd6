#include "proc/export/half_difference_fill.h"

#include <limits>
#include <vector>

#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

/// What a node was answered, as bits.
enum Got : unsigned char {
    Asked = 1,
    Answered = 2,
    Uncertain = 4,
    Extrapolated = 8
};

unsigned char ask(const Scatterer& from, HalfDifferenceTable& table, std::size_t i) {
    const LightView pair = table.pairAt(table.nodeAt(i));
    if (!aboveHorizon(pair)) return 0;
    const Answer answer = from.answer(pair);
    if (!answer.present()) return Asked;
    for (std::size_t band = 0; band < 3; ++band) table.planes[band][i] = answer.f.value[band];
    unsigned got = Asked | Answered;
    if (answer.uRandom || answer.uSystematic) got |= Uncertain;
    if (answer.flags.has(Flag::Extrapolated)) got |= Extrapolated;
    return static_cast<unsigned char>(got);
}

}  // namespace

FilledHalfDifference fillHalfDifference(const Scatterer& from, HalfDifferenceTable grid) {
    FilledHalfDifference filled{.table = std::move(grid)};
    HalfDifferenceTable& table = filled.table;
    const std::size_t nodes = table.nodeCount();
    for (auto& plane : table.planes) plane.assign(nodes, std::numeric_limits<double>::quiet_NaN());
    std::vector<unsigned char> got(nodes);
    parallelFor(nodes, [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) got[i] = ask(from, table, i);
    });
    for (const unsigned char g : got) {
        filled.nodes += (g & Asked) != 0 ? 1U : 0U;
        filled.unanswered += (g & (Asked | Answered)) == Asked ? 1U : 0U;
        filled.uncertain += (g & Uncertain) != 0 ? 1U : 0U;
        filled.extrapolated += (g & Extrapolated) != 0 ? 1U : 0U;
    }
    return filled;
}

FilledHalfDifference fillHalfDifference(const Scatterer& from) {
    return fillHalfDifference(from, HalfDifferenceTable{});
}

}  // namespace gonio::proc
