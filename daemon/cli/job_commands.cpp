// Commands that begin a job of the daemon's and follow it to its end: calibrate, verify-white,
// measure, recalibrate.

#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/cli/answer.h"
#include "daemon/cli/commands.h"
#include "daemon/cli/followed_job.h"
#include "daemon/cli/output.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/quality/verdict.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

std::string text(const Json& json, const char* member) { return json.at(member); }

std::string seconds(const Json& json, const char* member) {
    return fixed(json.at(member).get<double>(), 1) + " s";
}

std::string nameOf(Reference reference) {
    const char* names[] = {"mirror", "black", "white", "zero", "flat", "sensor", "leds", "dark"};
    return names[static_cast<int>(reference)];
}

/// The share that the lens spreads, k = 1.
std::string glareLine(const Json& done) {
    if (done.at("glare_share").is_null()) return "glare not known";
    return "glare " + fixed(100 * done.at("glare_share").get<double>(), 3) + " % (u " +
           fixed(100 * done.at("glare_u_share").get<double>(), 4) + " %)";
}

std::string withU(const Json& done, const std::string& member, int digits) {
    return fixed(done.at(member).get<double>(), digits) + " (u " +
           fixed(done.at("u_" + member).get<double>(), digits) + ")";
}

/// What was found out about the rig itself.
std::string foundLine(const Json& done, Reference reference) {
    switch (reference) {
        case Reference::Flat:
            return "pixels differ by " + perCent(done.at("spread").get<double>()) +
                   " (k = 1), each known to " + perCent(done.at("u_response").get<double>());
        case Reference::Sensor:
            return "gain " + withU(done, "electrons_per_dn", 3) + " electrons per DN, read noise " +
                   withU(done, "read_noise_electrons", 2) + " electrons, non-linearity " +
                   fixed(done.at("inl_percent").get<double>(), 3) + " % of the range, " +
                   fixed(done.at("left_percent").get<double>(), 3) + " % once it is corrected";
        case Reference::Leds: {
            std::string line = "light per kelvin of the LED board:";
            for (const auto& [band, fit] : done.at("bands").items())
                line += " " + band + " " + fixed(100 * fit.at("per_kelvin").get<double>(), 3) +
                        " % (u " + fixed(100 * fit.at("u_per_kelvin").get<double>(), 3) + " %)";
            return line;
        }
        default:
            return std::to_string(done.at("exposures").get<int>()) + " exposures, " +
                   std::to_string(done.at("frames").get<int>()) + " dark frames of each, " +
                   std::to_string(done.at("hot_pixels").get<int>()) + " hot pixels";
    }
}

std::string calibratedLine(const Json& done, Reference reference) {
    if (reference >= Reference::Flat) {
        return nameOf(reference) + " of " + text(done, "rig") + ": " + foundLine(done, reference) +
               "; " + seconds(done, "rig_seconds") + " on the rig";
    }
    if (reference == Reference::Mirror) {
        return "lens map of " + text(done, "rig") + ": " +
               std::to_string(done.at("spots").get<int>()) + " mirror spots, " +
               fixed(done.at("rms_px").get<double>(), 3) + " px rms, worst " +
               fixed(done.at("worst_px").get<double>(), 3) + " px; " + glareLine(done);
    }
    return nameOf(reference) + " reference of " + text(done, "rig") + ": " +
           std::to_string(done.at("states").get<int>()) + " states in " +
           seconds(done, "rig_seconds") + " on the rig";
}

std::string uncertaintyOf(const Json& done) {
    const Json& median = done.at("median_relative_uncertainty");
    if (!median.is_number()) return "none of them above 0";
    return "median uncertainty " + perCent(median.get<double>()) + " (k = 1)";
}

std::string measuredLine(const Json& done) {
    return text(done, "name") + ": " + std::to_string(done.at("measured_cells").get<int>()) +
           " BRDF samples, " + uncertaintyOf(done) + ", " + seconds(done, "rig_seconds") +
           " on the rig (planned " + fixed(done.at("planned").at("seconds").get<double>(), 1) +
           " s), " + seconds(done, "compute_seconds") + " computing; " + text(done, "file");
}

Json toJson(const CaptureGoal& goal) {
    if (goal.targetUncertainty) return {{"target_uncertainty", *goal.targetUncertainty}};
    if (goal.timeBudget) return {{"time_budget_s", goal.timeBudget->count()}};
    return {{"effort", std::string(name(goal.effort))}};
}

std::string percentOr(const Json& fraction) {
    return fraction.is_number() ? perCent(fraction.get<double>()) : "-";
}

/// "random, systematic, total" by rows of worst, 95th percentile and median.
std::vector<std::vector<std::string>> predictionRows(const Json& prediction) {
    std::vector<std::vector<std::string>> rows{{"", "median", "95 % of cells", "worst"}};
    for (const std::string part : {"random", "systematic", "total"}) {
        const Json& spread = prediction.at(part);
        rows.push_back({part,
                        percentOr(spread.at("median")),
                        percentOr(spread.at("p95")),
                        percentOr(spread.at("worst"))});
    }
    return rows;
}

