#pragma once
// ALTA text (.dat, .brdf; FORMATS.md names it as "ALTA-style"): lines #KEYWORD VALUE, then rows of
// numbers between blanks, first the coordinates that PARAM_IN names, then the values that PARAM_OUT
// names. Angles in radians. Read are the parametrisations that name a pair of directions and whose
// meaning is known from ALTA's source:
//
//   ISOTROPIC_TL_TV_PROJ_DPHI  theta_l, theta_v cos(dphi), theta_v sin(dphi); the light at phi 0
//   ISOTROPIC_TV_TL_DPHI       theta_v, theta_l, phi_l; the view at phi 0
//   SPHERICAL_TL_PL_TV_PV      theta_l, phi_l, theta_v, phi_v
//   RUSIN_TH_TD_PD, RUSIN_TH_PH_TD_PD  half/difference, the difference vector being the view's
//   CARTESIAN                  the view's vector, then the light's
//
// and INV_STERADIAN (f), INV_STERADIAN_COSINE_FACTOR (f cos(theta_v): divided by it; no value at
// the horizon), RGB_COLOR and XYZ_COLOR. Others, and files with intervals (#VS other than 0), are
// refused.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/brdf_rows.h"

namespace gonio::proc {

/// `name` stands in errors: "alta: NAME: line 12: 3 numbers, DIM promised 4". Keywords without one
/// of ours become "alta.KEYWORD".
[[nodiscard]] Result<FileRead<BrdfRows>> parseAlta(std::string_view text, std::string_view name);

/// f, with the light at phi 0 as ISOTROPIC_TL_TV_PROJ_DPHI, else as SPHERICAL_TL_PL_TV_PV; rounded
/// to 1e-12. A pair that lacks a channel is left out, which is counted, as are uncertainties and
/// flags.
[[nodiscard]] Result<Written> writeAlta(const BrdfRows& rows, const Metadata& about);

}  // namespace gonio::proc
