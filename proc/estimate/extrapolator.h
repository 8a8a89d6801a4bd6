#pragma once
// One link of a chain of estimators [Cezner2023, figure 19]: within its own region, which is beyond
// an edge in the polar angle of one of the two directions, it answers out of what the inner one
// answers at the edge; elsewhere it hands the question on unchanged. Chained, outgoing first, an
// extrapolation over the angle of incidence uses outgoing data that are already extrapolated.
//
// The nearest pair of the known region has the same directions but for that polar angle, which is
// the edge's. So f is continuous at the edge with every method but "none". Beyond it: source and
// flag extrapolated, u those of the values used; what the method is wrong by is not in them. No
// answer at the edge: none beyond it.

#include <memory>
#include <utility>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"

namespace gonio::proc {

enum class Side {
    Outgoing,
    Incoming
};

/// The region: theta of this side above the edge, up to 90 degrees.
struct Beyond {
    Side side = Side::Outgoing;
    Radians edge = 75_deg;
};

/// A Usage error unless the edge lies in [0, 90) degrees.
[[nodiscard]] Result<void> checkBeyond(const Beyond& beyond);

class Extrapolator : public Scatterer {
public:
    Extrapolator(std::unique_ptr<Scatterer> inner, const Beyond& beyond)
        : inner_(std::move(inner)), beyond_(beyond) {}

    [[nodiscard]] Answer answer(const LightView& pair) const final;
    [[nodiscard]] BandCount bandCount() const override { return inner_->bandCount(); }

protected:
    /// What the method says at a pair of the region, above the horizon.
    [[nodiscard]] virtual Answer outside(const LightView& pair) const = 0;

    /// What the inner one says at the same pair with this polar angle on the link's side.
    [[nodiscard]] Answer innerAt(const LightView& pair, Radians theta) const;
    [[nodiscard]] Answer atEdge(const LightView& pair) const { return innerAt(pair, edge()); }
    [[nodiscard]] Radians edge() const { return beyond_.edge; }
    [[nodiscard]] Radians thetaOf(const LightView& pair) const;
    /// 0 at the edge, 1 at 90 degrees.
    [[nodiscard]] double partTo90(const LightView& pair) const;

private:
    [[nodiscard]] const Direction& sideOf(const LightView& pair) const;

    std::unique_ptr<Scatterer> inner_;
    Beyond beyond_;
};

/// The link of one method, whose options have been checked.
template <class Method, class... Options>
[[nodiscard]] Result<std::unique_ptr<Scatterer>> makeExtrapolator(std::unique_ptr<Scatterer> inner,
                                                                  const Beyond& beyond,
                                                                  const Options&... options) {
    if (const auto checked = checkBeyond(beyond); !checked) return checked.error();
    return std::unique_ptr<Scatterer>(
        std::make_unique<Method>(std::move(inner), beyond, options...));
}

/// An answer times a factor, as an extrapolated one.
[[nodiscard]] Answer extrapolated(const Answer& from, double factor);

}  // namespace gonio::proc
