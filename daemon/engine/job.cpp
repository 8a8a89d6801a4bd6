#include "daemon/engine/job.h"

#include <array>
#include <cmath>

#include "proc/core/number_text.h"
#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

constexpr std::array<std::string_view, 12> kKinds{"calibrate-mirror",
                                                  "calibrate-black",
                                                  "calibrate-white",
                                                  "calibrate-zero",
                                                  "calibrate-flat",
                                                  "calibrate-sensor",
                                                  "calibrate-leds",
                                                  "calibrate-dark",
                                                  "verify-white",
                                                  "measure",
                                                  "plan",
                                                  "recalibrate"};
constexpr std::size_t kLongestNotes = 4096;
constexpr int kFewestDraws = 100, kMostDraws = 100'000;

Result<void> checkBacking(const JobRequest& request) {
    if (!request.backing && request.against.empty()) return {};
    if (request.kind != JobKind::Measure) {
        return Error{ErrorKind::Usage, "backing, against: only measure has them"};
    }
    if (request.against.empty()) return {};
    if (!request.backing) {
        return Error{ErrorKind::Usage,
                     "against '" + request.against + "': say on which backing the sample lies now"};
    }
    return checkSampleName(request.against);
}

}  // namespace

std::string_view name(JobKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

Result<JobKind> parseJobKind(std::string_view text) {
    std::string list;
    for (std::size_t i = 0; i < kKinds.size(); ++i) {
        if (kKinds[i] == text) return static_cast<JobKind>(i);
        list += (i == 0 ? "" : ", ") + std::string(kKinds[i]);
    }
    return Error{ErrorKind::Usage, "job '" + std::string(text) + "': wanted one of " + list};
}

Result<Radians> parseRotation(double degrees) {
    if (std::abs(degrees) <= 360) return proc::rotationOf(degrees);
    return Error{ErrorKind::Usage,
                 "rotation: " + shortest(degrees) + ", wanted -360 to 360 degrees"};
}

Result<void> check(const JobRequest& request) {
    const bool ofSample = request.kind == JobKind::Measure || request.kind == JobKind::Recalibrate;
    if (ofSample) {
        if (Result<void> good = checkSampleName(request.name); !good) return good;
    } else if (!request.name.empty()) {
        return Error{ErrorKind::Usage,
                     "name '" + request.name + "': only measure and recalibrate have one"};
    }
    if (Result<void> good = checkBacking(request); !good) return good;
    if (request.rotation != Radians() && request.kind != JobKind::Measure) {
        return Error{ErrorKind::Usage, "rotation: only measure has it"};
    }
    if (request.notes.size() > kLongestNotes) {
        return Error{ErrorKind::Usage, "notes: more than 4096 bytes"};
    }
    if (request.monteCarlo != 0 && !ofSample) {
        return Error{ErrorKind::Usage, "monte-carlo: only measure and recalibrate have it"};
    }
    if (request.monteCarlo != 0 &&
        (request.monteCarlo < kFewestDraws || request.monteCarlo > kMostDraws)) {
        return Error{ErrorKind::Usage, "monte-carlo: wanted 100 to 100000 draws for each cell"};
    }
    if (Result<void> good = request.goal.check(); !good) return good;
    if (request.kind == JobKind::VerifyWhite && !(request.limit > 0 && request.limit <= 1)) {
        return Error{ErrorKind::Usage, "limit: wanted above 0 and at most 1 (100 %)"};
    }
    return {};
}

}  // namespace gonio::daemon
