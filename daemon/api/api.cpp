#include "daemon/api/api.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/api/documents.h"
#include "daemon/conversion_input.h"
#include "daemon/problem.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kJobsListed = 100;
constexpr int kAccepted = 202;
constexpr int kNotFound = 404;
constexpr int kMethodNotAllowed = 405;
constexpr int kConflict = 409;
constexpr int kUnsupportedType = 415;
constexpr int kUnprocessable = 422;

int httpStatus(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::Internal: return 500;
        case ErrorKind::Usage: return 400;
        case ErrorKind::NoRig: return 503;
        case ErrorKind::Busy: return 409;
        case ErrorKind::Device: return 502;
        case ErrorKind::File: return 500;  // the store, or the disk under it
        case ErrorKind::Quality: return 422;
        case ErrorKind::Interrupted: return 409;
    }
    return 500;
}

ApiReply misused(int status, const std::string& detail) {
    return problem({ErrorKind::Usage, detail}, status);
}

/// Members of a request's body; remembers the first that is of the wrong kind.
class Fields {
public:
    explicit Fields(const std::string& body) {
        json_ = body.empty() ? Json::object() : Json::parse(body, nullptr, false);
        if (!json_.is_object()) complain("the body is not a JSON object");
    }
    std::string text(const std::string& name, bool needed = false) {
        return take<std::string>(name, &Json::is_string, "a text", needed).value_or("");
    }
    std::optional<double> number(const std::string& name) {
        return take<double>(name, &Json::is_number, "a number", false);
    }
    std::optional<std::uint64_t> whole(const std::string& name, bool needed = false) {
        return take<std::uint64_t>(name, &Json::is_number_unsigned, "a whole number", needed);
    }
    bool flag(const std::string& name) {
        return take<bool>(name, &Json::is_boolean, "true or false", false).value_or(false);
    }
    std::optional<std::string> optionalText(const std::string& name) {
        return take<std::string>(name, &Json::is_string, "a text", false);
    }
    /// Of a body that was read whole: what nobody asked for is a mistake of the sender.
    [[nodiscard]] Result<void> verdict() const {
        if (!wrong_.empty()) return Error{ErrorKind::Usage, wrong_};
        for (const auto& [name, value] : json_.items()) {
            if (!known_.contains(name)) {
                return Error{ErrorKind::Usage, "unknown member '" + name + "'"};
            }
        }
        return {};
    }

private:
    template <class T>
    std::optional<T> take(const std::string& name,
                          bool (Json::*fits)() const,
                          const std::string& wanted,
                          bool needed) {
        known_.emplace(name, true);
        if (!json_.is_object()) return std::nullopt;
        const auto found = json_.find(name);
        const bool absent = found == json_.end() || found->is_null();
        if (absent && !needed) return std::nullopt;
        if (absent || !((*found).*fits)()) {
            complain("member '" + name + "': wanted " + wanted);
            return std::nullopt;
        }
        return found->template get<T>();
    }
    void complain(const std::string& what) {
        if (wrong_.empty()) wrong_ = what;
    }
    Json json_;
    std::map<std::string, bool> known_;
    std::string wrong_;
};

/// A body that has nothing to say: empty, or an object without members.
Result<void> nothingIn(const std::string& body) { return Fields(body).verdict(); }

struct Call {
    Engine& engine;
    const ApiRequest& request;
    std::vector<std::string> names;  ///< what stood where the route has a '*'
};

using Handler = Result<ApiReply> (*)(const Call&);

ApiReply reply(const std::string& schema, const Json& content, int status = 200) {
    return {.status = status, .body = document(schema, content)};
}

template <class Record>
Json listed(const std::vector<Record>& records) {
    Json list = Json::array();
    for (const Record& record : records) list.push_back(toJson(record));
    return list;
}

/// What is kept is read over a connection of the reader's own; the writer is not disturbed.
Result<Store> reading(const Call& call) { return Store::openToRead(call.engine.storeRoot()); }
Result<Logbook> logbook(const Call& call) { return Logbook::openToRead(call.engine.storeRoot()); }

Result<std::int64_t> jobNumber(const Call& call) {
    const auto number = parseInteger(call.names.front());
    if (!number) return Error{ErrorKind::Usage, "job '" + call.names.front() + "': not a number"};
    return *number;
}

// ---- what there is ----

Result<ApiReply> getStatus(const Call& call) {
    Json json = toJson(call.engine.status());
    json["daemon"] = {{"version", GONIO_VERSION},
                      {"pid", ::getpid()},
                      {"store", call.engine.storeRoot().string()},
                      {"profile", call.engine.profile().name},
                      {"newest_event", call.engine.events().newest()}};
    return reply("status", std::move(json));
}

