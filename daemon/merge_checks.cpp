#include "daemon/merge_checks.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"

namespace gonio::daemon {
namespace {

std::vector<std::string> averagesOf(const MergeInput& input) {
    const auto found = input.sample->info.extra.find("averaged");
    std::vector<std::string> all;
    if (found == input.sample->info.extra.end()) return all;
    std::istringstream list(found->second);
    for (std::string one; std::getline(list, one, ',');) all.push_back(one);
    return all;
}

bool holds(const std::vector<std::string>& list, const std::string& one) {
    return std::find(list.begin(), list.end(), one) != list.end();
}

}  // namespace

Error mergeError(const std::string& what) { return {ErrorKind::Usage, "merge: " + what}; }

std::string quoted(const MergeInput& input) { return "'" + input.file + "'"; }

std::string degrees(Radians angle) { return shortest(proc::fileDegrees(angle)); }

Result<void> checkBands(std::span<const MergeInput> inputs) {
    for (const MergeInput& input : inputs) {
        if (input.band == inputs.front().band) continue;
        return mergeError(quoted(inputs.front()) + " and " + quoted(input) +
                          ": they do not hold the same bands; three files of one band each, of "
                          "R, G and B, become one");
    }
    return {};
}

Result<void> checkOrigins(std::span<const MergeInput> inputs, const MergeOptions& options) {
    const proc::SampleInfo& first = inputs.front().sample->info;
    for (const MergeInput& input : inputs) {
        const proc::SampleInfo& info = input.sample->info;
        const std::string both = quoted(inputs.front()) + " and " + quoted(input) + ": ";
        if (info.truthSpec != first.truthSpec) {
            return mergeError(both + "under the simulated rig lay '" + first.truthSpec + "' and '" +
                              info.truthSpec + "', which are not one sample; leave one out");
        }
        if (options.anyCalibration) continue;
        const bool rig = info.rigSerial != first.rigSerial;
        if (rig || info.referenceCertificate != first.referenceCertificate) {
            return mergeError(
                both +
                (rig ? "measured on the rigs " + first.rigSerial + " and " + info.rigSerial
                     : "calibrated by other references") +
                ", whose systematic errors differ; to merge them all the same: "
                "--any-calibration");
        }
    }
    return {};
}

Result<void> checkAverages(std::span<const MergeInput> inputs, const MergeOptions& options) {
    std::vector<std::string> asked;
    if (options.isotropic) asked.emplace_back("isotropic");
    if (options.plane) asked.emplace_back("plane");
    if (options.reciprocal) asked.emplace_back("reciprocal");
    for (const MergeInput& input : inputs) {
        const std::vector<std::string> done = averagesOf(input);
        for (const std::string& one : asked) {
            if (!holds(done, one)) continue;
            return mergeError(quoted(input) + ": it was averaged by --" + one +
                              " already, and its values are no longer independent; leave --" + one +
                              " out, or merge the files that it was made of");
        }
    }
    return {};
}

std::string averagesOf(std::span<const MergeInput> inputs) {
    std::vector<std::string> all;
    std::string text;
    for (const MergeInput& input : inputs) {
        for (const std::string& one : averagesOf(input)) {
            if (holds(all, one)) continue;
            all.push_back(one);
            text += (text.empty() ? "" : ",") + one;
        }
    }
    return text;
}

}  // namespace gonio::daemon
