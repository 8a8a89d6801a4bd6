#pragma once
// The daemon's API, /api/v1: requests in, replies out, JSON in both. It knows no sockets. Errors
// are problem documents (RFC 9457) whose `type` names the kind of error, so that a client ends with
// the right exit code. Ids and names, never paths; the simulated rig's own door is the exception.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

struct ApiRoute {
    std::string_view method;
    std::string_view path;  ///< '*' stands for one name
};

class Api {
public:
    /// `engine` is borrowed.
    explicit Api(Engine& engine) : engine_(engine) {}

    /// All that handle() knows.
    [[nodiscard]] static std::vector<ApiRoute> routes();

    /// For any number of threads.
    [[nodiscard]] ApiReply handle(const ApiRequest& request) const;

private:
    Engine& engine_;
};

/// With the HTTP status of its kind, or another.
[[nodiscard]] ApiReply problem(const Error& error, std::optional<int> status = {});

}  // namespace gonio::daemon
