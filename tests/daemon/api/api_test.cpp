// Requests in, replies out: each route, and each way to get it wrong.

#include "daemon/api/api.h"

#include <gtest/gtest.h>

#include "daemon/conversion_input.h"
#include "daemon/problem.h"
#include "proc/formats/gonio_exr.h"
#include "tests/daemon/engine/running_engine.h"
#include "tests/daemon/engine/test_rig.h"
#include "tests/support/sample_sets.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

using test::Json;
using test::RunningEngine;

/// The API of an engine on a port; `Port` is opened by the fixture.
template <class Fixture>
class ApiCalls : public testing::Test {
protected:
    ApiReply call(const ApiRequest& request) { return api().handle(request); }
    ApiReply get(const std::string& path, std::map<std::string, std::string> query = {}) {
        return call({.method = "GET",
                     .path = "/api/v1/" + path,
                     .query = std::move(query),
                     .contentType = {},
                     .body = {}});
    }
    ApiReply post(const std::string& path, const std::string& body) {
        return call({.method = "POST",
                     .path = "/api/v1/" + path,
                     .query = {},
                     .contentType = "application/json",
                     .body = body});
    }
    Api api() { return Api(*static_cast<Fixture*>(this)->engine); }
};

/// The document of a reply that went well.
Json documentOf(const ApiReply& reply, const std::string& name, int status = 200) {
    EXPECT_EQ(reply.status, status) << reply.body;
    EXPECT_EQ(reply.type, "application/json");
    Json json = Json::parse(reply.body, nullptr, false);
    EXPECT_TRUE(json.is_object()) << reply.body;
    EXPECT_EQ(json.value("schema", ""), "gonio/" + name + "/1");
    return json;
}

/// A problem of this status and kind, whose detail says all of `words`.
void expectProblem(const ApiReply& reply,
                   int status,
                   ErrorKind kind,
                   const std::vector<std::string>& words = {}) {
    EXPECT_EQ(reply.status, status) << reply.body;
    EXPECT_EQ(reply.type, "application/problem+json");
    const Json json = Json::parse(reply.body, nullptr, false);
    ASSERT_TRUE(json.is_object()) << reply.body;
    EXPECT_EQ(json["type"], "urn:gonio:problem:" + std::string(problemName(kind)));
    EXPECT_EQ(json["title"], std::string(problemName(kind)));
    EXPECT_EQ(json["status"], status);
    for (const std::string& word : words) {
        EXPECT_NE(json["detail"].get<std::string>().find(word), std::string::npos) << reply.body;
    }
}

TEST(ApiProblem, OfEveryKindComesBackToItsExitCode) {
    constexpr std::string_view kType = "urn:gonio:problem:";
    const std::map<ErrorKind, int> statuses{{ErrorKind::Internal, 500},
                                            {ErrorKind::Usage, 400},
                                            {ErrorKind::NoRig, 503},
                                            {ErrorKind::Busy, 409},
                                            {ErrorKind::Device, 502},
                                            {ErrorKind::File, 500},
                                            {ErrorKind::Quality, 422},
                                            {ErrorKind::Interrupted, 409}};
    for (const auto& [kind, status] : statuses) {
        const ApiReply reply = problem({kind, "why"});
        expectProblem(reply, status, kind, {"why"});
        const std::string type = Json::parse(reply.body)["type"];
        ASSERT_TRUE(type.starts_with(kType));
        EXPECT_EQ(problemKind(type.substr(kType.size())), kind);
    }
    expectProblem(problem({ErrorKind::Busy, "full"}, 503), 503, ErrorKind::Busy);
}

TEST(ApiProblem, TextThatIsNoUtf8IsRepaired) {
    const ApiReply reply = problem({ErrorKind::File, "caf\xE9"});
    EXPECT_TRUE(Json::accept(reply.body)) << reply.body;
}

