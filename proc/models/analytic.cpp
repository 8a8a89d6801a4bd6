#include "proc/models/analytic.h"

#include <string>

namespace gonio::proc {

Result<Precision> parsePrecision(std::string_view text) {
    if (text == "float") return Precision::Float;
    if (text == "double") return Precision::Double;
    return Error{ErrorKind::Usage,
                 "precision: '" + std::string(text) + "' is neither float nor double"};
}

}  // namespace gonio::proc
