#pragma once
// The daemon's API, /api/v1: requests in, replies out, JSON in both. It knows no sockets. Errors
// are problem documents (RFC 9457) whose `type` names the kind of error, so that a client ends with
// the right exit code. Ids and names, never paths; the simulated rig's own door is the exception.

#include <map>
#include <string>

#include "daemon/engine/engine.h"

namespace gonio::daemon {

struct ApiRequest {
    std::string method;  ///< "GET", "POST"
    std::string path;    ///< without the query
    std::map<std::string, std::string> query;
    std::string contentType;
    std::string body;
};

struct ApiReply {
    int status = 200;
    std::string type = "application/json";
    std::string body;
};

class Api {
public:
    /// `engine` is borrowed.
    explicit Api(Engine& engine) : engine_(engine) {}

    /// For any number of threads.
    [[nodiscard]] ApiReply handle(const ApiRequest& request) const;

private:
    Engine& engine_;
};

[[nodiscard]] ApiReply problem(const Error& error);

}  // namespace gonio::daemon
