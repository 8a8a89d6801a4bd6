#include "daemon/engine/interruption_text.h"

#include <nlohmann/json.hpp>

#include "proc/core/number_text.h"

namespace gonio::daemon {

nlohmann::ordered_json toJson(const driver::Interruption& interruption) {
    return {{"cause", interruption.cause},
            {"lasted_s", Seconds(interruption.lasted).count()},
            {"same_boot", interruption.sameBoot},
            {"resent", interruption.resent},
            {"redone", interruption.redone}};
}

std::string described(const std::vector<driver::Interruption>& interruptions) {
    std::string text;
    for (const driver::Interruption& one : interruptions) {
        text += (text.empty() ? "" : "; ") + fixed(Seconds(one.lasted).count(), 1) + " s, " +
                (one.sameBoot ? "same boot" : "another boot") + ", " + std::to_string(one.resent) +
                " frames sent again, " + std::to_string(one.redone) + " redone: " + one.cause;
    }
    return text;
}

}  // namespace gonio::daemon
