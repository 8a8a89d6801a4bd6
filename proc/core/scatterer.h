#pragma once
// The one interface that evaluates everything: models, tables, files and estimators implement it;
// sim, render, scene, export and eval take nothing else.

#include <optional>

#include "proc/core/bands.h"
#include "proc/core/direction.h"
#include "proc/core/flags.h"

namespace gonio {

/// f in 1/sr per band, standard uncertainties where known, and where the answer came from.
/// No answer (below the horizon, no data there): f = NaN and the flags say why.
struct Answer {
    LedBands f;
    std::optional<LedBands> uRandom;
    std::optional<LedBands> uSystematic;
    Flags flags;
    Source source = Source::Analytic;

    /// No f here; the flags say why.
    [[nodiscard]] static Answer none(Flags why, Source source);
    [[nodiscard]] bool present() const;
    /// Combined standard uncertainty of f; empty where nothing is known of it.
    [[nodiscard]] std::optional<double> u(Band band) const;
};

/// Whether f differs between the bands: a monochrome file has one column, not three equal ones.
enum class BandCount {
    One,
    Three
};

class Scatterer {
public:
    virtual ~Scatterer() = default;
    /// Total over all pairs: wi or wo at or below the horizon answers none({BelowHorizon}).
    [[nodiscard]] virtual Answer answer(const LightView& pair) const = 0;
    [[nodiscard]] virtual BandCount bandCount() const { return BandCount::Three; }
};

}  // namespace gonio
