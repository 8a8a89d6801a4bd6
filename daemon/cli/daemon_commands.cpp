// Commands that ask the daemon, or tell it: status, rigs, session, jobs, samples, calibrations,
// watch, sim place.

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "daemon/cli/answer.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/daemon_client.h"
#include "daemon/cli/interrupt.h"
#include "daemon/cli/output.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

std::string textOr(const Json& json, const std::string& otherwise) {
    return json.is_string() ? json.get<std::string>() : otherwise;
}

std::string jobLine(const Json& job) {
    if (!job.is_object()) return "none";
    std::string line = std::to_string(job.at("id").get<int>()) + ": " + textOr(job.at("kind"), "") +
                       " " + textOr(job.at("name"), "");
    if (job.at("wanted").is_string())
        return line + " waits: " + job.at("wanted").get<std::string>();
    line += ", step " + std::to_string(job.at("step").get<int>()) + " of " +
            std::to_string(job.at("steps").get<int>());
    if (job.at("left_s").is_number())
        line += ", " + fixed(job.at("left_s").get<double>(), 0) + " s to go";
    return line;
}

void printStatus(const Json& status) {
    const Json& rig = status.at("rig");
    std::string rigLine = textOr(rig.at("serial"), "none yet") + " (" + textOr(rig.at("kind"), "") +
                          "), " + textOr(rig.at("state"), "");
    if (rig.at("placed").is_string())
        rigLine += "; under it: " + rig.at("placed").get<std::string>();
    if (rig.at("obstacle").is_string()) rigLine += "; " + rig.at("obstacle").get<std::string>();
    if (rig.value("interlock_closed", true) == false) rigLine += "; its interlock is open";
    const Json& session = status.at("session");
    std::vector<std::vector<std::string>> rows{
        {"rig", rigLine},
        {"job", jobLine(status.at("job"))},
        {"session",
         session.is_object()
             ? textOr(session.at("name"), "") + ", since " + textOr(session.at("opened"), "")
             : "none"}};
    for (const auto& [kind, date] : status.at("calibrations").items()) {
        const bool optional = kind != "mirror" && kind != "black" && kind != "white";
        rows.push_back({kind,
                        textOr(date,
                               optional ? "none, which is no obstacle"
                                        : "not calibrated; run: gonio calibrate " + kind)});
    }
    const Json& daemon = status.at("daemon");
    rows.push_back({"store", textOr(daemon.at("store"), "")});
    rows.push_back({"daemon",
                    "gonio " + textOr(daemon.at("version"), "") + ", process " +
                        std::to_string(daemon.at("pid").get<int>()) + ", profile " +
                        textOr(daemon.at("profile"), "")});
    printTable(rows);
}

void printList(const Json& list,
               const std::vector<std::string>& members,
               const std::string& whenEmpty) {
    if (list.empty()) {
        std::cout << whenEmpty << "\n";
        return;
    }
    std::vector<std::vector<std::string>> rows{members};
    for (const Json& one : list) {
        auto& row = rows.emplace_back();
        for (const std::string& member : members) {
            row.push_back(one.at(member).is_number() ? one.at(member).dump()
                                                     : textOr(one.at(member), "-"));
        }
    }
    printTable(rows);
}

std::string eventLine(const StreamEvent& event, const Json& data) {
    std::string line = event.type;
    for (const auto& [name, value] : data.items()) {
        if (value.is_string() && value.get<std::string>().empty()) continue;
        std::string shownValue = value.is_string() ? value.get<std::string>() : value.dump();
        if (value.is_number_float()) shownValue = fixed(value.get<double>(), 1);
        line += "  " + name + "=" + shownValue;
    }
    return line;
}

/// What names the same thing in the daemon's folder.
std::string absolutePlace(const std::string& what) {
    const bool word = what == "nothing" || what == "mirror" || what == "white" || what == "black" ||
                      what == "zero" || what.starts_with("model:") || what.starts_with("sample:");
    return word ? what : fs::absolute(what).lexically_normal().string();
}

/// The job that runs, and what it waits for.
struct RunningJob {
    std::string id;
    std::optional<std::uint64_t> question;
};

Result<RunningJob> runningJob(const DaemonClient& client, const std::string& command) {
    const auto now = client.get("/api/v1/status");
    if (!now) return now.error();
    std::optional<RunningJob> running;
    const Result<void> read = understood(*now, [&](const Json& status) {
        const Json& job = status.at("job");
        if (!job.is_object()) return;
        running.emplace().id = std::to_string(job.at("id").get<std::int64_t>());
        if (!job.at("question").is_null()) running->question = job.at("question");
    });
    if (!read) return read.error();
    if (!running) return Error{ErrorKind::Usage, "jobs " + command + ": no job is running"};
    return *running;
}

}  // namespace

Result<void> status(const CommonOptions& common) {
    return shown(common, DaemonClient(common.socketPath()).get("/api/v1/status"), printStatus);
}

