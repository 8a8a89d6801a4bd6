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

std::optional<Verdict> parseVerdict(std::string_view name) {
    for (const Verdict one : {Verdict::Ok, Verdict::Note, Verdict::Warn, Verdict::Fail}) {
        if (name == daemon::name(one)) return one;
    }
    return std::nullopt;
}

}  // namespace gonio::daemon
