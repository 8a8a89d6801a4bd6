#include "daemon/cli/daemon_client.h"

#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>

#include "daemon/problem.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::json;

constexpr int kUnusedPort = 80;      // a UNIX socket has none
constexpr int kPatience = 60;        // seconds; the daemon answers when its owner comes to it
constexpr int kStreamPatience = 10;  // seconds; a stream says something each second

httplib::Client clientOf(const std::filesystem::path& socket) {
    httplib::Client client(socket.string(), kUnusedPort);
    client.set_address_family(AF_UNIX);
    client.set_default_headers({{"Host", "localhost"}});
    client.set_read_timeout(kPatience);
    return client;
}

/// A problem document as the error that it was.
Error errorOf(int status, const std::string& body) {
    constexpr std::string_view kType = "urn:gonio:problem:";
    const Json json = Json::parse(body, nullptr, false);
    const bool problem = json.is_object() && json.contains("type") && json["type"].is_string() &&
                         json.contains("detail") && json["detail"].is_string();
    if (!problem) return {ErrorKind::Internal, "the daemon answered " + std::to_string(status)};
    const std::string type = json["type"];
    return {problemKind(type.starts_with(kType) ? type.substr(kType.size()) : ""), json["detail"]};
}

}  // namespace

Error DaemonClient::unreachable(bool answered) const {
    const std::string at = socket_.string();
    if (answered) return {ErrorKind::NoRig, "the daemon at " + at + " fell silent"};
    if (::access(socket_.c_str(), R_OK | W_OK) != 0 && errno == EACCES) {
        return {ErrorKind::Busy, "no permission for the daemon's socket " + at};
    }
    return {ErrorKind::NoRig,
            "no daemon at " + at + "; start one: goniod --rig sim (or --rig usb)"};
}

Result<std::string> DaemonClient::get(const std::string& path) const {
    httplib::Client client = clientOf(socket_);
    const httplib::Result answer = client.Get(path);
    if (!answer) return unreachable(answer.error() == httplib::Error::Read);
    if (answer->status >= 400) return errorOf(answer->status, answer->body);
    return answer->body;
}

Result<std::string> DaemonClient::post(const std::string& path, const std::string& json) const {
    httplib::Client client = clientOf(socket_);
    const httplib::Result answer = client.Post(path, json, "application/json");
    if (!answer) return unreachable(answer.error() == httplib::Error::Read);
    if (answer->status >= 400) return errorOf(answer->status, answer->body);
    return answer->body;
}

Result<bool> DaemonClient::follow(std::uint64_t after,
                                  const std::function<bool(const StreamEvent&)>& on,
                                  const std::function<bool()>& idle) const {
    httplib::Client client = clientOf(socket_);
    client.set_read_timeout(kStreamPatience);
    EventStream stream;
    bool enough = false;
    int status = 0;
    std::string refusal;
    const httplib::Result answer = client.Get(
        "/api/v1/events",
        {{"Last-Event-ID", std::to_string(after)}},
        [&](const httplib::Response& response) {
            status = response.status;
            return true;
        },
        [&](const char* data, std::size_t size) {
            if (status >= 400) {
                refusal.append(data, size);
                return true;
            }
            for (const StreamEvent& event : stream.feed({data, size})) {
                enough = enough || !on(event);
                if (enough) return false;
            }
            enough = !idle();
            return !enough;
        });
    if (status >= 400) return errorOf(status, refusal);
    if (enough || answer) return enough;
    return unreachable(status != 0);
}

}  // namespace gonio::daemon
