// The documents of the API and of the programs are what docs/json says, and the API is what
// docs/api/openapi.json says. The documents of measurements are held against theirs where they are
// made: in measure_run_test.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "daemon/api/api.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/table/rotations.h"
#include "tests/daemon/cli/program.h"
#include "tests/daemon/engine/running_engine.h"
#include "tests/daemon/engine/test_rig.h"
#include "tests/formats/small_files.h"
#include "tests/support/error_kinds.h"
#include "tests/support/json_schema.h"
#include "tests/support/sample_sets.h"

namespace gonio::daemon {
namespace {

using test::complaintsOf;
using test::Json;
using test::JsonSchema;

const std::string kRealFile = GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf";

TEST(JsonSchema, SaysWhatDoesNotConform) {
    const JsonSchema wish("job-wish");
    const Json good{{"schema", "gonio/job-wish/1"}, {"id", 3}};
    EXPECT_EQ(wish.complaints(good), "");
    Json bad = good;
    bad["id"] = 0;
    EXPECT_NE(wish.complaints(bad), "") << "minimum";
    bad["id"] = "3";
    EXPECT_NE(wish.complaints(bad), "") << "type";
    bad = good;
    bad["also"] = 1;
    EXPECT_NE(wish.complaints(bad), "") << "additionalProperties";
    bad = good;
    bad.erase("id");
    EXPECT_NE(wish.complaints(bad), "") << "required";
    bad = good;
    bad["schema"] = "gonio/job-wish/2";
    EXPECT_NE(wish.complaints(bad), "") << "const";

    const JsonSchema jobs("jobs");
    Json job{{"id", 1},
             {"kind", "measure"},
             {"name", "a"},
             {"state", "done"},
             {"ended", nullptr},
             {"started", "2026-01-02T03:04:05Z"},
             {"problem", nullptr},
             {"message", nullptr},
             {"result", nullptr}};
    const auto listed = [](const Json& one) {
        return Json{{"schema", "gonio/jobs/1"}, {"jobs", {one}}};
    };
    EXPECT_EQ(jobs.complaints(listed(job)), "");
    job["started"] = "today";
    EXPECT_NE(jobs.complaints(listed(job)), "") << "$ref, items, pattern";
    job["started"] = "2026-01-02T03:04:05Z";
    job["state"] = "lost";
    EXPECT_NE(jobs.complaints(listed(job)), "") << "enum";
}

TEST(JsonSchemas, AreAllReadable) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(JsonSchema::folder())) {
        const JsonSchema schema(entry.path().stem().string());
        // Keywords that this test does not know would be passed over.
        EXPECT_EQ(schema.complaints(Json::object()).find("is not known"), std::string::npos);
        ++files;
    }
    EXPECT_GT(files, 20);
}

/// The API of a rig that asks a person, so that a job stands still.
class ApiDocuments : public testing::Test {
protected:
    void expectConforms(const std::string& method, const std::string& path, const Json& body = {}) {
        const Api api(*running);
        const ApiReply reply = api.handle({.method = method,
                                           .path = "/api/v1/" + path,
                                           .query = {},
                                           .contentType = "application/json",
                                           .body = body.is_null() ? "" : body.dump()});
        ASSERT_LT(reply.status, 300) << reply.body;
        last = Json::parse(reply.body);
        EXPECT_EQ(complaintsOf(last), "") << last;
    }
    test::TempFolder folder;
    test::TestPort port;
    test::RunningEngine running{folder.path(), port};
    Json last;
};

