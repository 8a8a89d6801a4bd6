#pragma once
// Models by name: "lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04". Lobes are joined by '+', the
// parameters of a lobe follow it after commas; a parameter per band takes one value or r/g/b.
//   lambert(albedo)   oren-nayar(albedo, sigma)
//   ggx(alpha | alpha_x, alpha_y | roughness, f0 [, masking=height-correlated|separable])
// roughness is the perceptual one: alpha = roughness^2. sigma is in radians.

#include <memory>
#include <string_view>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"

namespace gonio::proc {

/// Usage errors name the lobe and the parameter and say what is allowed.
[[nodiscard]] Result<std::unique_ptr<const Scatterer>> makeModel(std::string_view spec);

}  // namespace gonio::proc
