#include "daemon/cli/followed_job.h"

#include <unistd.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/cli/answer.h"
#include "daemon/cli/interrupt.h"
#include "daemon/problem.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

constexpr auto kPause = 500ms;  // before a stream that broke off is asked for again

}  // namespace

FollowedJob::FollowedJob(const CommonOptions& common, const DaemonClient& client, std::string title)
    : client_(client),
      yes_(common.yes),
      quiet_(common.quiet),
      progress_(std::move(title), !common.quiet) {}

Result<void> FollowedJob::begin(const std::string& request) {
    const auto status = client_.get("/api/v1/status");
    if (!status) return status.error();
    const Result<void> known = understood(
        *status, [&](const Json& json) { seen_ = json.at("daemon").at("newest_event"); });
    if (!known) return known;
    const auto begun = client_.post("/api/v1/jobs", request);
    if (!begun) return begun.error();
    return understood(*begun, [&](const Json& json) { id_ = json.at("id"); });
}

bool FollowedJob::take(const StreamEvent& event) {
    seen_ = event.id;
    const Result<void> read = understood(event.data, [&](const Json& data) { heed(event, data); });
    if (!read) broken_ = read.error();
    return !ended_ && !question_ && !broken_;
}

void FollowedJob::heed(const StreamEvent& event, const Json& data) {
    if (event.type == "rig") heedRig(data);
    if (data.value("job", std::int64_t{0}) != id_) return;
    if (event.type == "progress") {
        progress_.show({.step = data.at("step"),
                        .steps = data.at("steps"),
                        .what = data.at("what"),
                        .left = Seconds(data.at("left_s").get<double>())});
    } else if (event.type == "operator") {
        heed({data.at("question"), data.at("wanted")});
    } else if (event.type == "setback" && !quiet_) {
        progress_.clear();
        std::cerr << "setback in " << data.value("bracket", std::string("a bracket")) << ": "
                  << data.value("message", std::string()) << "\n";
    } else if (event.type == "job") {
        ended_ = data.at("state") != "running";
        if (data.contains("problem")) {
            error_ = Error{problemKind(data.at("problem").get<std::string>()), data.at("message")};
        }
    }
}

/// Of what a person has to do something about, also where no progress is shown.
void FollowedJob::heedRig(const Json& data) {
    const std::string state = data.at("state");
    if (state == "finishing") progress_.show("computing");
    if (state == "running" && waits_) std::cerr << "the job goes on\n";
    waits_ = state == "suspended" || state == "interrupted";
    if (!waits_) return;
    progress_.clear();
    std::cerr << "waiting for the rig: " << data.value("detail", std::string()) << "\n";
}

void FollowedJob::heed(Question question) {
    if (question.number > answered_) question_ = std::move(question);
}

/// How the job stands, where no event tells.
Result<void> FollowedJob::lookUp() {
    const auto status = client_.get("/api/v1/status");
    if (!status) return status.error();
    return understood(*status, [&](const Json& json) {
        const Json& job = json.at("job");
        ended_ = !job.is_object() || job.at("id") != id_;
        if (!ended_ && !job.at("question").is_null()) heed({job.at("question"), job.at("wanted")});
    });
}

/// Ends the job; what to say of that.
std::string FollowedJob::cancel() {
    const auto done = client_.post(at() + "/cancel", "{}");
    cancelled_ = done.has_value();
    return done ? "the job is cancelled" : name() + " goes on: " + done.error().message;
}

/// Ctrl-C ends the job, not only this program; what the daemon says then is waited for.
void FollowedJob::cancelWhenInterrupted() {
    if (interrupted() && !cancelled_) (void)cancel();
}

Result<void> FollowedJob::answerOperator(const Question& question) {
    progress_.clear();
    answered_ = question.number;
    if (yes_) return proceed(question);
    if (isatty(STDIN_FILENO) != 1) {
        return Error{
            ErrorKind::Usage,
            question.wanted + ": this needs a person at a terminal, or --yes; " + cancel()};
    }
    std::cerr << question.wanted << ", then press Enter: " << std::flush;
    std::string line;
    const bool answered = static_cast<bool>(std::getline(std::cin, line));
    if (interrupted()) return {};
    if (!answered) {  // Ctrl-D is no yes
        return Error{ErrorKind::Interrupted, question.wanted + ": no answer; " + cancel()};
    }
    return proceed(question);
}

/// An answer that came too late (another gave it, or the job has ended) is said, and no end.
Result<void> FollowedJob::proceed(const Question& question) {
    const Json answer{{"question", question.number}};
    const auto done = client_.post(at() + "/proceed", answer.dump());
    if (done) return {};
    if (done.error().kind == ErrorKind::NoRig) return done.error();
    std::cerr << "gonio: " << done.error().message << "\n";
    return {};
}

Result<void> FollowedJob::watch() {
    while (!ended_) {
        const auto followed = client_.follow(
            seen_,
            [this](const StreamEvent& event) { return take(event); },
            [this] {
                cancelWhenInterrupted();
                return true;
            });
        if (broken_) return *broken_;
        const bool brokeOff = !followed || !*followed;
        if (brokeOff) {
            cancelWhenInterrupted();
            if (Result<void> there = lookUp(); !there) return there;
        }
        if (const auto question = std::exchange(question_, std::nullopt)) {
            if (Result<void> done = answerOperator(*question); !done) return done;
        } else if (brokeOff && !ended_) {
            std::this_thread::sleep_for(kPause);
        }
    }
    return {};
}

Result<std::string> FollowedJob::result() {
    if (error_) return *error_;
    const auto job = client_.get(at());
    if (!job) return job.error();
    std::string document;
    const Result<void> read = understood(*job, [&](const Json& json) {
        if (!json.at("problem").is_null()) {
            error_ = Error{problemKind(json.at("problem").get<std::string>()), json.at("message")};
        }
        if (json.at("result").is_object()) document = json.at("result").dump();
    });
    if (!read) return read.error();
    if (error_) return *error_;
    if (!document.empty()) return document;
    return Error{ErrorKind::Internal,
                 name() + " has ended, but its result is not in the logbook; see goniod's log"};
}

Result<std::string> FollowedJob::run(const std::string& request) {
    catchInterrupt();
    if (Result<void> begun = begin(request); !begun) return begun.error();
    const Result<void> watched = watch();
    progress_.clear();
    if (watched) return result();
    Error error = watched.error();
    if (error.kind == ErrorKind::NoRig)
        error.message += "; what became of " + name() + ": gonio jobs";
    return error;
}

}  // namespace gonio::daemon