TEST_F(ApiDocuments, ConformWithAndWithoutAJobAndASession) {
    running.await(EngineState::Idle);
    expectConforms("GET", "status");
    expectConforms("GET", "rigs");
    for (const char* empty : {"jobs", "sessions", "samples"}) expectConforms("GET", empty);
    const Json session{{"name", "one"}, {"operator", "Ada"}, {"notes", "warm"}};
    EXPECT_EQ(JsonSchema("request-session").complaints(session), "");
    expectConforms("POST", "sessions", session);

    port.mirrorPlacesItself = false;
    const Json request{{"kind", "calibrate-mirror"}};
    EXPECT_EQ(JsonSchema("request-job").complaints(request), "");
    test::Watcher watcher(*running);
    expectConforms("POST", "jobs", request);
    watcher.until("operator");
    expectConforms("GET", "status");
    EXPECT_TRUE(last["job"]["wanted"].is_string());
    EXPECT_TRUE(last["session"].is_object());
    const Json answer{{"question", last["job"]["question"]}};
    EXPECT_EQ(JsonSchema("request-proceed").complaints(answer), "");
    expectConforms("GET", "jobs/1");
    expectConforms("POST", "jobs/1/proceed", answer);
    watcher.until("operator");
    expectConforms("POST", "jobs/1/cancel", Json::object());
    watcher.until("job", {{"state", "cancelled"}});
    expectConforms("GET", "jobs/1");
    expectConforms("GET", "jobs");
    expectConforms("POST", "sessions/close", Json::object());
    expectConforms("GET", "sessions");

    auto store = Store::open(folder.path());
    ASSERT_TRUE(store) << store.error().message;
    ASSERT_TRUE(
        store->addSample({.name = "tile", .rig = "R", .dateUtc = "t"}, {.file = "a", .raw = "b"}));
    expectConforms("GET", "samples");
}

TEST_F(ApiDocuments, ConformWithoutARig) {
    running.await(EngineState::Idle);
    port.cable.pull();
    running.await(EngineState::Offline);
    expectConforms("GET", "status");
}

TEST(ApiDocument, OfWhatLiesUnderTheSimulatedRigConforms) {
    const test::TempFolder folder;
    auto port = SimPort::open(folder.path());
    ASSERT_TRUE(port) << port.error().message;
    const test::RunningEngine running(folder.path(), **port);
    const Json request{{"what", "mirror"}, {"tilt_x_deg", 5}, {"seed", 7}};
    EXPECT_EQ(JsonSchema("request-sim-place").complaints(request), "");
    const ApiReply reply = Api(*running).handle({.method = "POST",
                                                 .path = "/api/v1/sim/place",
                                                 .query = {},
                                                 .contentType = "application/json",
                                                 .body = request.dump()});
    EXPECT_EQ(complaintsOf(Json::parse(reply.body)), "") << reply.body;
}

TEST(ProblemDocument, OfEveryKindConforms) {
    const JsonSchema schema("problem");
    for (const ErrorKind kind : test::kErrorKinds) {
        EXPECT_EQ(schema.complaints(Json::parse(problem({kind, "why"}).body)), "");
    }
}

/// Documents of commands on files.
class ProgramDocuments : public testing::Test {
protected:
    Json expectConforms(std::vector<std::string> arguments) {
        arguments.push_back("--json");
        const test::Ran ran = gonio(arguments);
        EXPECT_EQ(ran.exitCode, 0) << ran.err;
        Json json = Json::parse(ran.out, nullptr, false);
        EXPECT_TRUE(json.is_object()) << ran.out;
        EXPECT_EQ(complaintsOf(json), "") << json;
        return json;
    }
    std::string sampleFile(const std::string& truth) {
        auto set = test::sampleSet([](Radians, const Direction&) { return 0.5 / kPi; });
        set.info.truthSpec = truth;
        set.info.extra["seed"] = "7";
        set.info.budgetJson =
            R"([{"led":0,"band":"r","components":[{"name":"a","type":"A","correlation":"per cell",)"
            R"("median_relative":0.1}]}])";
        const std::string file = (gonio / "tile.gonio").string();
        EXPECT_TRUE(proc::writeGonio(file, set));
        return file;
    }
    test::Program gonio;
};

TEST_F(ProgramDocuments, OfInfoConformForEveryKindOfFile) {
    expectConforms({"info", "model:lambert,albedo=0.5"});
    expectConforms({"info", kRealFile});
    const Json asked =
        expectConforms({"info", kRealFile, "--estimator", "specular-log"})["estimator"];
    EXPECT_EQ(asked["between"], "specular-log");
    EXPECT_EQ(asked["candidates"].size(), 1U);
    expectConforms({"info", sampleFile("")});
    expectConforms({"info", sampleFile("model:lambert,albedo=0.5")});
    const auto raw = proc::encodeGraw(test::smallCapture());
    ASSERT_TRUE(raw) << raw.error().message;
    test::writeText(gonio / "tile.graw", *raw);
    expectConforms({"info", (gonio / "tile.graw").string()});
}

