// The door: who may come in, how much they may bring, and events that are neither lost nor doubled.

#include "daemon/api/http_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "daemon/cli/daemon_client.h"
#include "daemon/store_schema.h"
#include "tests/daemon/api/raw_client.h"
#include "tests/daemon/api/served_engine.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::askRaw;
using test::Json;
using test::RawAnswer;
using test::RawConnection;
using test::requestText;
using test::ServedEngine;
using test::waitUntil;

const std::string kStatus = "/api/v1/status";
const std::string kJson = "Host: localhost\r\nContent-Type: application/json\r\n";

/// An answer that is a problem document of this type and status.
void expectProblem(const RawAnswer& answer, int status, const std::string& type) {
    EXPECT_EQ(answer.status, status) << answer.head;
    EXPECT_NE(answer.head.find("Content-Type: application/problem+json"), std::string::npos)
        << answer.head;
    const Json json = Json::parse(answer.body, nullptr, false);
    ASSERT_TRUE(json.is_object()) << answer.body;
    EXPECT_EQ(json["type"], "urn:gonio:problem:" + type);
    EXPECT_EQ(json["status"], status);
}

class HttpServerOnRig : public testing::Test {
protected:
    test::TempFolder folder;
    std::optional<ServedEngine> served{folder.path()};
    [[nodiscard]] fs::path socket() const { return folder / "goniod.sock"; }
    [[nodiscard]] RawAnswer get(const std::string& target) const {
        return askRaw(socket(), {.target = target});
    }
};

TEST_F(HttpServerOnRig, SocketIsItsOwnersAlone) {
    const auto owner = fs::perms::owner_read | fs::perms::owner_write;
    EXPECT_EQ(fs::status(socket()).permissions(), owner);
    EXPECT_EQ(get(kStatus).status, 200);
}

TEST_F(HttpServerOnRig, SocketGoesWithTheServer) {
    served.reset();
    EXPECT_FALSE(fs::exists(socket()));
}

TEST_F(HttpServerOnRig, SecondServerAtTheSocketIsBusyAndTheFirstServesOn) {
    const auto second = HttpServer::open(socket(), *served->engine());
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::Busy);
    EXPECT_EQ(get(kStatus).status, 200);
}

TEST_F(HttpServerOnRig, SocketOfAKilledDaemonIsReplaced) {
    const fs::path stale = folder / "stale.sock";
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    std::strcpy(address.sun_path, stale.c_str());
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(descriptor);
    ASSERT_TRUE(fs::is_socket(stale));
    const auto server = HttpServer::open(stale, *served->engine());
    ASSERT_TRUE(server) << server.error().message;
    EXPECT_EQ(askRaw(stale, {.target = kStatus}).status, 200);
}

TEST_F(HttpServerOnRig, FileInThePlaceOfTheSocketIsNotTouched) {
    const fs::path file = folder / "notes.txt";
    std::ofstream(file) << "dear";
    const auto server = HttpServer::open(file, *served->engine());
    ASSERT_FALSE(server);
    EXPECT_EQ(server.error().kind, ErrorKind::Busy);
    std::string text;
    std::ifstream(file) >> text;
    EXPECT_EQ(text, "dear");
}

TEST_F(HttpServerOnRig, RequestMustBeMeantForThisHost) {
    const auto from = [&](const std::string& headers) {
        return askRaw(socket(), {.target = kStatus, .headers = headers});
    };
    for (const char* host :
         {"localhost", "localhost:80", "127.0.0.1", "127.0.0.1:8080", "[::1]", "[::1]:80"}) {
        EXPECT_EQ(from(std::string("Host: ") + host + "\r\n").status, 200) << host;
    }
    for (const char* host :
         {"evil.example", "evil.example:80", "localhost.evil.example", "evil.localhost", "[::2]"}) {
        expectProblem(from(std::string("Host: ") + host + "\r\n"), 400, "usage");
    }
    expectProblem(from(""), 400, "usage");
}

