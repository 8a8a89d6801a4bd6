// doctor: what stands between this computer and a measurement.

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

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

Json textOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json toJson(const Finding& finding) {
    return {{"rig", textOrNull(finding.rig)},
            {"subject", finding.subject},
            {"verdict", std::string(name(finding.verdict))},
            {"seen", finding.seen},
            {"cure", textOrNull(finding.cure)}};
}

Result<DaemonSeen> askDaemon(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/status");
    if (!answer) return answer.error();
    DaemonSeen seen;
    const Result<void> read = understood(*answer, [&](const Json& status) {
        const Json& rig = status.at("rig");
        seen = {.pid = status.at("daemon").at("pid"), .rigKind = rig.at("kind")};
        if (rig.at("serial").is_string()) seen.rigSerial = rig.at("serial");
        const auto celsius = [&](const char* where) -> std::optional<double> {
            const auto found = rig.find(where);
            if (found == rig.end() || !found->is_number()) return std::nullopt;
            return found->get<double>();
        };
        seen.ledBoardCelsius = celsius("led_board_celsius");
        seen.sensorCelsius = celsius("sensor_celsius");
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

/// What the daemon knows of the rig that it has.
std::vector<Finding> byDaemon(const DaemonSeen& daemon) {
    std::string seen;
    const auto add = [&](const char* where, const std::optional<double>& celsius) {
        if (!celsius) return;
        const std::string place = std::string(where) + " " + std::to_string(std::lround(*celsius));
        seen += (seen.empty() ? "" : ", ") + place + " degC";
    };
    add("LED board", daemon.ledBoardCelsius);
    add("sensor", daemon.sensorCelsius);
    if (seen.empty()) return {};
    return {{"temperature", Verdict::Ok, seen + ", says goniod", ""}};
}

std::vector<Finding> inside(const Patient& patient,
                            const driver::UsbRig& rig,
                            const DoctorOptions& options) {
    const std::string obstacle = options.handsOff ? "not asked for" : inTheWay(patient, rig);
    if (!obstacle.empty()) {
        std::vector<Finding> findings{
            {"claim",
             Verdict::Note,
             "not claimed, " + obstacle + ": no clock, dark frames, noise and counters of it",
             options.handsOff ? "" : "once it is free, ask again"}};
        if (usedByDaemon(patient, rig)) {
            for (Finding& one : byDaemon(*patient.daemon)) findings.push_back(std::move(one));
        }
        return findings;
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

std::vector<Finding> allOf(const Patient& patient, const DoctorOptions& options) {
    std::vector<Finding> findings = examineComputer(patient);
    if (!patient.rigs) return findings;
    for (const driver::UsbRig& rig : *patient.rigs) {
        std::vector<Finding> ofRig = examineOutside(patient, rig);
        for (Finding& finding : inside(patient, rig, options)) ofRig.push_back(std::move(finding));
        for (Finding& finding : ofRig) {
            finding.rig = nameOf(rig);
            findings.push_back(std::move(finding));
        }
    }
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
    const Patient patient{.store = common.store.empty() ? defaultStore() : common.store,
                          .rigs = driver::listUsb(),
                          .daemon = askDaemon(common)};
    const std::vector<Finding> findings = allOf(patient, options);
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