Result<void> rigs(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/rigs");
    return shown(common, answer, [](const Json& json) {
        printList(json.at("rigs"),
                  {"serial", "kind", "place", "protocol", "obstacle"},
                  "no rig is there; is it plugged in?");
    });
}

Result<void> samples(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/samples");
    return shown(common, answer, [](const Json& json) {
        printList(json.at("samples"), {"name", "date", "rig", "session"}, "no samples yet");
    });
}

Result<void> calibrations(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/calibrations");
    return shown(common, answer, [](const Json& json) {
        printList(json.at("calibrations"),
                  {"id", "kind", "rig", "date", "led_board_celsius", "why_not"},
                  "no calibrations yet; run: gonio calibrate mirror, black, white");
    });
}

Result<void> jobs(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/jobs");
    return shown(common, answer, [](const Json& json) {
        printList(
            json.at("jobs"), {"id", "kind", "name", "state", "started", "message"}, "no jobs yet");
    });
}

Result<void> cancelJob(const CommonOptions& common) {
    const DaemonClient client(common.socketPath());
    const auto job = runningJob(client, "cancel");
    if (!job) return job.error();
    return shown(
        common, client.post("/api/v1/jobs/" + job->id + "/cancel", "{}"), [&](const Json&) {
            std::cout << "job " << job->id << " ends at its next step\n";
        });
}

Result<void> proceedJob(const CommonOptions& common) {
    const DaemonClient client(common.socketPath());
    const auto job = runningJob(client, "proceed");
    if (!job) return job.error();
    if (!job->question) {
        return Error{ErrorKind::Usage, "jobs proceed: job " + job->id + " waits for nobody"};
    }
    const Json answer{{"question", *job->question}};
    const auto done = client.post("/api/v1/jobs/" + job->id + "/proceed", answer.dump());
    return shown(
        common, done, [&](const Json&) { std::cout << "job " << job->id << " goes on\n"; });
}

Result<void> newSession(const CommonOptions& common, const SessionOptions& options) {
    const Json request{
        {"name", options.name}, {"operator", options.operatorName}, {"notes", options.notes}};
    const auto answer = DaemonClient(common.socketPath()).post("/api/v1/sessions", request.dump());
    return shown(common, answer, [](const Json& json) {
        std::cout << "session " << textOr(json.at("name"), "") << " is open\n";
    });
}

Result<void> closeSession(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).post("/api/v1/sessions/close", "{}");
    return shown(common, answer, [](const Json& json) {
        std::cout << "session " << textOr(json.at("name"), "") << " is closed\n";
    });
}

Result<void> listSessions(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/sessions");
    return shown(common, answer, [](const Json& json) {
        printList(
            json.at("sessions"), {"id", "name", "operator", "opened", "closed"}, "no sessions yet");
    });
}

Result<void> watch(const CommonOptions& common, const WatchOptions& options) {
    catchInterrupt();
    const DaemonClient client(common.socketPath());
    std::uint64_t after = options.after.value_or(0);
    if (!options.after) {
        const auto now = client.get("/api/v1/status");
        if (!now) return now.error();
        const Result<void> read = understood(
            *now, [&](const Json& json) { after = json.at("daemon").at("newest_event"); });
        if (!read) return read;
    }
    Result<void> read;
    const auto on = [&](const StreamEvent& event) {
        read = understood(event.data, [&](const Json& data) {
            const Json whole{{"id", event.id}, {"type", event.type}, {"data", data}};
            std::cout << (common.json ? whole.dump(-1, ' ', false, Json::error_handler_t::replace)
                                      : eventLine(event, data))
                      << std::endl;
        });
        return read && std::cout;
    };
    const auto followed = client.follow(after, on, [] { return !interrupted(); });
    if (!read) return read;
    if (!followed) return followed.error();
    if (*followed) return {};
    return Error{ErrorKind::NoRig, "the daemon has ended"};
}

Result<void> simPlace(const CommonOptions& common, PlaceRequest place) {
    const std::string said = place.what;
    place.what = absolutePlace(place.what);
    if (Result<void> good = check(place); !good) return good;
    Json request{{"what", place.what},
                 {"tilt_x_deg", place.tiltXDegrees},
                 {"tilt_y_deg", place.tiltYDegrees},
                 {"waviness_deg", place.wavinessDegrees},
                 {"translucency", place.translucency},
                 {"backing", place.backing},
                 {"softness", place.softness},
                 {"ambient", place.ambient},
                 {"turned_deg", place.turnedDegrees}};
    if (place.rigErrors) request["rig_errors"] = *place.rigErrors;
    if (place.seed) request["seed"] = *place.seed;
    if (place.serial) request["serial"] = *place.serial;
    if (place.systematic) request["systematic"] = *place.systematic;
    const auto answer = DaemonClient(common.socketPath()).post("/api/v1/sim/place", request.dump());
    return shown(common, answer, [&](const Json& json) {
        std::cout << "under the simulated rig " << textOr(json.at("serial"), "") << ": " << said
                  << "\n";
    });
}

}  // namespace gonio::daemon
