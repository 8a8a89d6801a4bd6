#include "daemon/api/http_server.h"

#include <httplib.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <atomic>
#include <thread>

#include "daemon/guarded.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kThreads = 64;
constexpr int kMostStreams = 16;
constexpr std::size_t kLongestBody = 1 << 20;
constexpr int kOldEventsAtOnce = 500;
constexpr auto kHeartbeat = 1000ms;
constexpr int kUnavailable = 503;
constexpr int kUnusedPort = 80;  // a UNIX socket has none
// An idle connection, or a request that stops half-way, holds up the end of the server for so long.
constexpr std::time_t kSilenceSeconds = 1;

ApiRequest requestOf(const httplib::Request& http) {
    ApiRequest request{.method = http.method,
                       .path = http.path,
                       .query = {},
                       .contentType = http.get_header_value("Content-Type"),
                       .body = http.body};
    for (const auto& [name, value] : http.params) request.query.emplace(name, value);
    return request;
}

void answer(const ApiReply& reply, httplib::Response& response) {
    response.status = reply.status;
    response.set_content(reply.body, reply.type);
}

/// A page of another origin cannot reach a UNIX socket; a proxy in front of it could be made to.
bool meantForUs(const std::string& host) {
    const std::string name = host.substr(0, host.rfind(':'));
    return name == "localhost" || name == "127.0.0.1" || host == "[::1]" || name == "[::1]";
}

std::string streamText(const EventRecord& event) {
    return "id: " + std::to_string(event.id) + "\nevent: " + event.type + "\ndata: " + event.data +
           "\n\n";
}

/// Hands one watcher its events in order: first those that only the logbook still has.
class Follower {
public:
    Follower(Engine& engine, std::uint64_t after) : engine_(engine), after_(after) {}

    /// False: there will be no more.
    bool next(std::string& text) {
        std::vector<EventRecord> events;
        bool gap = true;
        while (gap) {
            Result<std::vector<EventRecord>> old = remembered();
            if (!old) return false;  // the watcher comes back and asks again
            events = std::move(*old);
            if (!events.empty()) break;
            events = engine_.events().after(after_, begun_ ? kHeartbeat : 0ms);
            // The memory may have moved on since: then the logbook has what fell out of it.
            gap = !events.empty() && events.front().id > after_ + 1;
        }
        begun_ = true;
        text.clear();
        for (const EventRecord& event : events) text += streamText(event);
        if (!events.empty()) after_ = events.back().id;
        if (text.empty()) text = ":\n\n";  // tells a dead watcher from a quiet rig
        return !(events.empty() && engine_.events().closed());
    }

private:
    /// The next of those that the memory no longer has; none: the memory goes on from here.
    Result<std::vector<EventRecord>> remembered() {
        const std::uint64_t oldest = engine_.events().oldest();
        if (after_ + 1 >= oldest) return std::vector<EventRecord>();
        Result<Logbook> book = Logbook::openToRead(engine_.storeRoot());
        if (!book) return book.error();
        auto events = book->eventsAfter(after_, kOldEventsAtOnce);
        if (!events) return events;
        std::erase_if(*events, [&](const EventRecord& event) { return event.id >= oldest; });
        if (events->empty()) after_ = oldest - 1;
        return events;
    }
    Engine& engine_;
    std::uint64_t after_;
    bool begun_ = false;
};

}  // namespace

