// doctor: what stands between this computer and a measurement.

#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/daemon_client.h"
#include "daemon/cli/output.h"
#include "daemon/doctor.h"
#include "daemon/store.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Finding& finding) {
    return {{"subject", finding.subject},
            {"verdict", std::string(name(finding.verdict))},
            {"seen", finding.seen},
            {"cure", finding.cure.empty() ? Json(nullptr) : Json(finding.cure)}};
}

}  // namespace

Result<void> doctor(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/status");
    const Patient patient{.store = common.store.empty() ? defaultStore() : common.store,
                          .rigs = driver::listUsb(),
                          .daemon = answer ? Result<void>() : answer.error()};
    Json list = Json::array();
    std::vector<std::vector<std::string>> rows;
    std::string bad;
    for (const Finding& finding : examine(patient)) {
        list.push_back(toJson(finding));
        rows.push_back({finding.subject, std::string(name(finding.verdict)), finding.seen});
        if (!finding.cure.empty()) rows.push_back({"", "", "-> " + finding.cure});
        if (finding.verdict == Verdict::Bad) bad += (bad.empty() ? "" : ", ") + finding.subject;
    }
    if (common.json) {
        printJson({{"schema", "gonio/doctor/1"}, {"findings", list}});
    } else {
        printTable(rows);
    }
    if (bad.empty()) return {};
    return Error{ErrorKind::Internal, "doctor: bad: " + bad};
}

}  // namespace gonio::daemon
