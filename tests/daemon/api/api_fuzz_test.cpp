// Requests, damaged: the API answers each with a document or with a problem, and goes on. Streams
// of events, cut anywhere: the same events come out.

#include <gtest/gtest.h>

#include <random>

#include "daemon/api/api.h"
#include "daemon/cli/event_stream.h"
#include "tests/daemon/engine/running_engine.h"
#include "tests/daemon/engine/test_rig.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

using test::Json;
using Random = std::mt19937_64;

int cases(int usual) { return std::getenv("GONIO_NIGHTLY") != nullptr ? 8 * usual : usual; }

std::size_t below(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random() % count);
}

template <class List>
std::string oneOf(const List& list, Random& random) {
    return std::string(list[below(random, std::size(list))]);
}

std::string mutated(std::string text, Random& random) {
    constexpr std::string_view kWords[] = {"null",
                                           "true",
                                           "-1",
                                           "1e999",
                                           "1e-999",
                                           "18446744073709551616",
                                           "[]",
                                           "{}",
                                           "\"\"",
                                           "\\u0000",
                                           "\\ud800",
                                           "\xFF",
                                           "..",
                                           "/",
                                           "%2e",
                                           "\"kind\":",
                                           "NaN",
                                           "*",
                                           ","};
    for (std::uint64_t k = random() % 4; k > 0; --k) {
        const std::size_t at = below(random, text.size() + 1);
        switch (random() % 5) {
            case 0:
                if (at < text.size()) text[at] = static_cast<char>(random());
                break;
            case 1: text.insert(at, kWords[below(random, std::size(kWords))]); break;
            case 2: text.erase(at, 1 + below(random, 12)); break;
            case 3: text.insert(at, text.substr(below(random, text.size() + 1), 20)); break;
            default:
                if (random() % 4 == 0) text.resize(at);
        }
    }
    return text;
}

/// Members that are asked for, of any type, and others.
Json randomBody(Random& random) {
    constexpr std::string_view kNames[] = {"kind",
                                           "name",
                                           "effort",
                                           "notes",
                                           "limit",
                                           "time_budget_s",
                                           "target_uncertainty",
                                           "operator",
                                           "what",
                                           "tilt_x_deg",
                                           "seed",
                                           "x"};
    Json body = Json::object();
    for (std::uint64_t k = random() % 4; k > 0; --k) {
        const Json values[] = {nullptr,
                               true,
                               -1,
                               0.5,
                               1e300,
                               std::uint64_t{1} << 63,
                               "measure",
                               "calibrate-mirror",
                               "tile",
                               "draft",
                               "white",
                               Json::array(),
                               Json{{"a", 1}},
                               std::string(3000, 'n')};
        body[oneOf(kNames, random)] = values[below(random, std::size(values))];
    }
    return body;
}

ApiRequest randomRequest(Random& random) {
    constexpr std::string_view kMethods[] = {"GET", "GET", "POST", "POST", "POST", "PUT", ""};
    constexpr std::string_view kNames[] = {"1", "7", "tile", "zemax", "csv", "..", "-1", "x y"};
    constexpr std::string_view kBodies[] = {
        R"({"kind":"measure","name":"tile","effort":"draft","notes":"n"})",
        R"({"kind":"verify-white","limit":0.5})",
        R"({"name":"s","operator":"o","notes":null})",
        R"({"what":"model:lambert,albedo=0.5","tilt_x_deg":0,"seed":3})",
        "{}",
        ""};
    const auto routes = Api::routes();
    std::string path;
    for (const char c : routes[below(random, routes.size())].path) {
        path += c == '*' ? oneOf(kNames, random) : std::string(1, c);
    }
    ApiRequest request{.method = oneOf(kMethods, random),
                       .path = random() % 3 == 0 ? mutated(path, random) : path,
                       .query = {},
                       .contentType = random() % 8 == 0 ? "text/plain" : "application/json",
                       .body = random() % 2 == 0 ? randomBody(random).dump()
                                                 : mutated(oneOf(kBodies, random), random)};
    if (random() % 2 == 0) request.query["band"] = mutated("g", random);
    return request;
}

TEST(ApiFuzz, EveryRequestGetsADocumentOrAProblem) {
    const test::TempFolder folder;
    test::TestPort port;
    port.cable.pull();  // no rig: a job that is right is refused as well, and none runs
    test::RunningEngine running(folder.path(), port);
    const Api api(*running);
    Random random(41);
    int documents = 0, problems = 0;
    for (int i = 0; i < cases(4'000); ++i) {
        const ApiRequest request = randomRequest(random);
        const ApiReply reply = api.handle(request);
        const std::string about = "case " + std::to_string(i) + ": " + request.method + " " +
                                  request.path + " " + request.body + "\n" + reply.body;
        const Json json = Json::parse(reply.body, nullptr, false);
        ASSERT_TRUE(json.is_object()) << about;
        if (reply.status < 300) {
            ++documents;
            ASSERT_EQ(reply.type, "application/json") << about;
            ASSERT_TRUE(json["schema"].is_string()) << about;
        } else {
            ++problems;
            ASSERT_GE(reply.status, 400) << about;
            ASSERT_NE(reply.status, 500) << about;
            ASSERT_EQ(reply.type, "application/problem+json") << about;
            ASSERT_EQ(json["status"], reply.status) << about;
            ASSERT_TRUE(json["type"].get<std::string>().starts_with("urn:gonio:problem:")) << about;
        }
    }
    EXPECT_GT(documents, cases(100)) << "some requests must be right";
    EXPECT_GT(problems, cases(100)) << "some requests must be wrong";
}

std::string randomStream(Random& random) {
    constexpr std::string_view kPieces[] = {"id: 7\n",
                                            "event: job\n",
                                            "data: {\"a\":1}\n",
                                            "\n",
                                            "\n",
                                            ":\n",
                                            "data:\n",
                                            "id\n",
                                            "data: x\n",
                                            "\r\n",
                                            "data: y\r\n",
                                            "\r"};
    std::string text;
    for (std::uint64_t k = 1 + random() % 20; k > 0; --k) text += oneOf(kPieces, random);
    return mutated(text, random);
}

TEST(EventStreamFuzz, AnySplitGivesTheSameEvents) {
    Random random(42);
    std::size_t events = 0;
    for (int i = 0; i < cases(20'000); ++i) {
        const std::string text = randomStream(random);
        EventStream whole, split;
        const auto wanted = whole.feed(text);
        std::vector<StreamEvent> seen;
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t size = random() % 4 == 0 ? 0 : 1 + below(random, 9);
            for (StreamEvent& event : split.feed(std::string_view(text).substr(at, size))) {
                seen.push_back(std::move(event));
            }
            at += size;
        }
        ASSERT_EQ(seen.size(), wanted.size()) << text;
        for (std::size_t k = 0; k < seen.size(); ++k) {
            ASSERT_EQ(seen[k].id, wanted[k].id) << text;
            ASSERT_EQ(seen[k].type, wanted[k].type) << text;
            ASSERT_EQ(seen[k].data, wanted[k].data) << text;
        }
        events += seen.size();
    }
    EXPECT_GT(events, 1000U) << "streams must hold something";
}

}  // namespace
}  // namespace gonio::daemon