TEST_F(ProgramDocuments, OfWrittenFilesConform) {
    const std::string tile = sampleFile("");
    expectConforms({"convert", kRealFile, (gonio / "out.bsdf").string()});
    expectConforms({"convert", tile, (gonio / "out.csv").string()});
    const Json exported =
        expectConforms({"export", tile, "-o", (gonio / "out").string(), "--formats", "gonio,csv"});
    EXPECT_EQ(exported["files"].size(), 2U);
    expectConforms({"plot", "model:lambert,albedo=0.5", "-o", (gonio / "plots").string()});
}

TEST_F(ProgramDocuments, OfFitsConform) {
    const std::string tile = sampleFile("");
    const std::filesystem::path out = gonio / "fit";
    const Json fit =
        expectConforms({"fit", tile, "--models", "lambert,ggx,lambert+ggx", "-o", out.string()});
    EXPECT_EQ(fit["models"].size(), 3U);
    EXPECT_EQ(complaintsOf(Json::parse(test::textOf(out / "fit.json"))), "");
    for (const char* file : {"fit.md", "residuals.csv", "residuals.svg"}) {
        EXPECT_GT(test::textOf(out / file).size(), 100U) << file;
    }
    expectConforms({"fit", kRealFile, "--models", "lambert+ggx", "--robust", "huber:2"});
}

TEST_F(ProgramDocuments, OfTheDoctorConforms) {
    EXPECT_EQ(expectConforms({"doctor"})["findings"].size(), 7U);  // no rig is there
}

TEST_F(ProgramDocuments, OfTheTradeOfAcquisitionConforms) {
    const std::string folder = (gonio / "trade").string();
    const Json trade =
        expectConforms({"trade", "acquisition", "--quick", "--levels", "3", "-o", folder});
    ASSERT_EQ(trade["rows"].size(), 12U);  // two rigs, two materials, three wanted
    for (const Json& row : trade["rows"]) EXPECT_LE(row["random"]["worst"], row["wanted"]) << row;
    ASSERT_EQ(trade["files"].size(), 3U);
    const std::string csv = test::textOf(trade["files"][0].get<std::string>());
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
    EXPECT_EQ(gonio({"trade", "acquisition", "--levels", "4"}).exitCode, 2);
    EXPECT_EQ(gonio({"trade"}).exitCode, 2);
}

TEST_F(ProgramDocuments, OfMergedFilesConform) {
    auto set = test::sampleSet([](Radians, const Direction& wo) { return 0.5 + 0.1 * wo.x(); });
    set.leds.resize(2);
    std::vector<std::string> merge{"merge"};
    for (const char* rotation : {"0", "0", "90"}) {
        for (proc::LedTable& led : set.leds) {
            led.rotation = proc::rotationOf(std::stod(rotation));
            led.bands[0].f[100] += 0.01;
        }
        merge.push_back((gonio / (std::to_string(merge.size()) + ".gonio")).string());
        ASSERT_TRUE(proc::writeGonio(merge.back(), set));
    }
    const std::string out = (gonio / "merged.gonio").string();
    merge.insert(merge.end(), {"-o", out, "--plane", "--reciprocal"});
    const Json merged = expectConforms(merge);
    EXPECT_EQ(merged["how"], "rotations of repeats");
    EXPECT_EQ(merged["rotations_deg"], (std::vector<double>{0, 90}));
    EXPECT_EQ(expectConforms({"info", out})["leds"][3]["rotation_deg"], 90);

    // Three tables of one band each, told apart by their names.
    std::vector<std::string> bands{"merge"};
    for (const char* band : {"R", "G", "B"}) {
        bands.push_back((gonio / ("tile_" + std::string(band) + ".bsdf")).string());
        test::writeText(bands.back(), test::smallZemax());
    }
    bands.insert(bands.end(), {"-o", (gonio / "rgb.csv").string()});
    const Json channels = expectConforms(bands);
    EXPECT_EQ(channels["channels"]["g"]["estimated"], 0);
    EXPECT_EQ(channels["channels"]["b"]["partners"], channels["channels"]["r"]["partners"]);
    EXPECT_NE(test::textOf(gonio / "rgb.csv").find("f_r,f_g,f_b,flags_r"), std::string::npos);
    bands.back() = out;  // a .gonio wants uncertainties
    const test::Ran refused = gonio(bands);
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_NE(refused.err.find("-o OUT.csv"), std::string::npos) << refused.err;
}

