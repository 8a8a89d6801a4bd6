#pragma once
// A daemon that says what a test has it say, at the socket of a Program's store: for what the real
// one cannot be brought to do at will. It has one job, number 7.

#include <httplib.h>
#include <sys/socket.h>

#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/daemon/cli/program.h"
#include "tests/support/wait_until.h"

namespace gonio::test {

/// What it says.
struct Script {
    /// Each stream of events ends after the next one of these that its reader has not seen.
    std::vector<std::string> events;
    /// Streams are refused, as when too many are open.
    bool refusesStreams = false;
    /// The status, and the job's document; a text that is no JSON is said as it is.
    std::string status = R"({"daemon":{"newest_event":0},"job":null})";
    std::string job = R"({"problem":null,"message":null,"result":null})";
    /// HTTP status of the answer to an answer.
    int proceedStatus = 202;
    /// What the doctor is told, and its HTTP status.
    std::string doctor = R"({"findings":[]})";
    int doctorStatus = 200;
};

class ScriptedDaemon {
public:
    explicit ScriptedDaemon(const Program& program) {
        std::filesystem::create_directories(program / "store");
        server_.set_address_family(AF_UNIX);
        server_.Get("/api/v1/status",
                    [this](const auto&, auto& reply) { say(reply, script().status); });
        server_.Get("/api/v1/jobs/7",
                    [this](const auto&, auto& reply) { say(reply, script().job); });
        server_.Get("/api/v1/events",
                    [this](const auto& asked, auto& reply) { stream(asked, reply); });
        server_.Post("/api/v1/doctor", [this](const auto&, auto& reply) {
            reply.status = script().doctorStatus;
            say(reply, script().doctor);
        });
        server_.Post(".*", [this](const httplib::Request& asked, httplib::Response& reply) {
            heard(asked, reply);
        });
        EXPECT_TRUE(server_.bind_to_port((program / "store/goniod.sock").string(), 80));
        thread_ = std::thread([this] { server_.listen_after_bind(); });
        EXPECT_TRUE(waitUntil([this] { return server_.is_running(); }));
    }
    ~ScriptedDaemon() { stop(); }
    ScriptedDaemon(const ScriptedDaemon&) = delete;
    ScriptedDaemon& operator=(const ScriptedDaemon&) = delete;

    void play(Script script) {
        const std::scoped_lock lock(mutex_);
        script_ = std::move(script);
    }
    void stop() {
        server_.stop();
        if (thread_.joinable()) thread_.join();
    }

    /// The bodies that were posted there.
    [[nodiscard]] std::vector<std::string> posted(const std::string& path) const {
        const std::scoped_lock lock(mutex_);
        std::vector<std::string> bodies;
        for (const auto& [at, body] : posts_) {
            if (at == path) bodies.push_back(body);
        }
        return bodies;
    }

private:
    [[nodiscard]] Script script() const {
        const std::scoped_lock lock(mutex_);
        return script_;
    }
    static void say(httplib::Response& reply, const std::string& text) {
        reply.set_content(text, "application/json");
    }
    void stream(const httplib::Request& asked, httplib::Response& reply) {
        const Script now = script();
        if (now.refusesStreams) {
            reply.status = 503;
            return say(reply, R"({"type":"urn:gonio:problem:busy","detail":"too many streams"})");
        }
        const std::size_t seen = std::stoul(asked.get_header_value("Last-Event-ID"));
        std::string text = ":\n\n";
        if (seen < now.events.size()) {
            text = "id: " + std::to_string(seen + 1) + "\n" + now.events[seen] + "\n\n";
        }
        reply.set_content(text, "text/event-stream");
    }
    void heard(const httplib::Request& asked, httplib::Response& reply) {
        {
            const std::scoped_lock lock(mutex_);
            posts_.emplace_back(asked.path, asked.body);
        }
        reply.status = 202;
        if (asked.path.ends_with("/proceed")) reply.status = script().proceedStatus;
        if (reply.status >= 400) {
            return say(reply, R"({"type":"urn:gonio:problem:usage","detail":"nobody asks this"})");
        }
        say(reply, R"({"id":7})");
    }

    httplib::Server server_;
    std::thread thread_;
    mutable std::mutex mutex_;  // of what follows
    Script script_;
    std::vector<std::pair<std::string, std::string>> posts_;
};

}  // namespace gonio::test
