#include "daemon/api/documents.h"

#include <nlohmann/json.hpp>

#include "daemon/problem.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json orNull(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json toJson(const driver::Status& rig) {
    return {{"interlock_closed", driver::interlock::mayLight(rig.interlock)},
            {"lit", rig.ledOn != 0},
            {"frames_made", rig.framesMade},
            {"uptime_s", static_cast<double>(rig.timeUs) * 1e-6},
            {"led_board_celsius", orNull(driver::celsius(rig.temperature[0]))},
            {"sensor_celsius", orNull(driver::celsius(rig.temperature[1]))},
            {"fault", rig.fault == 0 ? Json(nullptr) : Json(driver::statusName(rig.fault))}};
}

Json runningJob(const JobStatus& job) {
    Json json = daemon::toJson(job.record);
    json["step"] = job.step;
    json["steps"] = job.steps;
    json["what"] = orNull(job.what);
    json["question"] = job.question ? Json(job.question->number) : Json(nullptr);
    json["wanted"] = job.question ? Json(job.question->wanted) : Json(nullptr);
    json["elapsed_s"] = job.elapsed.count();
    json["left_s"] = job.left ? Json(job.left->count()) : Json(nullptr);
    json["interruptions"] = job.interruptions;
    return json;
}

}  // namespace

Json toJson(const EngineStatus& status) {
    Json calibrations = Json::object();
    for (const std::string_view kind : kCalibrationKinds) calibrations[kind] = nullptr;
    for (const CalibrationDate& one : status.calibrations) calibrations[one.kind] = one.dateUtc;
    Json rig = {{"kind", status.portKind},
                {"state", std::string(name(status.state))},
                {"serial", orNull(status.serial)},
                {"obstacle", orNull(status.obstacle)},
                {"placed", orNull(status.placed)}};
    if (status.rig) rig.update(toJson(*status.rig));
    return {{"rig", rig},
            {"job", status.job ? runningJob(*status.job) : Json(nullptr)},
            {"session", status.session ? toJson(*status.session) : Json(nullptr)},
            {"calibrations", calibrations}};
}

Json toJson(const JobRecord& job) {
    Json json{{"id", job.id},
              {"kind", job.kind},
              {"name", orNull(job.name)},
              {"state", std::string(name(job.state))},
              {"started", job.startedUtc},
              {"ended", orNull(job.endedUtc)},
              {"problem", job.error ? Json(problemName(job.error->kind)) : Json(nullptr)},
              {"message", job.error ? Json(job.error->message) : Json(nullptr)}};
    const Json result = Json::parse(job.result, nullptr, false);
    json["result"] = result.is_discarded() ? Json(nullptr) : result;
    return json;
}

Json toJson(const SessionRecord& session) {
    return {{"id", session.id},
            {"name", session.name},
            {"operator", orNull(session.operatorName)},
            {"notes", orNull(session.notes)},
            {"opened", session.openedUtc},
            {"closed", orNull(session.closedUtc)}};
}

Json toJson(const RigListing& rig) {
    return {{"kind", rig.kind},
            {"serial", orNull(rig.serial)},
            {"place", orNull(rig.place)},
            {"protocol", orNull(rig.protocol)},
            {"obstacle", orNull(rig.obstacle)}};
}

Json toJson(const SampleRecord& sample) {
    return {{"name", sample.name},
            {"rig", sample.rig},
            {"date", sample.dateUtc},
            {"session", orNull(sample.session)}};
}

Json toJson(const Finding& finding) {
    return {{"rig", orNull(finding.rig)},
            {"subject", finding.subject},
            {"verdict", std::string(name(finding.verdict))},
            {"seen", finding.seen},
            {"cure", orNull(finding.cure)}};
}

Json toJson(const CalibrationRecord& calibration, const std::string& whyNot) {
    return {{"id", calibration.id},
            {"rig", calibration.rig},
            {"kind", calibration.kind},
            {"date", calibration.dateUtc},
            {"profile", orNull(calibration.profileHash)},
            {"led_board_celsius", orNull(calibration.celsius)},
            {"why_not", orNull(whyNot)}};
}

std::string document(const std::string& name, const Json& content) {
    Json json{{"schema", "gonio/" + name + "/1"}};
    json.update(content);
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gonio::daemon
