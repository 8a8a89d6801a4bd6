#pragma once
// The makers of the models by family, for spec.cpp: each takes a lobe's parameters and the path,
// and leaves its complaints in the parameters.

#include <array>
#include <memory>
#include <span>
#include <string_view>

#include "proc/models/analytic.h"
#include "proc/models/spec_parameters.h"

namespace gonio::proc {

using Lobe = std::unique_ptr<const AnalyticModel>;

struct CatalogueEntry {
    std::string_view name;
    Lobe (*make)(SpecParameters&, EvalPath);
};

[[nodiscard]] std::span<const CatalogueEntry> diffuseModels();
[[nodiscard]] std::span<const CatalogueEntry> cosineModels();
[[nodiscard]] std::span<const CatalogueEntry> blinnPhongModels();
[[nodiscard]] std::span<const CatalogueEntry> slopeModels();
[[nodiscard]] std::span<const CatalogueEntry> microfacetModels();
[[nodiscard]] std::span<const CatalogueEntry> materialModels();
[[nodiscard]] std::span<const CatalogueEntry> publishedModels();

inline constexpr ValueRange kShare{0, 1};
inline constexpr ValueRange kAlphaRange{1e-7, 1};
inline constexpr ValueRange kFactorRange{0, 1e3};  ///< a float holds the sharpest lobe times it
inline constexpr ValueRange kExponentRange{0, 1e6};
inline constexpr ValueRange kIndexRange{1e-3, 1e3};

}  // namespace gonio::proc
