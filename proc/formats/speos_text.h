#pragma once
// The text forms of Speos surfaces; proc/formats/speos.h says what they are.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/table/spherical_table.h"

namespace gonio::proc {

enum class SpeosKind {
    Brdf,
    Anisotropic
};

[[nodiscard]] Result<FileRead<SphericalTable>> parseSpeosText(std::string_view text,
                                                              std::string_view name,
                                                              SpeosKind kind);

}  // namespace gonio::proc
