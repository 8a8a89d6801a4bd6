// Commands that ask the daemon, or tell it: status, rigs, session, jobs, samples, watch, sim place.

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

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

/// What the daemon answers, printed as it is or by `show`.
template <class Show>
Result<void> shown(const CommonOptions& common, const Result<std::string>& answer, Show show) {
    if (!answer) return answer.error();
    const Json json = Json::parse(*answer);
    if (common.json) {
        printJson(json);
    } else if (!common.quiet) {
        show(json);
    }
    return {};
}

std::string jobLine(const Json& job) {
    if (!job.is_object()) return "none";
    std::string line = std::to_string(job["id"].get<int>()) + ": " + textOr(job["kind"], "") + " " +
                       textOr(job["name"], "");
    if (job["wanted"].is_string()) return line + " waits: " + job["wanted"].get<std::string>();
    line += ", step " + std::to_string(job["step"].get<int>()) + " of " +
            std::to_string(job["steps"].get<int>());
    if (job["left_s"].is_number())
        line += ", " + fixed(job["left_s"].get<double>(), 0) + " s to go";
    return line;
}

void printStatus(const Json& status) {
    const Json& rig = status["rig"];
    std::string rigLine = textOr(rig["serial"], "none yet") + " (" + textOr(rig["kind"], "") +
                          "), " + textOr(rig["state"], "");
    if (rig["placed"].is_string()) rigLine += "; under it: " + rig["placed"].get<std::string>();
    if (rig["obstacle"].is_string()) rigLine += "; " + rig["obstacle"].get<std::string>();
    const Json& session = status["session"];
    std::vector<std::vector<std::string>> rows{
        {"rig", rigLine},
        {"job", jobLine(status["job"])},
        {"session",
         session.is_object()
             ? textOr(session["name"], "") + ", since " + textOr(session["opened"], "")
             : "none"}};
    for (const auto& [kind, date] : status["calibrations"].items()) {
        rows.push_back({kind, textOr(date, "not calibrated; run: gonio calibrate " + kind)});
    }
    const Json& daemon = status["daemon"];
    rows.push_back({"store", textOr(daemon["store"], "")});
    rows.push_back({"daemon",
                    "gonio " + textOr(daemon["version"], "") + ", process " +
                        std::to_string(daemon["pid"].get<int>()) + ", profile " +
                        textOr(daemon["profile"], "")});
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
            row.push_back(one[member].is_number() ? one[member].dump() : textOr(one[member], "-"));
        }
    }
    printTable(rows);
}

std::string eventLine(const StreamEvent& event) {
    const Json data = Json::parse(event.data);
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
                      what.starts_with("model:") || what.starts_with("sample:");
    return word ? what : fs::absolute(what).lexically_normal().string();
}

}  // namespace

Result<void> status(const CommonOptions& common) {
    return shown(common, DaemonClient(common.socketPath()).get("/api/v1/status"), printStatus);
}

Result<void> rigs(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/rigs");
    return shown(common, answer, [](const Json& json) {
        printList(json["rigs"],
                  {"serial", "kind", "place", "protocol", "obstacle"},
                  "no rig is there; is it plugged in?");
    });
}

Result<void> samples(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/samples");
    return shown(common, answer, [](const Json& json) {
        printList(json["samples"], {"name", "date", "rig", "session"}, "no samples yet");
    });
}

Result<void> jobs(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/jobs");
    return shown(common, answer, [](const Json& json) {
        printList(
            json["jobs"], {"id", "kind", "name", "state", "started", "message"}, "no jobs yet");
    });
}

/// Asks something of the job that runs.
Result<void> tellJob(const CommonOptions& common,
                     const std::string& wish,
                     const std::string& said) {
    const DaemonClient client(common.socketPath());
    const auto now = client.get("/api/v1/status");
    if (!now) return now.error();
    const Json job = Json::parse(*now)["job"];
    if (!job.is_object()) return Error{ErrorKind::Usage, "jobs " + wish + ": no job is running"};
    const std::string id = std::to_string(job["id"].get<std::int64_t>());
    return shown(common, client.post("/api/v1/jobs/" + id + "/" + wish, "{}"), [&](const Json&) {
        std::cout << "job " << id << " " << said << "\n";
    });
}

Result<void> cancelJob(const CommonOptions& common) {
    return tellJob(common, "cancel", "ends at its next step");
}

Result<void> proceedJob(const CommonOptions& common) {
    return tellJob(common, "proceed", "goes on");
}

Result<void> newSession(const CommonOptions& common, const SessionOptions& options) {
    const Json request{
        {"name", options.name}, {"operator", options.operatorName}, {"notes", options.notes}};
    const auto answer = DaemonClient(common.socketPath()).post("/api/v1/sessions", request.dump());
    return shown(common, answer, [](const Json& json) {
        std::cout << "session " << textOr(json["name"], "") << " is open\n";
    });
}

Result<void> closeSession(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).post("/api/v1/sessions/close", "{}");
    return shown(common, answer, [](const Json& json) {
        std::cout << "session " << textOr(json["name"], "") << " is closed\n";
    });
}

Result<void> listSessions(const CommonOptions& common) {
    const auto answer = DaemonClient(common.socketPath()).get("/api/v1/sessions");
    return shown(common, answer, [](const Json& json) {
        printList(
            json["sessions"], {"id", "name", "operator", "opened", "closed"}, "no sessions yet");
    });
}

Result<void> watch(const CommonOptions& common, const WatchOptions& options) {
    catchInterrupt();
    const DaemonClient client(common.socketPath());
    std::uint64_t after = options.after.value_or(0);
    if (!options.after) {
        const auto now = client.get("/api/v1/status");
        if (!now) return now.error();
        after = Json::parse(*now)["daemon"]["newest_event"];
    }
    const auto on = [&](const StreamEvent& event) {
        if (common.json) {
            std::cout << Json{{"id", event.id},
                              {"type", event.type},
                              {"data", Json::parse(event.data)}}
                             .dump(-1, ' ', false, Json::error_handler_t::replace)
                      << std::endl;
        } else {
            std::cout << eventLine(event) << std::endl;
        }
        return static_cast<bool>(std::cout);
    };
    return client.follow(after, on, [] { return !interrupted(); });
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
                 {"ambient", place.ambient}};
    if (place.rigErrors) request["rig_errors"] = *place.rigErrors;
    if (place.seed) request["seed"] = *place.seed;
    if (place.serial) request["serial"] = *place.serial;
    if (place.systematic) request["systematic"] = *place.systematic;
    const auto answer = DaemonClient(common.socketPath()).post("/api/v1/sim/place", request.dump());
    return shown(common, answer, [&](const Json& json) {
        std::cout << "under the simulated rig " << textOr(json["serial"], "") << ": " << said
                  << "\n";
    });
}

}  // namespace gonio::daemon
