#pragma once
// An engine on a test's rig, served at a UNIX socket, in this process.

#include <optional>

#include "daemon/api/http_server.h"
#include "tests/daemon/engine/running_engine.h"
#include "tests/daemon/engine/test_rig.h"

namespace gonio::test {

class ServedEngine {
public:
    explicit ServedEngine(const std::filesystem::path& store)
        : engine_(store, port), socket_(store / "goniod.sock") {
        auto opened = daemon::HttpServer::open(socket_, *engine_);
        EXPECT_TRUE(opened) << opened.error().message;
        if (opened) server_ = std::move(*opened);
    }
    /// Ends as the daemon does: first the owner, then the door.
    void end() {
        engine_.end();
        server_.reset();
    }

    [[nodiscard]] const std::filesystem::path& socket() const { return socket_; }
    [[nodiscard]] RunningEngine& engine() { return engine_; }

    TestPort port;

private:
    RunningEngine engine_;
    std::filesystem::path socket_;
    std::unique_ptr<daemon::HttpServer> server_;
};

}  // namespace gonio::test
