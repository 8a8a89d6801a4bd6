#include "proc/core/result.h"

namespace gonio {

int exitCode(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Internal: return 1;
        case ErrorKind::Usage: return 2;
        case ErrorKind::NoRig: return 3;
        case ErrorKind::Busy: return 4;
        case ErrorKind::Device: return 5;
        case ErrorKind::File: return 6;
        case ErrorKind::Quality: return 7;
        case ErrorKind::Interrupted: return 8;
    }
    return 1;
}

}  // namespace gonio
