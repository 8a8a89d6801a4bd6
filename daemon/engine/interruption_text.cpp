#include "daemon/engine/interruption_text.h"

#include <nlohmann/json.hpp>

#include "proc/core/number_text.h"

namespace gonio::daemon {

using Json = nlohmann::ordered_json;

Json toJson(const driver::Interruption& interruption) {
    Json json{{"cause", interruption.cause},
              {"lasted_s", Seconds(interruption.lasted).count()},
              {"same_boot", interruption.sameBoot},
              {"resent", interruption.resent},
              {"redone", interruption.redone}};
    if (interruption.cutOffDone) json["cut_off_done"] = *interruption.cutOffDone;
    if (const auto& stats = interruption.stats) {
        json["rig_counters"] = Json{{"uptime_s", stats->uptimeS},
                                    {"commands_done", stats->commandsDone},
                                    {"replays", stats->replays},
                                    {"frames_made", stats->framesMade},
                                    {"frames_gone", stats->framesGone},
                                    {"resends", stats->resends},
                                    {"fifo_overruns", stats->fifoOverruns},
                                    {"crc_rejects", stats->crcRejects},
                                    {"lapses", stats->lapses}};
    }
    return json;
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