TEST_F(ProgramDocuments, OfLossesConform) {
    auto set = test::sampleSet([](Radians, const Direction&) { return 0.5; });
    set.leds.resize(1);  // resampling a table of one incidence is quick
    const std::string file = (gonio / "one.gonio").string();
    ASSERT_TRUE(proc::writeGonio(file, set));
    const Json converted = expectConforms({"convert", file, (gonio / "one.bsdf").string()});
    ASSERT_EQ(converted["files"].size(), 3U);
    EXPECT_FALSE(converted["files"][0]["lost"].empty());
}

TEST_F(ProgramDocuments, OfScoresConform) {
    const std::string summary = (gonio / "summary.json").string();
    expectConforms({"sim", "score", sampleFile("model:lambert,albedo=0.5"), "-o", summary});
    const Json quickstart = Json::parse(test::textOf(summary));
    EXPECT_EQ(quickstart["schema"], "gonio/quickstart/1");
    EXPECT_EQ(complaintsOf(quickstart), "") << quickstart;
}

// ---- docs/api/openapi.json ----

Json openApi() { return Json::parse(test::textOf(GONIO_SOURCE_DIR "/docs/api/openapi.json")); }

TEST(OpenApi, HasExactlyTheRoutesOfTheApiAndTheEvents) {
    std::set<std::string> wanted{"GET /api/v1/events"};
    for (const ApiRoute& route : Api::routes()) {
        wanted.insert(std::string(route.method) + " " + std::string(route.path));
    }
    std::set<std::string> described;
    const std::regex name("\\{[^}]*\\}");
    const Json document = openApi();
    for (const auto& [path, item] : document["paths"].items()) {
        for (const auto& [method, operation] : item.items()) {
            std::string upper = method;
            std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) {
                return static_cast<char>(std::toupper(c));
            });
            described.insert(upper + " " + std::regex_replace(path, name, "*"));
        }
    }
    EXPECT_EQ(described, wanted);
}

TEST(OpenApi, NamesEveryEventThatTheEngineTellsAndTheDaemonsPageItsData) {
    const std::string described =
        openApi()["paths"]["/api/v1/events"]["get"]["responses"]["200"]["description"];
    const std::string page = test::textOf(GONIO_SOURCE_DIR "/docs/daemon.md");
    const std::regex told("tell\\(\\s*\"([a-z-]+)\"");
    std::set<std::string> types;
    for (const auto& file :
         std::filesystem::directory_iterator(GONIO_SOURCE_DIR "/daemon/engine")) {
        const std::string text = test::textOf(file.path());
        for (std::sregex_iterator i(text.begin(), text.end(), told), end; i != end; ++i)
            types.insert((*i)[1]);
    }
    EXPECT_EQ(types.size(), 10U);
    for (const std::string& type : types) {
        EXPECT_TRUE(std::regex_search(described, std::regex("\\b" + type + "\\b"))) << type;
        EXPECT_NE(page.find("\n| `" + type + "` |"), std::string::npos) << type;
    }
}

TEST(OpenApi, DescribesEveryNameOfAPathAndRefersToSchemasThatAreThere) {
    const Json document = openApi();
    EXPECT_EQ(document["openapi"], "3.1.0");
    const std::regex name("\\{([^}]*)\\}");
    std::set<std::string> ids;
    for (const auto& [path, item] : document["paths"].items()) {
        for (const auto& [method, operation] : item.items()) {
            EXPECT_TRUE(ids.insert(operation["operationId"]).second) << path;
            EXPECT_TRUE(operation["responses"].contains("default")) << path;
            EXPECT_EQ(operation.contains("requestBody"), method == "post") << path;
            std::set<std::string> inPath, described;
            for (std::sregex_iterator i(path.begin(), path.end(), name), end; i != end; ++i) {
                inPath.insert((*i)[1]);
            }
            for (const Json& one : operation.value("parameters", Json::array())) {
                if (one["in"] == "path") described.insert(one["name"]);
            }
            EXPECT_EQ(described, inPath) << path;
        }
    }
    const std::string text = document.dump();
    const std::regex reference("\"\\$ref\":\"\\.\\./json/([^\"]*)\"");
    for (std::sregex_iterator i(text.begin(), text.end(), reference), end; i != end; ++i) {
        EXPECT_TRUE(std::filesystem::exists(JsonSchema::folder() / (*i)[1].str())) << (*i)[1];
    }
}

}  // namespace
}  // namespace gonio::daemon