class HttpServer::Impl {
public:
    Impl(Engine& engine, SocketClaim claim)
        : engine_(engine), api_(engine), claim_(std::move(claim)) {}
    ~Impl() {
        stopping_ = true;
        server_.stop();
        if (thread_.joinable()) thread_.join();
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    Result<void> listen(const std::filesystem::path& socket, SocketAccess access);

private:
    void route();
    void follow(const httplib::Request& request, httplib::Response& response);

    Engine& engine_;
    Api api_;
    SocketClaim claim_;
    httplib::Server server_;
    std::atomic<int> streams_{0};
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

void HttpServer::Impl::follow(const httplib::Request& request, httplib::Response& response) {
    if (++streams_ > kMostStreams) {
        --streams_;
        response.set_header("Retry-After", "5");
        return answer(problem({ErrorKind::Busy, "16 event streams are open already"}, kUnavailable),
                      response);
    }
    std::string from = request.get_header_value("Last-Event-ID");
    if (from.empty()) from = request.get_param_value("after");
    const auto number = parseInteger(from);
    const std::uint64_t newest = engine_.events().newest();
    const auto after =
        number && *number >= 0 ? std::min(static_cast<std::uint64_t>(*number), newest) : newest;
    response.set_header("Cache-Control", "no-store");
    auto follower = std::make_shared<Follower>(engine_, after);  // shared: std::function copies
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, follower](std::size_t /*offset*/, httplib::DataSink& sink) {
            std::string text;
            const bool more = follower->next(text) && !stopping_;
            if (!sink.write(text.data(), text.size())) return false;
            if (!more) sink.done();
            return true;
        },
        [this](bool /*success*/) { --streams_; });
}

void HttpServer::Impl::route() {
    const auto handle = [this](const httplib::Request& request, httplib::Response& response) {
        if (!meantForUs(request.get_header_value("Host"))) {
            return answer(problem({ErrorKind::Usage, "wanted Host: localhost"}), response);
        }
        if (request.method == "GET" && request.path == "/api/v1/events") {
            return follow(request, response);
        }
        answer(api_.handle(requestOf(request)), response);
    };
    const std::string everything = ".*";
    server_.Get(everything, handle);
    server_.Post(everything, handle);
    server_.Put(everything, handle);
    server_.Patch(everything, handle);
    server_.Delete(everything, handle);
    server_.Options(everything, handle);
    server_.set_exception_handler([](const httplib::Request& request,
                                     httplib::Response& response,
                                     std::exception_ptr thrown) {
        const auto work = [&] { std::rethrow_exception(thrown); };
        const Result<void> ended = guarded("api: " + request.method + " " + request.path, work);
        log::error(ended.error().message);
        answer(problem({ErrorKind::Internal, "internal error"}), response);
    });
    // What never came as far as a handler: too long, or no HTTP.
    server_.set_error_handler([](const httplib::Request& /*request*/, httplib::Response& response) {
        if (!response.body.empty()) return;
        answer(problem({ErrorKind::Usage, "this request is not served"}, response.status),
               response);
    });
    server_.set_payload_max_length(kLongestBody);
    server_.set_keep_alive_timeout(kSilenceSeconds);
    server_.set_read_timeout(kSilenceSeconds);
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };  // it deletes it
}

Result<void> HttpServer::Impl::listen(const std::filesystem::path& socket, SocketAccess access) {
    route();
    server_.set_address_family(AF_UNIX);
    // Nobody else may connect, from the first moment on.
    const mode_t before = ::umask(access == SocketAccess::User ? 0177 : 0117);
    const bool bound = server_.bind_to_port(socket.string(), kUnusedPort);
    ::umask(before);
    if (!bound) {
        return Error{ErrorKind::Busy,
                     "socket " + socket.string() +
                         ": cannot be made; choose another place with --socket PATH"};
    }
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // stop() before it runs would be lost.
    while (!server_.is_running()) std::this_thread::sleep_for(1ms);
    return {};
}

HttpServer::HttpServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
HttpServer::~HttpServer() = default;

Result<std::unique_ptr<HttpServer>> HttpServer::open(const std::filesystem::path& socket,
                                                     Engine& engine,
                                                     SocketAccess access) {
    Result<SocketClaim> claim = SocketClaim::take(socket);
    if (!claim) return claim.error();
    auto impl = std::make_unique<Impl>(engine, std::move(*claim));
    if (Result<void> listening = impl->listen(socket, access); !listening) return listening.error();
    return std::unique_ptr<HttpServer>(new HttpServer(std::move(impl)));
}

}  // namespace gonio::daemon
