// Which job is whose.

#include <nlohmann/json.hpp>

#include "daemon/engine/interruption_text.h"
#include "daemon/engine/reference_jobs.h"
#include "daemon/engine/rig_jobs.h"
#include "daemon/engine/sample_jobs.h"
#include "daemon/engine/verify_white_job.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Result<Json> documentOf(const JobRun& run, JobKind kind) {
    switch (kind) {
        case JobKind::CalibrateMirror: return calibrateMirror(run);
        case JobKind::CalibrateBlack: return calibrateTile(run, "black");
        case JobKind::CalibrateWhite: return calibrateTile(run, "white");
        case JobKind::CalibrateZero: return calibrateTile(run, "zero");
        case JobKind::CalibrateFlat: return calibrateFlat(run);
        case JobKind::CalibrateSensor: return calibrateSensor(run);
        case JobKind::CalibrateLeds: return calibrateLeds(run);
        case JobKind::CalibrateDark: return calibrateDark(run);
        case JobKind::VerifyWhite: return verifyWhite(run);
        case JobKind::Measure: return measure(run);
        case JobKind::Plan: return plan(run);
        case JobKind::Recalibrate: break;  // needs no rig
    }
    return Error{ErrorKind::Internal, "no such job"};
}

}  // namespace

Result<std::string> runJob(const JobBench& bench, const JobRequest& request) {
    const JobRun run(bench, request);
    Result<Json> document = documentOf(run, request.kind);
    if (!document) return document.error();
    for (const driver::Interruption& one : bench.monitor.interruptions())
        (*document)["interruptions"].push_back(toJson(one));
    return document->dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gonio::daemon
