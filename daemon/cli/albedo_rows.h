#pragma once
// Directional-hemispherical albedo at a list of incidences and the mean, as `albedo` and `info`
// say it.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/effort.h"
#include "proc/core/scatterer.h"
#include "proc/core/units.h"
#include "proc/estimate/albedo.h"

namespace gonio::daemon {

/// One incidence at one rotation of the sample, or the mean of them all.
struct AlbedoRow {
    std::optional<Radians> incidence;
    Radians rotation;  ///< 0 of the mean
    proc::Albedo albedo;
};

/// Where light comes from: rotation r puts it at azimuth -r.
struct AlbedoLights {
    std::vector<Radians> incidences, rotations;
};

/// Over the whole hemisphere of views, rotation by rotation, the mean over all incidences and these
/// rotations last, on all cores. To 1e-3 (a mean: 1e-2) with
/// draft effort, 1e-4 (1e-3) with standard, 1e-5 (1e-4) with reference, as far as 5400, 20000 and
/// 40000 answers an incidence, and 15, 45 and 255 incidences of a mean, allow.
[[nodiscard]] std::vector<AlbedoRow> albedoRows(const Scatterer& surface,
                                                const AlbedoLights& lights,
                                                Effort effort);

/// incidence_deg and rotation_deg (null for the mean), by band albedo, u_random, u_systematic,
/// error_bound (null where unknown) and missing; evaluations and converged.
[[nodiscard]] nlohmann::ordered_json albedoJson(const AlbedoRow& row);

/// The same for people: a head, and a line for each row and band.
[[nodiscard]] std::vector<std::vector<std::string>> albedoTable(const std::vector<AlbedoRow>& rows);

}  // namespace gonio::daemon