class ApiOnSim : public ApiCalls<ApiOnSim> {
protected:
    void SetUp() override {
        auto opened = SimPort::open(folder.path());
        ASSERT_TRUE(opened) << opened.error().message;
        port = std::move(*opened);
        running.emplace(folder.path(), *port);
        engine = &**running;
        running->await(EngineState::Idle);
    }
    void keepSample(const std::string& name) {
        auto store = Store::open(folder.path());
        ASSERT_TRUE(store) << store.error().message;
        auto set = test::sampleSet([](Radians, const Direction&) { return 0.2; });
        set.leds.resize(1);
        ASSERT_TRUE(store->addSample({.name = name, .rig = "R1", .dateUtc = "today"},
                                     {.file = *proc::encodeGonio(set), .raw = "raw bytes"}));
    }
    test::TempFolder folder;
    std::unique_ptr<SimPort> port;
    std::optional<RunningEngine> running;

public:
    Engine* engine = nullptr;
};

TEST_F(ApiOnSim, StatusSaysWhatIsSo) {
    const Json json = documentOf(get("status"), "status");
    EXPECT_EQ(json["rig"]["kind"], "sim");
    EXPECT_EQ(json["rig"]["state"], "idle");
    EXPECT_EQ(json["rig"]["serial"], "SIM-0001");
    EXPECT_EQ(json["rig"]["placed"], "nothing");
    EXPECT_EQ(json["rig"]["obstacle"], nullptr);
    EXPECT_EQ(json["job"], nullptr);
    EXPECT_EQ(json["session"], nullptr);
    EXPECT_EQ(json["calibrations"]["mirror"], nullptr);
    EXPECT_EQ(json["daemon"]["store"], folder.path().string());
    EXPECT_EQ(json["daemon"]["newest_event"], engine->events().newest());
}

TEST_F(ApiOnSim, DoctorSeesTheRigThatTheDaemonHas) {
    const Json json = documentOf(post("doctor", "{}"), "doctor");
    std::vector<std::string> subjects;
    for (const Json& finding : json["findings"]) {
        subjects.push_back(finding["subject"]);
        EXPECT_EQ(finding["rig"], "SIM-0001");
        EXPECT_EQ(finding["verdict"], "ok") << finding;
        EXPECT_EQ(finding["cure"], nullptr) << finding;
    }
    const std::vector<std::string> wanted{"claim",
                                          "protocol",
                                          "identity",
                                          "clock",
                                          "temperature",
                                          "interlock",
                                          "self-test",
                                          "noise",
                                          "counters",
                                          "link"};
    EXPECT_EQ(subjects, wanted);
    expectProblem(post("doctor", R"({"slowly":true})"), 400, ErrorKind::Usage, {"slowly"});
}

TEST_F(ApiOnSim, LookingAtTheDoctorsFindingsAsksNothingOfTheRig) {
    const Json json = documentOf(get("doctor"), "doctor");
    const Json& test = json["findings"][6];
    EXPECT_EQ(test["verdict"], "note") << json;
    EXPECT_NE(test["seen"].get<std::string>().find("not asked"), std::string::npos) << json;
}

TEST_F(ApiOnSim, RigsAreListed) {
    const Json json = documentOf(get("rigs"), "rigs");
    ASSERT_EQ(json["rigs"].size(), 1U);
    EXPECT_EQ(json["rigs"][0]["serial"], "SIM-0001");
}

TEST_F(ApiOnSim, SessionOpensAndCloses) {
    EXPECT_TRUE(documentOf(get("sessions"), "sessions")["sessions"].empty());
    const Json opened =
        documentOf(post("sessions", R"({"name":"one","operator":"Ada","notes":null})"), "session");
    EXPECT_EQ(opened["name"], "one");
    EXPECT_EQ(opened["operator"], "Ada");
    EXPECT_EQ(opened["notes"], nullptr);
    EXPECT_EQ(opened["closed"], nullptr);
    expectProblem(post("sessions", "{}"), 400, ErrorKind::Usage, {"'one' is open"});
    EXPECT_EQ(documentOf(get("status"), "status")["session"]["name"], "one");
    EXPECT_EQ(documentOf(post("sessions/close", "{}"), "session")["closed"],
              "2026-01-02T03:04:05Z");
    expectProblem(post("sessions/close", ""), 400, ErrorKind::Usage, {"no session"});
    EXPECT_EQ(documentOf(get("sessions"), "sessions")["sessions"].size(), 1U);
}

