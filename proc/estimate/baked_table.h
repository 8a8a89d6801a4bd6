#pragma once
// A table of f over LobeBox, trilinear, for those who ask millions of times: a few tens of
// nanoseconds an answer, nothing allocated, one pair or arrays of them.
//   with a carrier      what is stored is f / carrier, and f = ratio carrier: the carrier has the
//                       peak and the decades, the ratio is smooth. It may be negative.
//   without             log2(f): f that is not positive is held as 2^-30.
// Stored per node: R, G, B and the relative error that interpolation makes there, as floats (16
// bytes) or halves (8 bytes; 2^-11 of a ratio).
//
// Isotropic and reciprocal: a scatterer that is not is baked as its plane at phi_h = 0 shows it
// with the light further from the horizon; BakeReport::asymmetry says by how much that is wrong. At
// theta_h > 89.5 degrees: the last node. At and below the horizon, at a NaN, and where the baked
// scatterer gave no answer to a corner of the cell: NaN, no answer.
// Source `interpolated`; u_systematic is the interpolation's own error, k = 1: what the baked
// scatterer was uncertain by is not in it.

#include <memory>
#include <variant>
#include <vector>

#include "proc/estimate/half_float.h"
#include "proc/estimate/lobe_box.h"
#include "proc/models/analytic.h"

namespace gonio::proc {

enum class TableStorage {
    Float,
    Half
};

/// A node's four numbers. The relative error is held in units of kErrorUnit: as it is, a half would
/// hold it as a denormal, which processors multiply slowly. It ends at 64, the most that a half
/// then holds; where there was nothing to learn it from, it is the table's worst.
template <class Number>
struct BakedNode {
    Number r{}, g{}, b{}, error{};
};
inline constexpr float kErrorUnit = 0x1p-10F;
using BakedNodes = std::variant<std::vector<BakedNode<float>>, std::vector<BakedNode<Half16>>>;

struct BakeReport {
    std::size_t unanswered = 0;  ///< nodes
    std::size_t notHeld = 0;     ///< nodes whose f was not positive, without a carrier
    double worstError = 0;       ///< relative, over the middles of all cells, bands of f not 0
    /// Largest relative difference when a pair is turned about the normal or swapped, of a few.
    double asymmetry = 0;
};

class BakedTable final : public Scatterer {
public:
    /// As many nodes as the axes have; `carrier` may be empty. bakeTable makes them.
    BakedTable(const BoxAxes& axes,
               BakedNodes nodes,
               std::unique_ptr<const AnalyticModel> carrier,
               const BakeReport& report);

    /// f in 1/sr.
    [[nodiscard]] LedBands evaluate(const LightView& pair) const;
    /// Of every pair, at most 256 at a time on vector units; as many f as pairs.
    void evaluate(const PairArrays<float>& pairs, const BandArrays<float>& f) const;
    [[nodiscard]] Answer answer(const LightView& pair) const override;

    [[nodiscard]] const BoxAxes& axes() const { return axes_; }
    [[nodiscard]] const BakedNodes& nodes() const { return nodes_; }
    /// Null where log2(f) is stored.
    [[nodiscard]] const AnalyticModel* carrier() const { return carrier_.get(); }
    [[nodiscard]] const BakeReport& report() const { return report_; }
    [[nodiscard]] TableStorage storage() const;
    /// Of the nodes.
    [[nodiscard]] std::size_t bytes() const;

private:
    struct Found;
    [[nodiscard]] Found find(const LightView& pair) const;

    BoxAxes axes_;
    BakedNodes nodes_;
    std::unique_ptr<const AnalyticModel> carrier_;
    BakeReport report_;
};

/// The same f by textbook formulas in double: angles by atan2, logarithms and powers by the
/// library, eight corners in a loop.
[[nodiscard]] LedBands evaluateReference(const BakedTable& table, const LightView& pair);

}  // namespace gonio::proc