Result<ApiReply> getRigs(const Call& call) {
    const auto rigs = call.engine.rigs();
    if (!rigs) return rigs.error();
    return reply("rigs", {{"rigs", listed(*rigs)}});
}

Result<ApiReply> doctorSays(Engine& engine, bool handsOff) {
    auto findings = engine.examine(handsOff);
    if (!findings) return findings.error();
    for (Finding& one : *findings) one.rig = engine.status().serial;
    return reply("doctor", {{"findings", listed(*findings)}});
}

Result<ApiReply> getDoctor(const Call& call) { return doctorSays(call.engine, true); }

/// A visit exposes frames, and may take as long as a rig that does not answer lets it.
Result<ApiReply> postDoctor(const Call& call) {
    if (Result<void> good = nothingIn(call.request.body); !good) return good.error();
    return doctorSays(call.engine, false);
}

Result<ApiReply> getSamples(const Call& call) {
    Result<Store> store = reading(call);
    if (!store) return store.error();
    const auto samples = store->samples();
    if (!samples) return samples.error();
    return reply("samples", {{"samples", listed(*samples)}});
}

/// What `use` makes of the sample that the path names.
template <class Use>
Result<ApiReply> withSample(const Call& call, Use use) {
    Result<Store> store = reading(call);
    if (!store) return store.error();
    const auto sample = store->find(call.names.front());
    if (!sample) return sample.error();
    if (!*sample) return problem(store->noSample(call.names.front()), kNotFound);
    return use(**sample);
}

Result<ApiReply> fileReply(const std::filesystem::path& file, const std::string& type) {
    Result<std::string> bytes = proc::readFile(file);
    if (!bytes) return bytes.error();
    return ApiReply{.type = type, .body = std::move(*bytes)};
}

constexpr const char* kBytes = "application/octet-stream";

Result<ApiReply> getSampleFile(const Call& call) {
    return withSample(call, [](const SampleRecord& it) { return fileReply(it.file, kBytes); });
}

Result<ApiReply> getSampleRaw(const Call& call) {
    return withSample(call, [](const SampleRecord& it) { return fileReply(it.raw, kBytes); });
}

/// The band that ?band= names, which a format with one file for each needs, and no other takes.
Result<std::vector<Band>> wantedBands(const Call& call, proc::Format format) {
    const auto asked = call.request.query.find("band");
    const bool one = format == proc::Format::Zemax;
    if (asked == call.request.query.end() && !one) return std::vector<Band>();
    if (!one) {
        return Error{ErrorKind::Usage,
                     std::string(name(format)) + " holds all bands: ?band= is not for it"};
    }
    for (Band band : kBands) {
        if (asked != call.request.query.end() && letter(band) == asked->second) {
            return std::vector{band};
        }
    }
    return Error{ErrorKind::Usage, "zemax holds one band: wanted ?band=r, g or b"};
}

Result<ApiReply> getSampleExport(const Call& call) {
    const auto format = proc::parseFormat(call.names.back());
    if (!format) return format.error();
    auto bands = wantedBands(call, *format);
    if (!bands) return bands.error();
    return withSample(call, [&](const SampleRecord& it) -> Result<ApiReply> {
        const auto opened = openConversion({.f = it.file.string(), .bands = {.bands = *bands}}, {});
        if (!opened) return opened.error();
        auto files = proc::convertTo(opened->source, {.to = *format});
        if (!files) return files.error();
        if (files->size() != 1) {
            return Error{ErrorKind::Usage,
                         std::string(name(*format)) +
                             " takes several files of this sample: gonio "
                             "convert sample:NAME writes them"};
        }
        return ApiReply{.type = kBytes, .body = std::move(files->front().bytes)};
    });
}

Result<ApiReply> getJobs(const Call& call) {
    Result<Logbook> book = logbook(call);
    if (!book) return book.error();
    const auto jobs = book->jobs(kJobsListed);
    if (!jobs) return jobs.error();
    return reply("jobs", {{"jobs", listed(*jobs)}});
}

Result<ApiReply> getJob(const Call& call) {
    const auto number = jobNumber(call);
    if (!number) return number.error();
    Result<Logbook> book = logbook(call);
    if (!book) return book.error();
    const auto job = book->job(*number);
    if (!job && job.error().kind == ErrorKind::Usage) return problem(job.error(), kNotFound);
    if (!job) return job.error();
    return reply("job", toJson(*job));
}

/// Each with why it is not good for the rig as it is now.
Result<ApiReply> getCalibrations(const Call& call) {
    Result<Store> store = reading(call);
    if (!store) return store.error();
    const auto calibrations = store->calibrations();
    if (!calibrations) return calibrations.error();
    RigNow now = call.engine.rigNow();
    now.profileHash = measuredProfile(*store, call.engine.profile(), now).hash;
    Json list = Json::array();
    for (const CalibrationRecord& one : *calibrations) {
        list.push_back(toJson(one, whyNot(one, now, call.engine.profile().validity)));
    }
    return reply("calibrations", {{"calibrations", std::move(list)}});
}

