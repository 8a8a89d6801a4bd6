#pragma once
// Speos surfaces: `.brdf` (isotropic, one table per incidence and wavelength) and
// `.anisotropicbsdf` (one table per anisotropy angle and incidence, and a spectrum), as text of
// versions 7 to 9, FORMATS.md 8; and the binary form of `.anisotropicbsdf` v9.0. Angles are counted
// from the normal, transmission from 90 to 180.
//
// The azimuth of the mirror direction is 0 in the documents and in what Ansys's converters write,
// and 180 in the only binary file that we have. Where peaks tell, they decide; else it is 0 in text
// and 180 in binary. Our own files say it in their comment. Values are f, or f cos(theta), which is
// divided out; total reflectance and transmittance are per cent. Speos scales each table to them:
// here the numbers are read as they stand, and a warning tells where the two differ.
//
// Anisotropy angle a is read as the sample turned by a under a fixed light, as Zemax's
// SampleRotation, which Ansys's converters copy: the light stands at azimuth -a.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/formats/loss_report.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Metadata key: the spectrum of an `.anisotropicbsdf`, "350 62.27, 1600 62.27" (nm, per cent).
inline constexpr std::string_view kSpeosSpectrum = "spectrum_percent";

/// Either kind, by its first line. Simple scattering files and other binaries are refused by name.
/// Errors: "speos: NAME: line 12: ...", "speos: NAME: byte 138: ...".
[[nodiscard]] Result<FileRead<SphericalTable>> parseSpeos(std::string_view bytes,
                                                          std::string_view name);

/// Text, values of f, azimuth 0 at the mirror direction, wavelengths ascending. What has no data is
/// written as 0, metadata go into the description. Usage error for X, Y, Z, which have no
/// wavelength, and for fewer than the two incidences that Speos wants. Only the first light azimuth
/// is written.
[[nodiscard]] Result<Written> writeSpeosBrdf(const SphericalTable& table, const Metadata& about);

/// All light azimuths; the tables are those of the first channel, of the others only the spectrum
/// (their totals at the first incidence) is kept.
[[nodiscard]] Result<Written> writeSpeosAnisotropic(const SphericalTable& table,
                                                    const Metadata& about);

}  // namespace gonio::proc
