#include "daemon/finding.h"

namespace gonio::daemon {

std::string_view name(Verdict verdict) {
    switch (verdict) {
        case Verdict::Ok: return "ok";
        case Verdict::Note: return "note";
        case Verdict::Warn: return "warn";
        case Verdict::Fail: return "fail";
    }
    return "";
}

}  // namespace gonio::daemon