TEST_F(HttpServerOnRig, BodyIsAtMostOneMebibyte) {
    const auto post = [&](std::size_t size) {
        return askRaw(socket(),
                      {.method = "POST",
                       .target = "/api/v1/sessions",
                       .headers = kJson,
                       .body = std::string(size, ' ')});
    };
    expectProblem(post(1 << 20), 400, "usage");  // read, and no JSON
    expectProblem(post((1 << 20) + 1), 413, "usage");
    EXPECT_EQ(get(kStatus).status, 200);
}

TEST_F(HttpServerOnRig, HeadersWithoutEndAreRefused) {
    const RawConnection connection(socket());
    connection.send("GET " + kStatus +
                    " HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(1 << 20, 'x') + "\r\n\r\n");
    const int status = test::parseAnswer(connection.receiveAll()).status;
    EXPECT_TRUE(status == 0 || status >= 400) << status;
    EXPECT_EQ(get(kStatus).status, 200);
}

TEST_F(HttpServerOnRig, WhatIsNoHttpGetsAnErrorAndHarmsNobody) {
    for (const char* text : {"\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "\x16\x03"}) {
        const RawConnection connection(socket());
        connection.send(text);
    }
    EXPECT_EQ(get(kStatus).status, 200);
}

TEST_F(HttpServerOnRig, PathThatWouldLeaveTheStoreIsNoPath) {
    expectProblem(get("/api/v1/samples/../../etc/passwd/file"), 404, "usage");
    expectProblem(get("/api/v1/samples/..%2F..%2Fetc%2Fpasswd/file"), 404, "usage");
    expectProblem(get("/api/v1/samples/%2e%2e/file"), 404, "file");
}

TEST_F(HttpServerOnRig, EveryMethodIsAnswered) {
    for (const char* method : {"PUT", "PATCH", "DELETE"}) {
        expectProblem(askRaw(socket(), {.method = method, .target = kStatus, .headers = kJson}),
                      405,
                      "usage");
    }
    EXPECT_GE(askRaw(socket(), {.method = "OPTIONS", .target = kStatus}).status, 400)
        << "no other origin is let in";
    EXPECT_EQ(
        askRaw(socket(), {.method = "OPTIONS", .target = kStatus}).head.find("Access-Control"),
        std::string::npos);
}

TEST_F(HttpServerOnRig, SixteenStreamsAreOpenAndTheNextIsToldWhenToComeBack) {
    std::vector<std::unique_ptr<RawConnection>> streams;
    const auto open = [&] {
        streams.push_back(std::make_unique<RawConnection>(socket()));
        streams.back()->send(requestText({.target = "/api/v1/events"}));
        return streams.back()->receiveUntil("\r\n\r\n");
    };
    for (int i = 0; i < 16; ++i) {
        const std::string head = open();
        ASSERT_NE(head.find("200 OK"), std::string::npos) << head;
        EXPECT_NE(head.find("Content-Type: text/event-stream"), std::string::npos) << head;
        EXPECT_NE(head.find("Cache-Control: no-store"), std::string::npos) << head;
    }
    const RawAnswer refused = get("/api/v1/events");
    expectProblem(refused, 503, "busy");
    EXPECT_NE(refused.head.find("Retry-After: "), std::string::npos) << refused.head;
    for (int i = 0; i < 20; ++i) EXPECT_EQ(get(kStatus).status, 200);
    streams.erase(streams.begin());
    EXPECT_TRUE(waitUntil([&] { return open().find("200 OK") != std::string::npos; }))
        << "a stream that has gone makes room within its heartbeat";
}

TEST_F(HttpServerOnRig, EndsWithinTwoSecondsWhoeverIsConnected) {
    std::vector<std::unique_ptr<RawConnection>> connections;
    for (int i = 0; i < 16; ++i) {
        connections.push_back(std::make_unique<RawConnection>(socket()));
        connections.back()->send(requestText({.target = "/api/v1/events"}));
        connections.back()->receiveUntil("\r\n\r\n");
    }
    connections.push_back(std::make_unique<RawConnection>(socket()));  // one that is kept alive
    connections.back()->send(requestText({.target = kStatus}));
    connections.back()->receiveUntil("\r\n\r\n");
    connections.push_back(std::make_unique<RawConnection>(socket()));  // one that says nothing
    const auto begin = std::chrono::steady_clock::now();
    served->end();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s * test::kSlowdown);
}

TEST_F(HttpServerOnRig, ErrorsComeBackThroughTheClientWithTheirKind) {
    served->port.refuse(Error{ErrorKind::Busy, "held"});
    const DaemonClient client(socket());
    const auto kindOf = [](const Result<std::string>& answer) {
        EXPECT_FALSE(answer);
        return answer ? ErrorKind::Internal : answer.error().kind;
    };
    EXPECT_EQ(kindOf(client.get("/api/v1/samples/none/file")), ErrorKind::File);
    EXPECT_EQ(kindOf(client.get("/api/v1/nothing")), ErrorKind::Usage);
    EXPECT_EQ(kindOf(client.post("/api/v1/sim/place", R"({"what":"white"})")), ErrorKind::Usage);
    EXPECT_EQ(kindOf(client.post("/api/v1/sessions", std::string((1 << 20) + 1, ' '))),
              ErrorKind::Usage);
    EXPECT_TRUE(client.get(kStatus));
    served.reset();
    EXPECT_EQ(kindOf(client.get(kStatus)), ErrorKind::NoRig);
}

// ---- events ----

EventRecord eventOf(const std::string& type) {
    return {.dateUtc = "t", .type = type, .data = "{}"};
}

/// Numbers of the events that a client gets after `after`, up to number `last`.
std::vector<std::uint64_t> follow(const fs::path& socket, std::uint64_t after, std::uint64_t last) {
    std::vector<std::uint64_t> ids;
    const auto deadline = std::chrono::steady_clock::now() + test::kPatience;
    const Result<bool> done = DaemonClient(socket).follow(
        after,
        [&](const StreamEvent& event) {
            ids.push_back(event.id);
            return event.id < last;
        },
        [&] { return std::chrono::steady_clock::now() < deadline; });
    EXPECT_TRUE(done) << done.error().message;
    return ids;
}

class EventStreams : public testing::Test {
protected:
    void serve() {
        served.emplace(folder.path());
        served->engine().await(EngineState::Idle);  // from here on the owner adds nothing
    }
    EventLog& events() { return served->engine()->events(); }
    void keep(std::uint64_t id) {
        if (!book) {
            ASSERT_TRUE(Store::open(folder.path()));
            auto opened = Logbook::open(folder.path());
            ASSERT_TRUE(opened) << opened.error().message;
            book.emplace(std::move(*opened));
        }
        ASSERT_TRUE(book->addEvent({.id = id, .dateUtc = "t", .type = "kept", .data = "{}"}));
    }
    test::TempFolder folder;
    std::optional<Logbook> book;
    std::optional<ServedEngine> served;
    fs::path socket = folder / "goniod.sock";
};

TEST_F(EventStreams, ComeAsTheyHappenWithoutGapOrDuplicate) {
    serve();
    const std::uint64_t first = events().newest() + 1;
    constexpr std::uint64_t kEvents = 300;
    std::jthread telling([&] {
        for (std::uint64_t i = 0; i < kEvents; ++i) events().add(eventOf("x"));
    });
    const auto ids = follow(socket, first - 1, first + kEvents - 1);
    ASSERT_EQ(ids.size(), kEvents);
    for (std::uint64_t i = 0; i < kEvents; ++i) ASSERT_EQ(ids[i], first + i);
}

TEST_F(EventStreams, ResumeAfterTheLastThatWasSeen) {
    serve();
    for (int i = 0; i < 20; ++i) events().add(eventOf("x"));
    const std::uint64_t newest = events().newest();
    const auto all = follow(socket, 0, newest);
    EXPECT_EQ(all.front(), 1U);
    for (std::size_t i = 1; i < all.size(); ++i) EXPECT_EQ(all[i], all[i - 1] + 1);
    EXPECT_EQ(follow(socket, newest - 5, newest).size(), 5U);
}

TEST_F(EventStreams, WithoutANumberBeginNow) {
    serve();
    RawConnection stream(socket);
    stream.send(requestText({.target = "/api/v1/events"}));
    stream.receiveUntil(":\n\n");  // the first thing that a stream says: it is there
    const auto told = events().add(eventOf("now"));
    const std::string text = stream.receiveUntil("event: now\ndata: {}\n\n");
    EXPECT_NE(text.find("id: " + std::to_string(told.id) + "\n"), std::string::npos) << text;
    EXPECT_EQ(text.find("event: rig"), std::string::npos) << text;
}

TEST_F(EventStreams, NumberInTheAddressCountsWhereTheHeaderIsMissing) {
    serve();
    const auto told = events().add(eventOf("late"));
    RawConnection stream(socket);
    stream.send(requestText({.target = "/api/v1/events?after=" + std::to_string(told.id - 1)}));
    EXPECT_NE(stream.receiveUntil("event: late").find("id: " + std::to_string(told.id)),
              std::string::npos);
}

TEST_F(EventStreams, OldOnesComeFromTheLogbookAndNewOnesFollow) {
    std::vector<std::uint64_t> wanted;
    ASSERT_TRUE(Store::open(folder.path()));
    auto database = openStoreDatabase(folder.path());
    ASSERT_TRUE(database) << database.error().message;
    const auto all = database->transaction([&]() -> Result<void> {  // at once: each alone is slow
        for (int i = 0; i < 1200; ++i) {                            // more than are read at once
            const std::int64_t id = 1 + 3 * i;                      // those between were not kept
            wanted.push_back(static_cast<std::uint64_t>(id));
            const auto added = database->run(
                "INSERT INTO events(id, date, type, data) VALUES(?, 't', 'x', '{}')", {id});
            if (!added) return added.error();
        }
        return {};
    });
    ASSERT_TRUE(all) << all.error().message;
    serve();
    for (std::uint64_t id = events().oldest(); id <= events().newest(); ++id) wanted.push_back(id);
    EXPECT_EQ(follow(socket, 0, events().newest()), wanted);
    const auto half = std::find(wanted.begin(), wanted.end(), 601U);
    EXPECT_EQ(follow(socket, 600, events().newest()),
              std::vector<std::uint64_t>(half, wanted.end()));
}

TEST_F(EventStreams, NothingIsLostWhereTheLogbookAndTheMemoryOverlap) {
    serve();
    std::vector<std::uint64_t> kept, wanted;
    for (int i = 0; i < 5000; ++i) {  // more than the memory holds
        if (i % 500 == 0) {
            keep(events().newest() + 1);
            kept.push_back(events().newest() + 1);
        }
        events().add(eventOf("x"));
    }
    const std::uint64_t oldest = events().oldest();
    ASSERT_GT(oldest, kept.front());
    const auto old = book->eventsAfter(0, 10000);
    for (const EventRecord& event : *old) {
        if (event.id < oldest) wanted.push_back(event.id);
    }
    for (std::uint64_t id = oldest; id <= events().newest(); ++id) wanted.push_back(id);
    EXPECT_EQ(follow(socket, 0, events().newest()), wanted);
}

TEST_F(EventStreams, GoOnWhereTheyWereAfterARestart) {
    serve();
    for (int i = 0; i < 30; ++i) events().add(eventOf("x"));
    const std::uint64_t seen = events().newest();
    served.reset();
    serve();
    EXPECT_GT(events().newest(), seen);
    const auto ids = follow(socket, seen, events().newest());
    ASSERT_FALSE(ids.empty());
    EXPECT_GT(ids.front(), seen);
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    // Both that the rig appeared and that it was claimed.
    EXPECT_GE(ids.size(), 2U);
}

}  // namespace
}  // namespace gonio::daemon
