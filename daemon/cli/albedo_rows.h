#pragma once
// Directional-hemispherical albedo at a list of incidences and the mean, as `albedo` and `info`
// say it.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/core/units.h"
#include "proc/estimate/albedo.h"

namespace gonio::daemon {

/// One incidence, or the mean of them all.
struct AlbedoRow {
    std::optional<Radians> incidence;
    proc::Albedo albedo;
};

/// Over the whole hemisphere of views, the mean last.
[[nodiscard]] std::vector<AlbedoRow> albedoRows(const Scatterer& surface,
                                                const std::vector<Radians>& incidences);

/// incidence_deg (null for the mean), and by band albedo, u_random, u_systematic, error_bound (null
/// where unknown) and missing.
[[nodiscard]] nlohmann::ordered_json albedoJson(const AlbedoRow& row);

}  // namespace gonio::daemon
