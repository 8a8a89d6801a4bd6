// Commands that begin a job of the daemon's and follow it to its end: calibrate, verify-white,
// measure.

#include <unistd.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "daemon/cli/commands.h"
#include "daemon/cli/daemon_client.h"
#include "daemon/cli/interrupt.h"
#include "daemon/cli/output.h"
#include "daemon/cli/progress.h"
#include "daemon/problem.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(double fraction) { return fixed(100 * fraction, 2) + " %"; }

/// One job at the daemon, from here to its end.
class FollowedJob {
public:
    FollowedJob(const CommonOptions& common, const DaemonClient& client, std::string title)
        : client_(client), yes_(common.yes), progress_(std::move(title), !common.quiet) {}

    /// The document that came of it.
    Result<Json> run(const Json& request);

private:
    Result<void> begin(const Json& request);
    Result<void> watch();
    bool take(const StreamEvent& event);
    bool cancelWhenInterrupted();
    Result<void> answerOperator();
    [[nodiscard]] std::string at() const { return "/api/v1/jobs/" + std::to_string(id_); }

    const DaemonClient& client_;
    bool yes_;
    Progress progress_;
    std::int64_t id_ = 0;
    std::uint64_t seen_ = 0;  ///< newest event
    std::string wanted_;      ///< of the operator
    bool ended_ = false;
    bool cancelled_ = false;
    std::optional<Error> error_;  ///< how it ended, when not well
};

Result<void> FollowedJob::begin(const Json& request) {
    const auto status = client_.get("/api/v1/status");
    if (!status) return status.error();
    seen_ = Json::parse(*status)["daemon"]["newest_event"];
    const auto begun = client_.post("/api/v1/jobs", request.dump());
    if (!begun) return begun.error();
    id_ = Json::parse(*begun)["id"];
    return {};
}

/// False: there is something else to do than to listen.
bool FollowedJob::take(const StreamEvent& event) {
    seen_ = event.id;
    const Json data = Json::parse(event.data);
    if (event.type == "rig" && data["state"] == "finishing") progress_.show("computing");
    if (data.value("job", std::int64_t{0}) != id_) return true;
    if (event.type == "progress") {
        progress_.show({.step = data["step"],
                        .steps = data["steps"],
                        .what = data["what"],
                        .left = Seconds(data["left_s"].get<double>())});
    } else if (event.type == "operator") {
        wanted_ = data["wanted"];
    } else if (event.type == "job") {
        ended_ = data["state"] != "running";
        if (data.contains("problem")) {
            error_ = Error{problemKind(data["problem"].get<std::string>()), data["message"]};
        }
    }
    return !ended_ && wanted_.empty();
}

/// Ctrl-C ends the job, not only this program; what the daemon says then is waited for.
bool FollowedJob::cancelWhenInterrupted() {
    if (interrupted() && !cancelled_) {
        cancelled_ = true;
        (void)client_.post(at() + "/cancel", "{}");
    }
    return true;
}

Result<void> FollowedJob::answerOperator() {
    progress_.clear();
    if (!yes_ && isatty(STDIN_FILENO) != 1) {
        (void)client_.post(at() + "/cancel", "{}");
        return Error{ErrorKind::Usage,
                     wanted_ + ": this needs a person at a terminal; or say --yes"};
    }
    if (!yes_) {
        std::cerr << wanted_ << ", then press Enter: " << std::flush;
        std::string line;
        const bool answered = static_cast<bool>(std::getline(std::cin, line));
        if (!answered && !interrupted()) {  // Ctrl-D is no yes
            (void)client_.post(at() + "/cancel", "{}");
            return Error{ErrorKind::Interrupted, wanted_ + ": no answer; the job is cancelled"};
        }
    }
    wanted_.clear();
    if (interrupted()) return {};
    const auto done = client_.post(at() + "/proceed", "{}");
    return done ? Result<void>() : done.error();
}

