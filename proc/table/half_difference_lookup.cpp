#include "proc/table/half_difference_lookup.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "proc/core/coordinates.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

/// Between which of evenly spaced nodes, and whether beyond the last of them.
struct EvenPlace {
    AxisPlace place;
    bool beyond = false;
};

/// `at` in nodes; within 1e-9 of a node it is that node.
EvenPlace placeAmong(std::size_t count, double at) {
    const double nearest = std::round(at);
    const bool node = std::abs(at - nearest) <= 1e-9;
    const auto low = static_cast<std::size_t>(std::max(0.0, node ? nearest : std::floor(at)));
    if (low + 1 >= count) return {{count - 1, count - 1, 0}, low + 1 > count || !node};
    if (node) return {{low, low, 0}, false};
    return {{low, low + 1, at - static_cast<double>(low)}, false};
}

/// The same where the node after the last is the first one.
AxisPlace placeRound(std::size_t count, double at) {
    AxisPlace place = placeAmong(count + 2, at).place;
    place.low %= count;
    place.high %= count;
    return place;
}

struct TablePlace {
    EvenPlace thetaHalf, thetaDiff;
    AxisPlace phiDiff;

    TablePlace(const HalfDifferenceTable& table, const HalfDifference& at)
        : thetaHalf(placeAmong(
              table.thetaHalfCount,
              static_cast<double>(table.thetaHalfCount) * std::sqrt(at.thetaHalf.degrees() / 90))),
          thetaDiff(
              placeAmong(table.thetaDiffCount,
                         static_cast<double>(table.thetaDiffCount) * at.thetaDiff.degrees() / 90)),
          phiDiff(placeRound(table.phiDiffCount,
                             static_cast<double>(table.phiDiffCount) *
                                 std::fmod(at.phiDiff.degrees() / table.phiSpanDeg(), 1.0))) {}

    [[nodiscard]] Source source() const {
        if (thetaHalf.beyond || thetaDiff.beyond) return Source::Extrapolated;
        const bool node = thetaHalf.place.t == 0 && thetaDiff.place.t == 0 && phiDiff.t == 0;
        return node ? Source::Measured : Source::Interpolated;
    }
};

double valueAt(const HalfDifferenceTable& table, std::size_t band, const TablePlace& at) {
    return between(at.thetaHalf.place, [&](std::size_t h) {
        return between(at.thetaDiff.place, [&](std::size_t d) {
            return between(at.phiDiff, [&](std::size_t p) {
                return table.planes[band][table.index({h, d, p})];
            });
        });
    });
}

Flag flagOf(Source source) {
    if (source == Source::Extrapolated) return Flag::Extrapolated;
    return source == Source::Measured ? Flag::Measured : Flag::Interpolated;
}

}  // namespace

Result<HalfDifferenceLookup> HalfDifferenceLookup::over(HalfDifferenceTable table) {
    for (const auto& plane : table.planes) {
        if (plane.empty() || plane.size() != table.nodeCount()) {
            return Error{ErrorKind::File,
                         "look-up: plane has " + std::to_string(plane.size()) +
                             " values, its axes want " + std::to_string(table.nodeCount())};
        }
    }
    return HalfDifferenceLookup(std::move(table));
}

Answer HalfDifferenceLookup::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const auto angles = toHalfDifference(pair);
    if (!angles) return Answer::none({}, Source::Interpolated);
    const TablePlace place(table_, *angles);
    Answer answer;
    answer.source = place.source();
    for (const Band band : kBands) answer.f[band] = valueAt(table_, index(band), place);
    if (!answer.present()) return Answer::none({}, answer.source);
    answer.flags.set(flagOf(answer.source));
    return answer;
}

}  // namespace gonio::proc