TEST_F(ApiOnSim, JobIsBegunFollowedAndCancelled) {
    documentOf(post("sim/place", R"({"what":"mirror"})"), "sim-place");
    const Json begun = documentOf(post("jobs", R"({"kind":"calibrate-mirror"})"), "job", 202);
    EXPECT_EQ(begun["state"], "running");
    EXPECT_EQ(begun["kind"], "calibrate-mirror");
    EXPECT_EQ(begun["name"], nullptr);
    EXPECT_EQ(begun["result"], nullptr);
    const std::string at = "jobs/" + std::to_string(begun["id"].get<std::int64_t>());
    expectProblem(post("jobs", R"({"kind":"calibrate-mirror"})"), 409, ErrorKind::Busy);
    expectProblem(post("sessions", "{}"), 409, ErrorKind::Busy);
    expectProblem(post("sim/place", R"({"what":"white"})"), 409, ErrorKind::Busy);
    expectProblem(
        post(at + "/proceed", R"({"question":1})"), 409, ErrorKind::Usage, {"waits for nobody"});
    expectProblem(post(at + "/proceed", "{}"), 400, ErrorKind::Usage, {"'question'"});
    EXPECT_EQ(documentOf(get(at), "job")["state"], "running");
    EXPECT_EQ(documentOf(post(at + "/cancel", "{}"), "job-wish", 202)["id"], begun["id"]);
    ASSERT_TRUE(test::waitUntil([&] { return engine->status().job == std::nullopt; }));
    const Json ended = documentOf(get(at), "job");
    EXPECT_EQ(ended["state"], "cancelled");
    EXPECT_EQ(ended["problem"], "interrupted");
    EXPECT_EQ(documentOf(get("jobs"), "jobs")["jobs"][0]["state"], "cancelled");
    expectProblem(post(at + "/cancel", "{}"), 409, ErrorKind::Usage, {"not running"});
}

TEST_F(ApiOnSim, JobThatIsNotThereIsNotFound) {
    expectProblem(get("jobs/7"), 404, ErrorKind::Usage, {"job 7"});
    expectProblem(get("jobs/-1"), 404, ErrorKind::Usage);
    for (const char* id : {"x", "7x", "1e3", "99999999999999999999", "../status"}) {
        EXPECT_GE(get(std::string("jobs/") + id).status, 400) << id;
    }
    expectProblem(get("jobs/seven"), 400, ErrorKind::Usage, {"'seven'"});
    expectProblem(post("jobs/seven/cancel", "{}"), 400, ErrorKind::Usage, {"'seven'"});
}

TEST_F(ApiOnSim, JobMustBeOneThatTheRigCanDo) {
    expectProblem(
        post("jobs", R"({"kind":"polish"})"), 400, ErrorKind::Usage, {"polish", "measure"});
    expectProblem(post("jobs", R"({"kind":"measure"})"), 400, ErrorKind::Usage, {"name"});
    expectProblem(
        post("jobs", R"({"kind":"measure","name":"../x"})"), 400, ErrorKind::Usage, {"../x"});
    expectProblem(post("jobs", R"({"kind":"measure","name":"x","effort":"heroic"})"),
                  400,
                  ErrorKind::Usage,
                  {"heroic", "draft"});
    expectProblem(
        post("jobs", R"({"kind":"verify-white","limit":2})"), 400, ErrorKind::Usage, {"limit"});
    EXPECT_TRUE(documentOf(get("jobs"), "jobs")["jobs"].empty()) << "none of them was begun";
}

