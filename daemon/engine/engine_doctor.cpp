// What the doctor is told of the rig that the engine has.

#include "daemon/calibrations.h"
#include "daemon/doctor_rig.h"
#include "daemon/doctor_usb.h"
#include "daemon/engine/engine.h"

namespace gonio::daemon {
namespace {

bool has(EngineState state) {
    return state != EngineState::Offline && state != EngineState::Connecting &&
           state != EngineState::Interrupted;
}

Finding claimFinding(const EngineStatus& now) {
    const std::string seen = "goniod's, and " + std::string(name(now.state));
    const std::string because = now.obstacle.empty() ? "" : ": " + now.obstacle;
    const std::string meanwhile = now.job ? "; the job goes on by itself then" : "";
    if (has(now.state)) {
        if (now.obstacle.empty()) return {"claim", Verdict::Ok, seen, ""};
        return {"claim",
                Verdict::Warn,
                seen + because,
                "see interlock and temperature; where they are ok, plug it in again"};
    }
    return {"claim",
            Verdict::Fail,
            seen + because,
            "plug it in, or end who has it: goniod takes it by itself" + meanwhile};
}

/// What `claim` and the protocol's version add to the rest.
std::vector<Finding> whole(const EngineStatus& now, std::vector<Finding> rest) {
    const driver::Ident& ident = now.info->ident;
    rest.insert(rest.begin(),
                {claimFinding(now),
                 protocolFinding("GRP/" + std::to_string(ident.major) + "." +
                                 std::to_string(ident.minor))});
    return rest;
}

}  // namespace

std::vector<Finding> Engine::examineFromAfar(const std::string& why) const {
    const EngineStatus now = status();
    if (!has(now.state) || !now.info) return {claimFinding(now)};
    return whole(now, examineUnasked(*now.info, now.rig, why));
}

std::vector<Finding> Engine::examineNow() {
    if (!rig_) return {claimFinding(status())};
    world_.alive();
    std::vector<Finding> findings =
        examineClaimed(*rig_, measuredProfile(store_, profile_, rigNow()));
    world_.alive();
    if (const std::optional<Error> gone = rig_->link().lost()) lost(*gone);
    return whole(status(), std::move(findings));
}

}  // namespace gonio::daemon
