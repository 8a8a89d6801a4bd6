#pragma once
// Models fitted to carry an interpolation.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proc/estimate/incidence_method.h"

namespace gonio::proc {

using Carriers = std::map<std::string, Carrier>;

/// The families that are tried, by name: one for each kind of lobe and floor that surfaces show.
[[nodiscard]] const std::vector<std::string>& carrierFamilies();

struct CarrierFitOptions {
    std::size_t rows = 1500;  ///< of the data, thinned
    int maxIterations = 40;
    double tolerance = 1e-8;              ///< relative change of the cost that ends the search
    const Carriers* startedAt = nullptr;  ///< fits to more data, from which to start
    std::vector<std::string> families{};  ///< by name; empty: carrierFamilies()
};

/// To the incidences that are wanted; what could not be fitted is not in it. On all cores.
[[nodiscard]] Carriers fitCarriers(const BrdfData& data,
                                   const std::vector<bool>& groups,
                                   const CarrierFitOptions& options = {});
/// The name of the one of least chi-square; empty where there is none.
[[nodiscard]] std::optional<std::string> bestByChiSquare(const BrdfData& data,
                                                         const Carriers& carriers);

}  // namespace gonio::proc