TEST_F(ApiOnSim, BodyMustBeAnObjectOfKnownMembersOfTheirTypes) {
    for (const char* body : {"[]", "1", "\"a\"", "null", "{", "{\"name\":1e999}", "\xFF", "{}{}"}) {
        expectProblem(post("sessions", body), 400, ErrorKind::Usage);
    }
    expectProblem(post("sessions", R"({"nmae":"x"})"), 400, ErrorKind::Usage, {"'nmae'"});
    expectProblem(post("sessions", R"({"name":7})"), 400, ErrorKind::Usage, {"'name'", "a text"});
    expectProblem(post("jobs", "{}"), 400, ErrorKind::Usage, {"'kind'"});
    expectProblem(post("jobs", R"({"kind":null})"), 400, ErrorKind::Usage, {"'kind'"});
    expectProblem(
        post("jobs", R"({"kind":"verify-white","limit":"1"})"), 400, ErrorKind::Usage, {"'limit'"});
    for (const char* seed : {"-1", "1.5", "\"1\"", "true", "18446744073709551616"}) {
        const std::string body = std::string(R"({"what":"white","seed":)") + seed + "}";
        expectProblem(post("sim/place", body), 400, ErrorKind::Usage, {"'seed'"});
    }
    expectProblem(
        post("sim/place", R"({"what":"mirror","tilt_x_deg":31})"), 400, ErrorKind::Usage, {"31"});
    expectProblem(post("jobs/1/cancel", R"({"now":true})"), 400, ErrorKind::Usage, {"'now'"});
    expectProblem(post("sessions/close", "[]"), 400, ErrorKind::Usage);
    EXPECT_TRUE(documentOf(get("sessions"), "sessions")["sessions"].empty());
}

TEST_F(ApiOnSim, DepthOfABodyHarmsNobody) {
    expectProblem(post("sessions", std::string(1 << 20, '[')), 400, ErrorKind::Usage);
    std::string deep = R"({"name":)" + std::string(100'000, '[') + std::string(100'000, ']') + "}";
    expectProblem(post("sessions", deep), 400, ErrorKind::Usage, {"'name'"});
}

TEST_F(ApiOnSim, PlacedSurfaceIsSaid) {
    const Json placed = documentOf(
        post("sim/place", R"({"what":"mirror","tilt_x_deg":5,"tilt_y_deg":-2.5})"), "sim-place");
    EXPECT_EQ(placed["serial"], "SIM-0001");
    EXPECT_EQ(placed["placed"], "mirror");
    EXPECT_EQ(placed["tilt_x_deg"], 5);
    EXPECT_EQ(placed["tilt_y_deg"], -2.5);
    EXPECT_EQ(placed["backing"], "black");
    EXPECT_EQ(documentOf(get("status"), "status")["rig"]["placed"], "mirror");
    const Json wrong = documentOf(
        post(
            "sim/place",
            R"({"what":"model:lambert,albedo=0.5","waviness_deg":0.5,"translucency":0.1,"backing":"white",)"
            R"("softness":0.05,"ambient":0.001,"rig_errors":"typical"})"),
        "sim-place");
    EXPECT_EQ(wrong["waviness_deg"], 0.5);
    EXPECT_EQ(wrong["translucency"], 0.1);
    EXPECT_EQ(wrong["backing"], "white");
    EXPECT_EQ(wrong["softness"], 0.05);
    EXPECT_EQ(wrong["ambient"], 0.001);
    expectProblem(post("sim/place", R"({"what":"white","rig_errors":"blur"})"),
                  400,
                  ErrorKind::Usage,
                  {"'blur'", "glare"});
    expectProblem(post("sim/place", R"({"what":"model:lambret"})"), 400, ErrorKind::Usage);
    expectProblem(post("sim/place", R"({"what":"/none.bsdf"})"), 422, ErrorKind::File, {"/none"});
    expectProblem(post("sim/place", R"({"what":"none.bsdf"})"), 400, ErrorKind::Usage);
    EXPECT_EQ(documentOf(post("sim/place", R"({"what":"white","serial":"SIM-2"})"),
                         "sim-place")["serial"],
              "SIM-2");
}

TEST_F(ApiOnSim, SampleIsListedAndItsFilesGivenOut) {
    EXPECT_TRUE(documentOf(get("samples"), "samples")["samples"].empty());
    keepSample("tile");
    const Json list = documentOf(get("samples"), "samples")["samples"];
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0],
              (Json{{"name", "tile"}, {"rig", "R1"}, {"date", "today"}, {"session", nullptr}}))
        << "no path of the daemon's machine";
    const ApiReply file = get("samples/tile/file");
    EXPECT_EQ(file.status, 200);
    EXPECT_EQ(file.type, "application/octet-stream");
    EXPECT_TRUE(proc::decodeGonio(file.body, "tile"));
    EXPECT_EQ(get("samples/tile/raw").body, "raw bytes");
}

