#pragma once
// One job at the daemon, followed from here to its end: progress is drawn, questions are put to the
// person at the terminal, Ctrl-C cancels the job. It ends when the job does, however often the
// stream of events breaks off meanwhile; only when the daemon no longer answers is it left.

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "daemon/cli/commands.h"
#include "daemon/cli/daemon_client.h"
#include "daemon/cli/progress.h"

namespace gonio::daemon {

class FollowedJob {
public:
    /// `client` is borrowed.
    FollowedJob(const CommonOptions& common, const DaemonClient& client, std::string title);

    /// Begins what the request (JSON) asks for; the document that came of it, JSON.
    Result<std::string> run(const std::string& request);

private:
    struct Question {
        std::uint64_t number = 0;
        std::string wanted;
    };
    Result<void> begin(const std::string& request);
    Result<void> watch();
    /// False: there is something else to do than to listen.
    bool take(const StreamEvent& event);
    void heed(const StreamEvent& event, const nlohmann::ordered_json& data);
    void heed(Question question);
    void heedRig(const nlohmann::ordered_json& data);
    Result<void> lookUp();
    void cancelWhenInterrupted();
    [[nodiscard]] std::string cancel();
    Result<void> answerOperator(const Question& question);
    Result<void> proceed(const Question& question);
    Result<std::string> result();
    [[nodiscard]] std::string at() const { return "/api/v1/jobs/" + std::to_string(id_); }
    [[nodiscard]] std::string name() const { return "job " + std::to_string(id_); }

    const DaemonClient& client_;
    bool yes_;
    bool quiet_;
    Progress progress_;
    std::int64_t id_ = 0;
    std::uint64_t seen_ = 0;            ///< newest event
    bool waits_ = false;                ///< for its rig
    std::uint64_t answered_ = 0;        ///< newest question
    std::optional<Question> question_;  ///< that waits for an answer
    bool ended_ = false;
    bool cancelled_ = false;
    std::optional<Error> error_;   ///< how it ended, when not well
    std::optional<Error> broken_;  ///< what the daemon said makes no sense
};

}  // namespace gonio::daemon
