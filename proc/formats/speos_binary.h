#pragma once
// The binary form of `.anisotropicbsdf` v9.0, as far as one file shows it: after the first line
// '1', then little-endian numbers and arrays of doubles that are packed as LZ4 blocks. Fields that
// have only been seen with one value must have it; anything else is refused, not guessed.
//
//   u32 3, u32 length and text, 3 doubles anisotropy vector, 8 bytes of 0, reflection 1,
//   transmission 0, doubles 1 and 1, u8 0 (values are f cos theta), u8 0, u32 number of anisotropy
//   angles (1), array of them; u32 number of incidences, array of them; doubles theta and phi of
//   the spectrum's measurement, u32 0, u32 number of wavelengths, all of them, all per cents; then
//   per incidence u32 thetas, u32 phis, the arrays theta, phi, values (theta > phi). An array: u64
//   bytes, u32 bytes, u32 packed bytes, LZ4 block.
// Four doubles per incidence (the cone that parts specular from diffuse in Speos), a byte and a
// double follow: they are not read.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

/// Arrays may unpack to this many times the file, all together.
inline constexpr std::size_t kSpeosMostUnpacked = 16;

/// `start` is where the first line ends. Errors: "speos: NAME: byte 138: ...".
[[nodiscard]] Result<FileRead<SphericalTable>> parseSpeosBinary(std::string_view bytes,
                                                                std::string_view name,
                                                                std::size_t start);

}  // namespace gonio::proc