TEST_F(ApiOnSim, SampleIsExported) {
    keepSample("tile");
    const auto bytes = [&](proc::Format format, const std::vector<Band>& bands) {
        const auto opened =
            openConversion({.f = "sample:tile", .bands = {.bands = bands}}, folder.path());
        EXPECT_TRUE(opened);
        return proc::convertTo(opened->source, {.to = format})->front().bytes;
    };
    EXPECT_EQ(get("samples/tile/exports/zemax", {{"band", "g"}}).body,
              bytes(proc::Format::Zemax, {Band::G}));
    EXPECT_EQ(get("samples/tile/exports/bird").body, bytes(proc::Format::Bird, {}));
    EXPECT_TRUE(proc::decodeGonio(get("samples/tile/exports/gonio").body, "tile"));
    expectProblem(get("samples/tile/exports/zemax"), 400, ErrorKind::Usage, {"?band="});
    expectProblem(get("samples/tile/exports/zemax", {{"band", "x"}}), 400, ErrorKind::Usage);
    expectProblem(
        get("samples/tile/exports/csv", {{"band", "g"}}), 400, ErrorKind::Usage, {"all bands"});
    expectProblem(get("samples/tile/exports/doc"), 400, ErrorKind::Usage, {"doc"});
    expectProblem(get("samples/none/exports/csv"), 404, ErrorKind::File, {"none"});
}

TEST_F(ApiOnSim, IdsAreNamesNeverPaths) {
    keepSample("tile");
    for (const char* path : {"samples/../x/file",
                             "samples/x/../tile/file",
                             "samples//file",
                             "samples/tile/file/",
                             "samples/tile//file",
                             "samples/tile/../../../../etc/passwd",
                             "../v1/status"}) {
        expectProblem(get(path), 404, ErrorKind::Usage);
    }
    for (const char* name : {"..", ".", "..\\x", "tile'", "TILE", "%2e%2e", "*"}) {
        expectProblem(get(std::string("samples/") + name + "/file"), 404, ErrorKind::File);
    }
}

TEST_F(ApiOnSim, WhatIsNotThereIsNotFoundAndWhatIsNotDoneThereNotAllowed) {
    for (const char* path :
         {"", "/", "*", "/api", "/api/v1", "/api/v1/", "/api/v2/status", "status"}) {
        const ApiReply reply =
            call({.method = "GET", .path = path, .query = {}, .contentType = {}, .body = {}});
        expectProblem(reply, 404, ErrorKind::Usage);
    }
    expectProblem(get("status/"), 404, ErrorKind::Usage);
    expectProblem(post("status", "{}"), 405, ErrorKind::Usage, {"POST"});
    expectProblem(get("sim/place"), 405, ErrorKind::Usage);
    expectProblem(get("jobs/1/cancel"), 405, ErrorKind::Usage);
    for (const char* method : {"PUT", "PATCH", "DELETE", "HEAD", "", "get"}) {
        const ApiReply reply = call({.method = method,
                                     .path = "/api/v1/status",
                                     .query = {},
                                     .contentType = "application/json",
                                     .body = "{}"});
        expectProblem(reply, 405, ErrorKind::Usage);
    }
}

