#pragma once
// One door for every file that holds a BRDF: recognised, read and made ready to answer.

#include <filesystem>
#include <memory>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"

namespace gonio::proc {

/// `.gonio` answers as SampleLookup does, Zemax `.bsdf` as SpecularLookup. File error for anything
/// else, with the name of what it is where that is known.
[[nodiscard]] Result<std::unique_ptr<const Scatterer>> openBrdf(const std::filesystem::path& path);

}  // namespace gonio::proc