Result<ApiReply> getSessions(const Call& call) {
    Result<Logbook> book = logbook(call);
    if (!book) return book.error();
    const auto sessions = book->sessions();
    if (!sessions) return sessions.error();
    return reply("sessions", {{"sessions", listed(*sessions)}});
}

// ---- what is done ----

Result<ApiReply> postJob(const Call& call) {
    Fields fields(call.request.body);
    const Result<JobKind> kind = parseJobKind(fields.text("kind", true));
    const std::optional<std::string> effortName = fields.optionalText("effort");
    const std::optional<std::string> backingName = fields.optionalText("backing");
    JobRequest job{.name = fields.text("name"),
                   .notes = fields.text("notes"),
                   .turned = fields.flag("turned"),
                   .force = fields.flag("force"),
                   .calibration = fields.text("calibration"),
                   .against = fields.text("against")};
    job.limit = fields.number("limit").value_or(job.limit);
    const double draws = fields.number("monte_carlo").value_or(0);
    const double rotation = fields.number("rotation_deg").value_or(0);
    const std::optional<double> target = fields.number("target_uncertainty");
    const std::optional<double> budget = fields.number("time_budget_s");
    if (Result<void> good = fields.verdict(); !good) return good.error();
    if (!kind) return kind.error();
    job.kind = *kind;
    if (draws != std::floor(draws) || std::abs(draws) > 1e9) {
        return Error{ErrorKind::Usage, "monte_carlo: wanted a whole number"};
    }
    job.monteCarlo = static_cast<int>(draws);
    const Result<Radians> turned = parseRotation(rotation);
    if (!turned) return turned.error();
    job.rotation = *turned;
    if (effortName) {
        const Result<Effort> effort = parseEffort(*effortName);
        if (!effort) return effort.error();
        job.goal.effort = *effort;
    }
    job.goal.targetUncertainty = target;
    if (budget) job.goal.timeBudget = Seconds(*budget);
    if (backingName) {
        const Result<proc::Backing> backing = proc::parseBacking(*backingName);
        if (!backing) return backing.error();
        job.backing = *backing;
    }
    const Result<JobRecord> begun = call.engine.submit(job);
    if (!begun) return begun.error();
    return reply("job", toJson(*begun), kAccepted);
}

/// A job that is not the running one, or does not ask this, was so a moment ago.
ApiReply wished(std::int64_t job, const Result<void>& done) {
    if (!done) return problem(done.error(), kConflict);
    return reply("job-wish", {{"id", job}}, kAccepted);
}

Result<ApiReply> postCancel(const Call& call) {
    const auto number = jobNumber(call);
    if (!number) return number.error();
    if (Result<void> good = nothingIn(call.request.body); !good) return good.error();
    return wished(*number, call.engine.cancel(*number));
}

Result<ApiReply> postProceed(const Call& call) {
    const auto number = jobNumber(call);
    if (!number) return number.error();
    Fields fields(call.request.body);
    const std::uint64_t question = fields.whole("question", true).value_or(0);
    if (Result<void> good = fields.verdict(); !good) return good.error();
    return wished(*number, call.engine.proceed(*number, question));
}

Result<ApiReply> postSession(const Call& call) {
    Fields fields(call.request.body);
    const SessionRecord session{.name = fields.text("name"),
                                .operatorName = fields.text("operator"),
                                .notes = fields.text("notes")};
    if (Result<void> good = fields.verdict(); !good) return good.error();
    const auto opened = call.engine.openSession(session);
    if (!opened) return opened.error();
    return reply("session", toJson(*opened));
}

Result<ApiReply> postSessionClose(const Call& call) {
    if (Result<void> good = nothingIn(call.request.body); !good) return good.error();
    const auto closed = call.engine.closeSession();
    if (!closed) return closed.error();
    return reply("session", toJson(*closed));
}

