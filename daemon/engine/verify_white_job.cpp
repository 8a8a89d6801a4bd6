#include "daemon/engine/verify_white_job.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/engine/reference_capture.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

// A mean over all cells is asked for: one frame is plenty.
constexpr BracketPlan kVerifyBracket{.frames = 1, .dim = false, .longest = 2, .first = 2};
constexpr int kDarkFrames = 4;

/// Median over the cells of how bright it is now over how bright it was.
double medianRatio(const proc::CellSignal& now, const proc::CellSignal& then) {
    std::vector<double> ratios;
    for (std::size_t cell = 0; cell < now.size(); ++cell) {
        if (now.present(cell) && then.present(cell) && then.signal[cell] > 0) {
            ratios.push_back(now.signal[cell] / then.signal[cell]);
        }
    }
    return ratios.empty() ? std::nan("") : median(std::move(ratios));
}

/// How far the cells differ from their median ratio beyond their noise: root mean square over the
/// cells, as of one of the two placements.
double textureOf(const proc::CellSignal& now, const proc::CellSignal& then, double ratio) {
    double sum = 0, cells = 0;
    for (std::size_t cell = 0; cell < now.size(); ++cell) {
        if (!now.present(cell) || !then.present(cell) || !(then.signal[cell] > 0)) continue;
        const double own = now.signal[cell] / then.signal[cell] / ratio - 1;
        const double noise = now.variance[cell] / std::pow(now.signal[cell], 2) +
                             then.variance[cell] / std::pow(then.signal[cell], 2);
        sum += own * own - noise;
        cells += 1;
    }
    return std::sqrt(std::max(sum, 0.0) / (2 * cells));
}

struct Largest {
    double value = 0;
    std::string state;

    void see(double one, const std::string& of) {
        if (one <= value) return;
        value = one;
        state = of;
    }
};

/// Quality error for a white that is not what it was, or, turned about its normal, not like itself.
Result<void> checkWhiteAgain(const JobRun& run,
                             const Largest& change,
                             const Largest& texture,
                             double perDirection) {
    constexpr double kSigmas = 2;
    const double limit = run.request().limit;
    if (change.value > limit) {
        return Error{ErrorKind::Quality,
                     change.state + ": white has changed by " + fixed(100 * change.value, 2) +
                         " % since it was calibrated, at most " + fixed(100 * limit, 2) +
                         " % was allowed; clean it, wait for the rig to warm up, or run: gonio "
                         "calibrate white"};
    }
    if (!run.request().turned || texture.value <= kSigmas * perDirection) return {};
    return Error{ErrorKind::Quality,
                 texture.state + ": turned, the white differs from itself by " +
                     fixed(100 * texture.value, 2) + " % (rms over the directions), and its " +
                     "certificate allows " + fixed(100 * perDirection, 2) +
                     " % per direction; it has a grain, or is stained: take another white"};
}

}  // namespace

Result<Json> verifyWhite(const JobRun& run) {
    if (Result<void> placed = run.expectPlaced("white"); !placed) return placed.error();
    const Result<View> view = newestView(run);
    if (!view) return view.error();
    const Result<ReferenceRecord> white = storedReference(run, "white", *view);
    if (!white) return white.error();
    const Result<Captured> captured = captureReference(run, *view, kVerifyBracket, kDarkFrames);
    if (!captured) return captured.error();
    Json states = Json::array();
    Largest change, texture;
    for (std::size_t led = 0; led < run.leds(); ++led) {
        for (const Band band : kBands) {
            const proc::CellSignal& now = captured->signals[led][index(band)];
            const proc::CellSignal& then = white->signals[led][index(band)];
            const std::string state = stateName({static_cast<int>(led), band});
            const double ratio = medianRatio(now, then);
            if (std::isnan(ratio)) {
                return Error{ErrorKind::Quality,
                             state + ": no cell was seen both now and when white was calibrated"};
            }
            change.see(std::abs(ratio - 1), state);
            const double grain = textureOf(now, then, ratio);
            texture.see(grain, state);
            states.push_back({{"led", led},
                              {"band", std::string(letter(band))},
                              {"ratio", ratio},
                              {"texture", grain}});
        }
    }
    const auto certified = run.whileAlive([&] { return loadReferences(run.profile()); });
    if (!certified) return certified.error();
    const double perDirection = certified->white->certificate().uPerDirection;
    if (Result<void> good = checkWhiteAgain(run, change, texture, perDirection); !good)
        return good.error();
    return Json{{"schema", "gonio/verify-white/1"},
                {"rig", run.serial()},
                {"calibrated", white->info.dateUtc},
                {"worst_change", change.value},
                {"limit", run.request().limit},
                {"turned", run.request().turned},
                {"texture", texture.value},
                {"certified_per_direction", perDirection},
                {"states", states},
                {"rig_seconds", run.onRig().count()}};
}

}  // namespace gonio::daemon