void printPlan(const Json& plan) {
    const Json& seconds = plan.at("seconds");
    std::cout << text(plan, "goal") << ": " << fixed(seconds.at("total").get<double>(), 2)
              << " s on the rig (pilots " << fixed(seconds.at("pilot").get<double>(), 2)
              << ", dark frames " << fixed(seconds.at("dark").get<double>(), 2) << "), "
              << plan.at("frames").get<int>() << " frames of the sample; the least that physics "
              << "allows: " << fixed(plan.at("cramer_rao_seconds").get<double>(), 2) << " s\n"
              << "predicted uncertainty, k = 1, of " << plan.at("predicted").at("cells").get<int>()
              << " cells with f of at least 0.001 / sr:\n";
    printTable(predictionRows(plan.at("predicted")));
    for (const Json& note : plan.at("notes")) std::cout << note.get<std::string>() << "\n";
}

/// Of each verdict on a measured sample that is not good.
void warn(const Json& done) {
    for (const proc::Verdict& verdict : proc::readVerdicts(done.at("qc").dump())) {
        const bool bad =
            verdict.grade == proc::Grade::Warned || verdict.grade == proc::Grade::Refused;
        if (bad) log::warning(proc::described(verdict));
    }
}

std::string recalibratedLine(const Json& done) {
    const std::string with = text(done, "name") + " with calibration " + text(done, "calibration");
    if (done.at("identical").get<bool>()) return with + ": the same to the last bit";
    const Json& earlier = done.at("earlier");
    return with + " (was " + text(done, "before") + ")" +
           (earlier.is_string() ? "; the earlier one is " + earlier.get<std::string>() : "") +
           "; " + text(done, "file");
}

/// A sample's .gonio, unless the path is empty.
Result<void> copy(const DaemonClient& client,
                  const std::string& sample,
                  const std::filesystem::path& output) {
    if (output.empty()) return {};
    const auto bytes = client.get("/api/v1/samples/" + sample + "/file");
    if (!bytes) return bytes.error();
    return proc::writeFile(output, *bytes);
}

}  // namespace

Result<void> calibrate(const CommonOptions& common, Reference reference) {
    const std::string name = nameOf(reference);
    const DaemonClient client(common.socketPath());
    const Json request{{"kind", "calibrate-" + name}};
    const auto done = FollowedJob(common, client, name).run(request.dump());
    return shown(common, done, [&](const Json& json) {
        std::cout << calibratedLine(json, reference) << "\n";
    });
}

Result<void> verifyWhite(const CommonOptions& common, const VerifyOptions& options) {
    const DaemonClient client(common.socketPath());
    const Json request{
        {"kind", "verify-white"}, {"limit", options.limit}, {"turned", options.turned}};
    const auto done = FollowedJob(common, client, "white").run(request.dump());
    return shown(common, done, [&](const Json& json) {
        std::cout << "white has changed by at most "
                  << perCent(json.at("worst_change").get<double>()) << " since "
                  << text(json, "calibrated");
        if (json.at("turned").get<bool>()) {
            std::cout << "; turned, it differs from itself by "
                      << perCent(json.at("texture").get<double>()) << " (its certificate says "
                      << perCent(json.at("certified_per_direction").get<double>()) << ")";
        }
        std::cout << "\n";
    });
}

Result<void> measure(const CommonOptions& common, const MeasureOptions& options) {
    const DaemonClient client(common.socketPath());
    Json request{{"kind", "measure"},
                 {"name", options.name},
                 {"notes", options.notes},
                 {"force", options.force},
                 {"backing", options.backing.empty() ? Json() : Json(options.backing)},
                 {"against", options.against},
                 {"monte_carlo", options.monteCarlo},
                 {"rotation_deg", options.rotationDegrees}};
    request.update(toJson(options.goal));
    const auto done = FollowedJob(common, client, options.name)
                          .run(request.dump(-1, ' ', false, Json::error_handler_t::replace));
    if (!done) return done.error();
    if (Result<void> warned = understood(*done, warn); !warned) return warned;
    if (Result<void> copied = copy(client, options.name, options.output); !copied) return copied;
    return shown(common, done, [](const Json& json) { std::cout << measuredLine(json) << "\n"; });
}

Result<void> plan(const CommonOptions& common, const CaptureGoal& goal) {
    const DaemonClient client(common.socketPath());
    Json request{{"kind", "plan"}};
    request.update(toJson(goal));
    const auto done = FollowedJob(common, client, "plan").run(request.dump());
    return shown(common, done, printPlan);
}

Result<void> recalibrate(const CommonOptions& common, const RecalibrateOptions& options) {
    const DaemonClient client(common.socketPath());
    const Json request{{"kind", "recalibrate"},
                       {"name", options.name},
                       {"calibration", options.calibration},
                       {"monte_carlo", options.monteCarlo}};
    const auto done = FollowedJob(common, client, options.name).run(request.dump());
    if (!done) return done.error();
    if (Result<void> copied = copy(client, options.name, options.output); !copied) return copied;
    return shown(
        common, done, [](const Json& json) { std::cout << recalibratedLine(json) << "\n"; });
}

}  // namespace gonio::daemon
