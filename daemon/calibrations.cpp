#include "daemon/calibrations.h"

#include <array>
#include <cmath>
#include <ctime>
#include <utility>

#include "daemon/sequencer.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/graw_exr.h"

namespace gonio::daemon {
namespace {

constexpr int kMostLeds = 64;
constexpr int kKinds = 4;  // mirror, black, white, zero
constexpr Seconds kClocksApart = std::chrono::minutes(5);

/// Seconds since 1970; empty for what is no ISO 8601 date as this program writes it.
std::optional<std::time_t> secondsOf(const std::string& dateUtc) {
    std::tm utc{};
    const char* end = ::strptime(dateUtc.c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    if (end == nullptr || *end != '\0') return std::nullopt;
    return ::timegm(&utc);
}

std::string nameOf(const CalibrationRecord& calibration) {
    return calibration.kind + " calibration " + std::to_string(calibration.id);
}

std::string runAgain(const CalibrationRecord& calibration) {
    return "; run: gonio calibrate " + calibration.kind;
}

Result<CalibrationRecord> numbered(Store& store, std::string_view text, const std::string& rig) {
    const auto number = parseInteger(text);
    if (!number || *number < 1) {
        return Error{
            ErrorKind::Usage,
            "calibration '" + std::string(text) +
                "': wanted a number, or three such as 10+11+12, or four; see gonio calibrations"};
    }
    auto found = store.calibration(*number);
    if (!found) return found.error();
    const std::string name = "calibration " + std::string(text);
    if (!*found) return Error{ErrorKind::Quality, name + ": the store has none of that number"};
    if ((*found)->rig == rig) return std::move(**found);
    return Error{ErrorKind::Quality, name + " is of rig " + (*found)->rig + ", not of " + rig};
}

CalibrationRecord* placeOf(CalibrationSet& set, const std::string& kind) {
    if (kind == "mirror") return &set.mirror;
    if (kind == "black") return &set.black;
    if (kind == "white") return &set.white;
    return kind == "zero" ? &set.zero.emplace() : nullptr;
}

}  // namespace

std::string CalibrationSet::id() const {
    return std::to_string(mirror.id) + "+" + std::to_string(black.id) + "+" +
           std::to_string(white.id) + (zero ? "+" + std::to_string(zero->id) : "");
}

Result<CalibrationRecord> newestOf(Store& store, const std::string& rig, const std::string& kind) {
    auto record = store.newestCalibration(rig, kind);
    if (!record) return record.error();
    if (*record) return std::move(**record);
    return Error{ErrorKind::Quality,
                 "rig " + rig + " has no " + kind + " calibration; place the " + kind +
                     " and run: gonio calibrate " + kind};
}

Result<CalibrationSet> newestSet(Store& store, const std::string& rig) {
    CalibrationSet set;
    for (const std::string kind : {"mirror", "black", "white"}) {
        Result<CalibrationRecord> newest = newestOf(store, rig, kind);
        if (!newest) return newest.error();
        *placeOf(set, kind) = std::move(*newest);
    }
    Result<std::optional<CalibrationRecord>> zero = store.newestCalibration(rig, "zero");
    if (!zero) return zero.error();
    set.zero = std::move(*zero);
    return set;
}

Result<CalibrationSet> parseSet(Store& store,
                                std::string_view text,
                                const CalibrationSet& otherwise) {
    CalibrationSet set = otherwise;
    if (text.find('+') != std::string_view::npos) set.zero.reset();  // it is said, or not there
    std::string_view rest = text;
    int count = 0;
    for (bool more = true; more && count < kKinds; ++count) {
        const std::size_t plus = rest.find('+');
        more = plus != std::string_view::npos;
        Result<CalibrationRecord> one = numbered(store, rest.substr(0, plus), otherwise.mirror.rig);
        if (!one) return one.error();
        *placeOf(set, one->kind) = std::move(*one);
        if (more) rest.remove_prefix(plus + 1);
    }
    if (count == 1 || set.id() == text) return set;
    return Error{ErrorKind::Usage,
                 "calibration '" + std::string(text) +
                     "': wanted one number, or those of a mirror, a black, a white and, where "
                     "there is one, a "
                     "zero, in this order"};
}

std::string whyNot(const CalibrationRecord& calibration,
                   const RigNow& now,
                   const ValidityLimits& limits) {
    const std::string name = nameOf(calibration);
    if (calibration.rig != now.serial) {
        return name + " is of rig " + calibration.rig + ", not of " + now.serial;
    }
    if (!calibration.profileHash.empty() && calibration.profileHash != now.profileHash) {
        return name + " was taken with rig profile " + calibration.profileHash + ", now it is " +
               now.profileHash + runAgain(calibration);
    }
    const auto then = secondsOf(calibration.dateUtc);
    const auto today = secondsOf(now.dateUtc);
    if (!then || !today) return name + " has no date that can be read" + runAgain(calibration);
    const Seconds age(std::difftime(*today, *then));
    if (age < -kClocksApart) {
        return name + " is dated " + calibration.dateUtc + ", which is still to come: it is " +
               now.dateUtc + "; set the computer's clock right" + runAgain(calibration);
    }
    const Seconds longest = calibration.kind == "mirror" ? limits.mirror : limits.tiles;
    if (age > longest) {
        const Seconds hour = std::chrono::hours(1);
        return name + " is " + fixed(age / hour, 1) + " h old, good for " +
               fixed(longest / hour, 1) + " h" + runAgain(calibration);
    }
    if (!calibration.celsius || !now.celsius) return {};
    if (std::abs(*now.celsius - *calibration.celsius) > limits.kelvin) {
        return name + " was taken at " + fixed(*calibration.celsius, 1) + " degC, now it is " +
               fixed(*now.celsius, 1) + " degC, good for " + fixed(limits.kelvin, 1) + " K" +
               runAgain(calibration);
    }
    return {};
}

void leaveOutStaleZero(CalibrationSet& set, const RigNow& now, const ValidityLimits& limits) {
    if (!set.zero) return;
    const std::string why = whyNot(*set.zero, now, limits);
    if (why.empty()) return;
    log::warning(why + "; measured without it");
    set.zero.reset();
}

Result<LensRecord> readLens(const CalibrationRecord& mirror) {
    const Result<std::string> text = proc::readFile(mirror.file);
    if (!text) return text.error();
    return decodeLens(*text, "lens map of " + mirror.rig);
}

Result<PlacementSignals> binned(const std::filesystem::path& raw, const LensRecord& lens) {
    const Result<proc::RawCapture> capture = proc::readGraw(raw);
    if (!capture) return capture.error();
    if (capture->states.empty()) return Error{ErrorKind::File, raw.string() + ": no states"};
    const Window& window = capture->states.front().merged.window;
    const proc::Binning binning(lens.fit.map, window, kField);
    const proc::GlareFilter glare = glareFilterOf(lens, window);
    PlacementSignals signals;
    for (const proc::RawState& state : capture->states) {
        if (state.merged.window != window || state.merged.led < 0 ||
            state.merged.led >= kMostLeds) {
            return Error{ErrorKind::File,
                         raw.string() + ": states of different windows, or an LED of number " +
                             std::to_string(state.merged.led)};
        }
        const auto led = static_cast<std::size_t>(state.merged.led);
        if (signals.size() <= led) signals.resize(led + 1);
        signals[led][index(state.merged.band)] = glare.bin(state.merged, binning);
    }
    return signals;
}

Result<void> checkComplete(const PlacementSignals& signals,
                           std::size_t leds,
                           const std::string& what) {
    if (signals.size() != leds) {
        return Error{
            ErrorKind::File,
            what + ": " + std::to_string(signals.size()) + " LEDs, wanted " + std::to_string(leds)};
    }
    for (std::size_t led = 0; led < leds; ++led) {
        for (const Band band : kBands) {
            if (signals[led][index(band)].size() > 0) continue;
            return Error{ErrorKind::File,
                         what + ": " + stateName({static_cast<int>(led), band}) + " is missing"};
        }
    }
    return {};
}

Result<ReferenceRecord> readReference(Store& store,
                                      const CalibrationRecord& reference,
                                      const CalibrationRecord& mirror,
                                      const LensRecord& lens) {
    const Result<std::string> bytes = proc::readFile(reference.file);
    if (!bytes) return bytes.error();
    Result<ReferenceRecord> record =
        decodeReference(*bytes, reference.kind + " reference of " + reference.rig);
    if (!record) return record;
    const auto binnedWith = store.newestCalibration(reference.rig, "mirror", reference.id);
    if (!binnedWith) return binnedWith.error();
    if (*binnedWith && (*binnedWith)->id == mirror.id) return record;
    Result<PlacementSignals> again = binned(reference.raw, lens);
    if (!again) return again.error();
    const Result<void> complete =
        checkComplete(*again, record->signals.size(), reference.raw.string());
    if (!complete) return complete.error().in(nameOf(reference));
    record->signals = std::move(*again);
    return record;
}

Result<LoadedSet> loadSet(Store& store, const CalibrationSet& set) {
    Result<LensRecord> lens = readLens(set.mirror);
    if (!lens) return lens.error();
    Result<ReferenceRecord> black = readReference(store, set.black, set.mirror, *lens);
    if (!black) return black.error();
    Result<ReferenceRecord> white = readReference(store, set.white, set.mirror, *lens);
    if (!white) return white.error();
    LoadedSet loaded{std::move(*lens), std::move(*black), std::move(*white), std::nullopt};
    if (!set.zero) return loaded;
    Result<ReferenceRecord> zero = readReference(store, *set.zero, set.mirror, loaded.lens);
    if (!zero) return zero.error();
    loaded.zero = std::move(*zero);
    return loaded;
}

RigReferences referencesOf(const LoadedSet& loaded,
                           const References& certified,
                           const RigProfile& profile) {
    return {.lens = loaded.lens,
            .white = loaded.white,
            .black = loaded.black,
            .certified = certified,
            .profile = profile,
            .zero = loaded.zero ? &*loaded.zero : nullptr};
}

}  // namespace gonio::daemon
