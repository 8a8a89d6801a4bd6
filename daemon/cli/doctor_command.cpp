// doctor: what stands between this computer and a measurement.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>

#include "daemon/api/documents.h"
#include "daemon/cli/answer.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/daemon_client.h"
#include "daemon/cli/output.h"
#include "daemon/doctor.h"
#include "daemon/doctor_rig.h"
#include "daemon/doctor_system.h"
#include "daemon/doctor_usb.h"
#include "daemon/store.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Result<DaemonSeen> askDaemon(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/status");
    if (!answer) return answer.error();
    DaemonSeen seen;
    const Result<void> read = understood(*answer, [&](const Json& status) {
        const Json& rig = status.at("rig");
        seen = {.pid = status.at("daemon").at("pid"), .rigKind = rig.at("kind")};
        if (rig.at("serial").is_string()) seen.rigSerial = rig.at("serial");
        if (rig.at("obstacle").is_string()) seen.obstacle = rig.at("obstacle");
    });
    if (!read) return read.error();
    return seen;
}

Result<RigProfile> profileOf(const driver::UsbRig& rig, const DoctorOptions& options) {
    if (!options.profile.empty()) return readProfile(options.profile);
    return readProfile(rig.superSpeed ? configDirectory() / "rigs/minidiff-usb3.toml"
                                      : defaultProfile());
}

std::uint64_t randomSession() {
    std::random_device random;
    const auto half = [&] { return std::uint64_t{random()}; };
    return half() << 32 | half() | 1;  // its low half is not 0
}

Finding findingIn(const Json& json) {
    const auto text = [&](const char* member) {
        return json.at(member).is_string() ? json.at(member).get<std::string>() : std::string();
    };
    const auto verdict = parseVerdict(text("verdict"));
    return {text("subject"), verdict.value_or(Verdict::Note), text("seen"), text("cure")};
}

/// What the daemon says of the rig that it has.
std::vector<Finding> byDaemon(const CommonOptions& common, const DoctorOptions& options) {
    const DaemonClient client(common.socketPath());
    const auto answer =
        options.handsOff ? client.get("/api/v1/doctor") : client.post("/api/v1/doctor", "{}");
    std::vector<Finding> findings;
    const Result<void> read = answer ? understood(*answer,
                                                  [&](const Json& json) {
                                                      for (const Json& one : json.at("findings"))
                                                          findings.push_back(findingIn(one));
                                                  })
                                     : Result<void>(answer.error());
    if (read) return findings;
    // Another version knows other questions, or gives other answers.
    const ErrorKind kind = read.error().kind;
    const bool other = kind == ErrorKind::Usage || kind == ErrorKind::Internal;
    return {{"claim",
             Verdict::Note,
             "not claimed, goniod has it, and says: " + read.error().message,
             other ? "restart a goniod of another version than this program"
                   : "once goniod answers, ask again"}};
}

std::vector<Finding> inside(const Patient& patient,
                            const driver::UsbRig& rig,
                            const DoctorOptions& options) {
    const std::string obstacle = options.handsOff ? "not asked for" : inTheWay(patient, rig);
    if (!obstacle.empty()) {
        return {{"claim",
                 Verdict::Note,
                 "not claimed, " + obstacle + ": no clock, dark frames, noise and counters of it",
                 options.handsOff ? "" : "once it is free, ask again"}};
    }
    const auto profile = profileOf(rig, options);
    if (!profile) return {{"noise", Verdict::Fail, profile.error().message, "another --profile"}};
    const auto transport =
        driver::openUsb({.vendor = rig.vendor, .product = rig.product, .serial = rig.serial});
    if (!transport) {
        return {{"claim", Verdict::Fail, transport.error().message, "end who uses it; see holder"}};
    }
    return examineInside(**transport, randomSession(), *profile);
}

/// The daemon's rig, which this program was not shown; `said`: the daemon's findings of it.
std::vector<Finding> examineUnshown(const Patient& patient, const std::vector<Finding>& said) {
    const DaemonSeen& daemon = *patient.daemon;
    const std::string goniod = "goniod (pid " + std::to_string(daemon.pid) + ")";
    if (daemon.rigKind == "usb") return {unshown(patient, said)};
    const bool sim = daemon.rigKind == "sim";
    const std::string where = sim ? "simulated in the daemon" : "a recording in the daemon";
    return {{"holder", Verdict::Ok, goniod + ", the daemon that was asked", ""},
            {"speed", Verdict::Note, where + ", without USB", ""},
            {"autosuspend", Verdict::Note, where + ", without USB", ""}};
}

void add(std::vector<Finding>& findings, std::vector<Finding> more, const std::string& rig) {
    for (Finding& finding : more) {
        finding.rig = rig;
        const bool said = std::any_of(findings.begin(), findings.end(), [&](const Finding& other) {
            return other.rig == rig && other.subject == finding.subject;
        });
        if (!said) findings.push_back(std::move(finding));
    }
}

std::vector<Finding> allOf(const Patient& patient,
                           const CommonOptions& common,
                           const DoctorOptions& options) {
    std::vector<Finding> findings = examineComputer(patient);
    bool daemonsSeen = !patient.daemon || patient.daemon->rigSerial.empty();
    for (const driver::UsbRig& rig : patient.rigs ? *patient.rigs : std::vector<driver::UsbRig>()) {
        const bool daemons = usedByDaemon(patient, rig);
        daemonsSeen = daemonsSeen || daemons;
        add(findings, examineOutside(patient, rig), nameOf(rig));
        add(findings,
            daemons ? byDaemon(common, options) : inside(patient, rig, options),
            nameOf(rig));
    }
    if (daemonsSeen) return findings;
    const std::string& serial = patient.daemon->rigSerial;
    std::vector<Finding> said = byDaemon(common, options);
    add(findings, examineUnshown(patient, said), serial);
    add(findings, std::move(said), serial);
    return findings;
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

void print(const std::vector<Finding>& findings) {
    std::vector<std::vector<std::string>> rows;
    std::string rig;
    for (const Finding& finding : findings) {
        if (finding.rig != rig) rows.push_back({"rig " + finding.rig});
        rig = finding.rig;
        rows.push_back({finding.subject, std::string(name(finding.verdict)), finding.seen});
        if (finding.cure.empty()) continue;
        std::string mark = "-> ";
        for (const std::string& line : linesOf(finding.cure)) {
            rows.push_back({"", "", mark + line});
            mark = "   ";
        }
    }
    printTable(rows);
}

}  // namespace

Result<void> doctor(const CommonOptions& common, const DoctorOptions& options) {
    if (!options.profile.empty()) {
        if (const auto known = readProfile(options.profile); !known) return known.error();
    }
    const Patient patient{.store = common.store.empty() ? defaultStore() : common.store,
                          .rigs = driver::listUsb(),
                          .daemon = askDaemon(common)};
    const std::vector<Finding> findings = allOf(patient, common, options);
    if (common.json) {
        Json list = Json::array();
        for (const Finding& finding : findings) list.push_back(toJson(finding));
        printJson({{"schema", "gonio/doctor/1"}, {"findings", list}});
    } else {
        print(findings);
    }
    std::string failed;
    for (const Finding& finding : findings) {
        if (finding.verdict != Verdict::Fail) continue;
        failed += (failed.empty() ? "" : ", ") + finding.subject;
        if (!finding.rig.empty()) failed += " of " + finding.rig;
    }
    if (failed.empty()) return {};
    return Error{ErrorKind::Internal, "doctor: fail: " + failed};
}

}  // namespace gonio::daemon
