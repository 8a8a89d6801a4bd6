#pragma once
// Fits of analytic models to measured materials as their authors published them, one material per
// line in the layout of the BSDF benchmark's .fit files:
//   NAME = Aggregate(Lambertian(albedo = [r, g, b]), MODEL(albedo = [r, g, b], KEY = VALUE, ...))
// Each becomes a spec of our models:
//   NganWard          ward, norm=1992                         [Ngan2005]
//   NganCookTorrance  cook-torrance with f0 = `eta` (theirs is Schlick's), ks = albedo / pi: their
//   D
//                     is normalised, ours is the literal one
//   NganLafortune     lafortune, normalised alike
//   LowCookTorrance   low                                     [Low2012]

#include <filesystem>
#include <string>
#include <vector>

#include "proc/core/result.h"

namespace gonio::proc {

struct PublishedFit {
    std::string material;
    std::string spec;  ///< for makeModel
};

/// A File error names the file, the line and what was wanted.
[[nodiscard]] Result<std::vector<PublishedFit>> readPublishedFits(
    const std::filesystem::path& file);

}  // namespace gonio::proc