Result<void> FollowedJob::watch() {
    while (!ended_) {
        const auto followed = client_.follow(
            seen_,
            [this](const StreamEvent& event) { return take(event); },
            [this] { return cancelWhenInterrupted(); });
        if (!followed) return followed;
        if (wanted_.empty()) {
            if (!ended_) return Error{ErrorKind::NoRig, "the daemon ended; ask it: gonio jobs"};
        } else if (Result<void> answered = answerOperator(); !answered) {
            return answered;
        }
    }
    return {};
}

Result<Json> FollowedJob::run(const Json& request) {
    catchInterrupt();
    if (Result<void> begun = begin(request); !begun) return begun.error();
    const Result<void> watched = watch();
    progress_.clear();
    if (!watched) return watched.error();
    if (error_) return *error_;
    const auto job = client_.get(at());
    if (!job) return job.error();
    return Json::parse(*job)["result"];
}

void print(const CommonOptions& common, const Json& json, const std::string& line) {
    if (common.json) {
        printJson(json);
    } else if (!common.quiet) {
        std::cout << line << "\n";
    }
}

std::string text(const Json& json, const char* member) { return json[member].get<std::string>(); }

std::string seconds(const Json& json, const char* member) {
    return fixed(json[member].get<double>(), 1) + " s";
}

std::string calibratedLine(const Json& done, Reference reference) {
    if (reference == Reference::Mirror) {
        return "lens map of " + text(done, "rig") + ": " +
               std::to_string(done["spots"].get<int>()) + " mirror spots, " +
               fixed(done["rms_px"].get<double>(), 3) + " px rms, worst " +
               fixed(done["worst_px"].get<double>(), 3) + " px";
    }
    return std::string(reference == Reference::White ? "white" : "black") + " reference of " +
           text(done, "rig") + ": " + std::to_string(done["states"].get<int>()) + " states in " +
           seconds(done, "rig_seconds") + " on the rig";
}

std::string measuredLine(const Json& done) {
    return text(done, "name") + ": " + std::to_string(done["measured_cells"].get<int>()) +
           " BRDF samples, median uncertainty " +
           percent(done["median_relative_uncertainty"].get<double>()) + " (k = 1), " +
           seconds(done, "rig_seconds") + " on the rig, " + seconds(done, "compute_seconds") +
           " computing; " + text(done, "file");
}

}  // namespace

Result<void> calibrate(const CommonOptions& common, Reference reference) {
    const char* names[] = {"mirror", "black", "white"};
    const std::string name = names[static_cast<int>(reference)];
    const DaemonClient client(common.socketPath());
    const Result<Json> done =
        FollowedJob(common, client, name).run({{"kind", "calibrate-" + name}});
    if (!done) return done.error();
    print(common, *done, calibratedLine(*done, reference));
    return {};
}

Result<void> verifyWhite(const CommonOptions& common, const VerifyOptions& options) {
    const DaemonClient client(common.socketPath());
    const Result<Json> done = FollowedJob(common, client, "white")
                                  .run({{"kind", "verify-white"}, {"limit", options.limit}});
    if (!done) return done.error();
    print(common,
          *done,
          "white has changed by at most " + percent((*done)["worst_change"].get<double>()) +
              " since " + text(*done, "calibrated"));
    return {};
}

Result<void> measure(const CommonOptions& common, const MeasureOptions& options) {
    const DaemonClient client(common.socketPath());
    const Result<Json> done = FollowedJob(common, client, options.name)
                                  .run({{"kind", "measure"},
                                        {"name", options.name},
                                        {"effort", std::string(name(options.effort))},
                                        {"notes", options.notes}});
    if (!done) return done.error();
    if (!options.output.empty()) {
        const auto bytes = client.get("/api/v1/samples/" + options.name + "/file");
        if (!bytes) return bytes.error();
        if (Result<void> copied = proc::writeFile(options.output, *bytes); !copied) return copied;
    }
    print(common, *done, measuredLine(*done));
    return {};
}

}  // namespace gonio::daemon