Result<ApiReply> postPlace(const Call& call) {
    Fields fields(call.request.body);
    const PlaceRequest place{.what = fields.text("what", true),
                             .tiltXDegrees = fields.number("tilt_x_deg").value_or(0),
                             .tiltYDegrees = fields.number("tilt_y_deg").value_or(0),
                             .wavinessDegrees = fields.number("waviness_deg").value_or(0),
                             .translucency = fields.number("translucency").value_or(0),
                             .backing = fields.optionalText("backing").value_or("black"),
                             .softness = fields.number("softness").value_or(0),
                             .ambient = fields.number("ambient").value_or(0),
                             .turnedDegrees = fields.number("turned_deg").value_or(0),
                             .seed = fields.whole("seed"),
                             .serial = fields.optionalText("serial"),
                             .systematic = fields.optionalText("systematic"),
                             .rigErrors = fields.optionalText("rig_errors")};
    if (Result<void> good = fields.verdict(); !good) return good.error();
    if (Result<void> done = call.engine.place(place); !done) {
        // A file that is not there, or no BRDF: the request's fault, not the store's.
        const bool named = done.error().kind == ErrorKind::File;
        return named ? Result<ApiReply>(problem(done.error(), kUnprocessable)) : done.error();
    }
    return reply("sim-place",
                 {{"serial", call.engine.status().serial},
                  {"placed", place.what},
                  {"tilt_x_deg", place.tiltXDegrees},
                  {"tilt_y_deg", place.tiltYDegrees},
                  {"waviness_deg", place.wavinessDegrees},
                  {"translucency", place.translucency},
                  {"backing", place.backing},
                  {"softness", place.softness},
                  {"ambient", place.ambient},
                  {"turned_deg", place.turnedDegrees}});
}

struct Route {
    std::string_view method;
    std::string_view path;  ///< '*' stands for one name
    Handler handler;
};

constexpr std::array kRoutes{
    Route{"GET", "/api/v1/status", getStatus},
    Route{"GET", "/api/v1/rigs", getRigs},
    Route{"GET", "/api/v1/doctor", getDoctor},
    Route{"POST", "/api/v1/doctor", postDoctor},
    Route{"GET", "/api/v1/sessions", getSessions},
    Route{"POST", "/api/v1/sessions", postSession},
    Route{"POST", "/api/v1/sessions/close", postSessionClose},
    Route{"GET", "/api/v1/jobs", getJobs},
    Route{"POST", "/api/v1/jobs", postJob},
    Route{"GET", "/api/v1/jobs/*", getJob},
    Route{"POST", "/api/v1/jobs/*/cancel", postCancel},
    Route{"POST", "/api/v1/jobs/*/proceed", postProceed},
    Route{"GET", "/api/v1/calibrations", getCalibrations},
    Route{"GET", "/api/v1/samples", getSamples},
    Route{"GET", "/api/v1/samples/*/file", getSampleFile},
    Route{"GET", "/api/v1/samples/*/raw", getSampleRaw},
    Route{"GET", "/api/v1/samples/*/exports/*", getSampleExport},
    Route{"POST", "/api/v1/sim/place", postPlace},
};

std::vector<std::string_view> parts(std::string_view path) {
    std::vector<std::string_view> list;
    while (!path.empty()) {
        const std::size_t slash = path.find('/', 1);
        list.push_back(path.substr(0, slash));
        path = slash == std::string_view::npos ? std::string_view() : path.substr(slash);
    }
    return list;
}

/// The names of a path that fits the pattern.
std::optional<std::vector<std::string>> match(std::string_view pattern, std::string_view path) {
    const auto wanted = parts(pattern);
    const auto seen = parts(path);
    if (wanted.size() != seen.size()) return std::nullopt;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (wanted[i] == "/*" && seen[i].size() > 1) {
            names.emplace_back(seen[i].substr(1));
        } else if (wanted[i] != seen[i]) {
            return std::nullopt;
        }
    }
    return names;
}

bool saysJson(const std::string& contentType) {
    return contentType.substr(0, contentType.find(';')) == "application/json";
}

}  // namespace

ApiReply problem(const Error& error, std::optional<int> status) {
    const std::string type(problemName(error.kind));
    const int code = status.value_or(httpStatus(error.kind));
    const Json json{{"type", "urn:gonio:problem:" + type},
                    {"title", type},
                    {"status", code},
                    {"detail", error.message}};
    return {.status = code,
            .type = "application/problem+json",
            .body = json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

std::vector<ApiRoute> Api::routes() {
    std::vector<ApiRoute> list;
    list.reserve(kRoutes.size());
    for (const Route& route : kRoutes) list.push_back({route.method, route.path});
    return list;
}

ApiReply Api::handle(const ApiRequest& request) const {
    bool known = false;
    for (const Route& route : kRoutes) {
        auto names = match(route.path, request.path);
        if (!names) continue;
        known = true;
        if (route.method != request.method) continue;
        if (request.method == "POST" && !saysJson(request.contentType)) {
            return misused(kUnsupportedType, "wanted Content-Type: application/json");
        }
        const Result<ApiReply> answer = route.handler({engine_, request, std::move(*names)});
        return answer ? *answer : problem(answer.error());
    }
    if (known) return misused(kMethodNotAllowed, request.method + ": not here");
    return misused(kNotFound, request.path + ": there is no such thing");
}

}  // namespace gonio::daemon
