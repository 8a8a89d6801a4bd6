#pragma once
// A file that holds a BRDF, made ready to answer: each kind of table by its own look-up.

#include <filesystem>
#include <memory>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/formats/brdf_file.h"

namespace gonio::proc {

/// A sample answers as SampleLookup does, a table as SpecularLookup or SphericalLookup, ... Usage
/// error for scattered values, which no look-up answers between, and for channels that are none of
/// the LEDs' bands.
[[nodiscard]] Result<std::unique_ptr<const Scatterer>> lookupOver(BrdfFile file);

/// Read and made ready.
[[nodiscard]] Result<std::unique_ptr<const Scatterer>> openBrdf(const std::filesystem::path& path);

}  // namespace gonio::proc