TEST_F(ApiOnSim, EveryChangeMustSayThatItIsJson) {
    // A form of a page of another origin cannot say so without being asked first.
    for (const ApiRoute& route : Api::routes()) {
        if (route.method != "POST") continue;
        for (const char* type : {"",
                                 "text/plain",
                                 "application/x-www-form-urlencoded",
                                 "multipart/form-data",
                                 "application/jsonp",
                                 "text/plain; application/json"}) {
            const ApiReply reply = call({.method = "POST",
                                         .path = std::string(route.path),
                                         .query = {},
                                         .contentType = type,
                                         .body = "{}"});
            expectProblem(reply, 415, ErrorKind::Usage, {"application/json"});
        }
    }
    const ApiReply withCharset = call({.method = "POST",
                                       .path = "/api/v1/sessions",
                                       .query = {},
                                       .contentType = "application/json; charset=utf-8",
                                       .body = "{}"});
    EXPECT_EQ(withCharset.status, 200);
}

class ApiOnUsb : public ApiCalls<ApiOnUsb> {
protected:
    test::TempFolder folder;
    test::TestPort port;
    std::optional<RunningEngine> running{std::in_place, folder.path(), port};

public:
    Engine* engine = &**running;
};

TEST_F(ApiOnUsb, NothingIsPlacedUnderARealRig) {
    expectProblem(post("sim/place", R"({"what":"white"})"), 400, ErrorKind::Usage, {"real"});
    EXPECT_EQ(documentOf(get("status"), "status")["rig"]["placed"], nullptr);
}

TEST_F(ApiOnUsb, WithoutARigItIsSaidWhy) {
    running.reset();
    port.refuse(Error{ErrorKind::Busy, "held by another program"});
    running.emplace(folder.path(), port);
    engine = &**running;
    ASSERT_TRUE(test::waitUntil([&] { return !engine->status().obstacle.empty(); }));
    const Json json = documentOf(get("status"), "status");
    EXPECT_EQ(json["rig"]["state"], "offline");
    EXPECT_EQ(json["rig"]["obstacle"], "held by another program");
    expectProblem(post("jobs", R"({"kind":"calibrate-mirror"})"),
                  409,
                  ErrorKind::Busy,
                  {"held by another program"});
}

TEST_F(ApiOnUsb, QuestionToAPersonIsInTheStatusAndAnswered) {
    port.mirrorPlacesItself = false;
    running->await(EngineState::Idle);
    const Json begun = documentOf(post("jobs", R"({"kind":"calibrate-mirror"})"), "job", 202);
    const std::string at = "jobs/" + std::to_string(begun["id"].get<std::int64_t>());
    const auto job = [&] { return documentOf(get("status"), "status")["job"]; };
    ASSERT_TRUE(test::waitUntil([&] { return job()["wanted"].is_string(); }));
    const Json first = job();
    const std::string answer = Json{{"question", first["question"]}}.dump();
    documentOf(post(at + "/proceed", answer), "job-wish", 202);
    ASSERT_TRUE(test::waitUntil([&] { return job()["wanted"] != first["wanted"]; }));
    ASSERT_TRUE(test::waitUntil([&] { return job()["wanted"].is_string(); }));
    expectProblem(post(at + "/proceed", answer), 409, ErrorKind::Usage, {"no longer asks"});
    documentOf(post(at + "/cancel", "{}"), "job-wish", 202);
    running->await(EngineState::Idle);
}

}  // namespace
}  // namespace gonio::daemon
