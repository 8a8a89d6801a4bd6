#pragma once
// BSDF XML of WINDOW and Radiance on Klems bases (.xml), read only: matrices of reflection and
// transmission, front and back, visible and solar, in 1/sr. The incident patches are the columns,
// or the rows, as IncidentDataStructure says; bases may be of the file's own or the three known
// ones. Tensor trees are refused by name. Not checked by a schema: what is not needed is not looked
// at.
//
// Negative values are kept and counted in a warning, as are matrices that scatter more than falls
// on them. ScatteringDataType is not believed: real files say BTDF of reflection, too.

#include <string_view>

#include "proc/core/result.h"
#include "proc/formats/file_read.h"
#include "proc/table/klems_table.h"

namespace gonio::proc {

/// Errors: "klems: NAME: line 12: 144 values, wanted 145 x 145".
[[nodiscard]] Result<FileRead<KlemsTable>> parseKlems(std::string_view text, std::string_view name);

}  // namespace gonio::proc
