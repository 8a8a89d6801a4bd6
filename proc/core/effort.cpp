#include "proc/core/effort.h"

#include <string>

namespace gonio {

std::string_view name(Effort effort) {
    switch (effort) {
        case Effort::Draft: return "draft";
        case Effort::Standard: return "standard";
        case Effort::Reference: return "reference";
    }
    return "standard";
}

Result<Effort> parseEffort(std::string_view text) {
    for (Effort effort : {Effort::Draft, Effort::Standard, Effort::Reference}) {
        if (text == name(effort)) return effort;
    }
    return Error{ErrorKind::Usage,
                 "effort: '" + std::string(text) + "' is none of draft, standard, reference"};
}

}  // namespace gonio
