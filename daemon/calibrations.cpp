#include "daemon/calibrations.h"

#include <array>
#include <cmath>
#include <ctime>
#include <utility>

#include "daemon/rig_records.h"
#include "daemon/sequencer.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/graw_exr.h"

namespace gonio::daemon {
namespace {

constexpr int kMostLeds = 64;
constexpr int kKinds = 7;  // mirror, black, white, zero, flat, leds, sensor
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
                "': wanted a number, or three or more such as 10+11+12; see gonio calibrations"};
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
    std::optional<CalibrationRecord>* const more = kind == "zero"     ? &set.zero
                                                   : kind == "flat"   ? &set.flat
                                                   : kind == "leds"   ? &set.leds
                                                   : kind == "sensor" ? &set.sensor
                                                                      : nullptr;
    return more != nullptr ? &more->emplace() : nullptr;
}

template <class Set>
auto optionalOf(Set& set) {
    return std::array{&set.zero, &set.flat, &set.leds, &set.sensor};
}

/// Without the number of the sensor calibration that may follow it.
std::string baseOf(const std::string& profileHash) {
    return profileHash.substr(0, profileHash.find('/'));
}

bool isTile(const CalibrationRecord& calibration) {
    const std::string& kind = calibration.kind;
    return kind == "black" || kind == "white" || kind == "zero";
}

/// Only what was merged from frames depends on the sensor's figures; empty: it fits.
std::string otherProfile(const CalibrationRecord& calibration, const RigNow& now) {
    const std::string& then = calibration.profileHash;
    if (then.empty() || then == now.profileHash) return {};
    if (baseOf(then) != baseOf(now.profileHash)) {
        return " was taken with rig profile " + then + ", now it is " + now.profileHash;
    }
    if (!isTile(calibration)) return {};
    return now.profileHash.find('/') == std::string::npos
               ? " was taken with a sensor calibration that is no longer good; run: gonio "
                 "calibrate sensor"
               : " was taken with other figures of the sensor";
}

}  // namespace

std::string CalibrationSet::id() const {
    std::string id =
        std::to_string(mirror.id) + "+" + std::to_string(black.id) + "+" + std::to_string(white.id);
    for (const auto* one : optionalOf(*this))
        if (*one) id += "+" + std::to_string((*one)->id);
    return id;
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
    for (const std::string kind : {"zero", "flat", "leds", "sensor"}) {
        Result<std::optional<CalibrationRecord>> newest = store.newestCalibration(rig, kind);
        if (!newest) return newest.error();
        if (*newest) *placeOf(set, kind) = std::move(**newest);
    }
    return set;
}

Result<CalibrationSet> parseSet(Store& store,
                                std::string_view text,
                                const CalibrationSet& otherwise) {
    CalibrationSet set = otherwise;
    if (text.find('+') != std::string_view::npos) {
        for (auto* one : optionalOf(set)) one->reset();  // they are said, or not there
    }
    std::string_view rest = text;
    int count = 0;
    for (bool more = true; more && count < kKinds; ++count) {
        const std::size_t plus = rest.find('+');
        more = plus != std::string_view::npos;
        Result<CalibrationRecord> one = numbered(store, rest.substr(0, plus), otherwise.mirror.rig);
        if (!one) return one.error();
        CalibrationRecord* const place = placeOf(set, one->kind);
        if (place == nullptr) {
            return Error{ErrorKind::Usage,
                         nameOf(*one) + ": samples are not worked out with that kind"};
        }
        *place = std::move(*one);
        if (more) rest.remove_prefix(plus + 1);
    }
    if (count == 1 || set.id() == text) return set;
    return Error{ErrorKind::Usage,
                 "calibration '" + std::string(text) +
                     "': wanted one number, or those of a mirror, a black, a white and, where they "
                     "are there, a zero, flat, leds and sensor, in this order"};
}

std::optional<Seconds> ageAt(const CalibrationRecord& calibration, const std::string& dateUtc) {
    const auto then = secondsOf(calibration.dateUtc);
    const auto now = secondsOf(dateUtc);
    if (!then || !now) return std::nullopt;
    return Seconds(std::difftime(*now, *then));
}

std::string whyNot(const CalibrationRecord& calibration,
                   const RigNow& now,
                   const ValidityLimits& limits) {
    const std::string name = nameOf(calibration);
    if (calibration.rig != now.serial) {
        return name + " is of rig " + calibration.rig + ", not of " + now.serial;
    }
    if (const std::string other = otherProfile(calibration, now); !other.empty()) {
        return name + other + runAgain(calibration);
    }
    const auto age = ageAt(calibration, now.dateUtc);
    if (!age) return name + " has no date that can be read" + runAgain(calibration);
    if (*age < -kClocksApart) {
        return name + " is dated " + calibration.dateUtc + ", which is still to come: it is " +
               now.dateUtc + "; set the computer's clock right" + runAgain(calibration);
    }
    const Seconds longest = isTile(calibration) ? limits.tiles : limits.mirror;
    if (*age > longest) {
        const Seconds hour = std::chrono::hours(1);
        return name + " is " + fixed(*age / hour, 1) + " h old, good for " +
               fixed(longest / hour, 1) + " h" + runAgain(calibration);
    }
    const bool anyWarmth = calibration.kind == "leds" || calibration.kind == "sensor" ||
                           calibration.kind == "dark";  // stored_darks.h looks at its own
    if (anyWarmth || !calibration.celsius || !now.celsius) return {};
    if (std::abs(*now.celsius - *calibration.celsius) > limits.kelvin) {
        return name + " was taken at " + fixed(*calibration.celsius, 1) + " degC, now it is " +
               fixed(*now.celsius, 1) + " degC, good for " + fixed(limits.kelvin, 1) + " K" +
               runAgain(calibration);
    }
    return {};
}

void leaveOutStale(CalibrationSet& set, const RigNow& now, const ValidityLimits& limits) {
    for (auto* one : optionalOf(set)) {
        if (!*one) continue;
        const std::string why = whyNot(**one, now, limits);
        if (why.empty()) continue;
        log::warning(why + "; measured without it");
        one->reset();
    }
}

std::optional<CalibrationRecord> newestGood(Store& store,
                                            const std::string& kind,
                                            const RigNow& now,
                                            const ValidityLimits& limits) {
    auto newest = store.newestCalibration(now.serial, kind);
    if (!newest) {
        log::warning(newest.error().message + "; going on without " + kind);
        return std::nullopt;
    }
    if (!*newest) return std::nullopt;
    const std::string why = whyNot(**newest, now, limits);
    if (why.empty()) return std::move(**newest);
    log::warning(why + "; going on without it");
    return std::nullopt;
}

RigProfile measuredProfile(Store& store, const RigProfile& plain, const RigNow& now) {
    const auto record = newestGood(store, "sensor", now, plain.validity);
    if (!record) return plain;
    const Result<SensorRecord> sensor = readSensor(*record);
    if (sensor) return withSensor(plain, *sensor, record->id);
    log::warning(sensor.error().message + "; going on with the profile's figures");
    return plain;
}

Result<View> viewOf(const CalibrationRecord& mirror,
                    const std::optional<CalibrationRecord>& flat,
                    const std::optional<CalibrationRecord>& leds) {
    Result<LensRecord> lens = readLens(mirror);
    if (!lens) return lens.error();
    View view{.lens = std::move(*lens), .corrections = {}, .id = std::to_string(mirror.id)};
    if (flat) {
        const Result<std::string> bytes = proc::readFile(flat->file);
        if (!bytes) return bytes.error();
        auto found = decodeFlat(*bytes, nameOf(*flat));
        if (!found) return found.error();
        view.corrections.flat = std::move(*found);
        view.id += "+" + std::to_string(flat->id);
    }
    if (leds) {
        const Result<std::string> bytes = proc::readFile(leds->file);
        if (!bytes) return bytes.error();
        auto found = decodeLeds(*bytes, nameOf(*leds));
        if (!found) return found.error();
        view.corrections.leds = *found;
        view.id += "+" + std::to_string(leds->id);
    }
    return view;
}

Result<View> viewOf(const CalibrationSet& set) { return viewOf(set.mirror, set.flat, set.leds); }

Result<LensRecord> readLens(const CalibrationRecord& mirror) {
    const Result<std::string> text = proc::readFile(mirror.file);
    if (!text) return text.error();
    return decodeLens(*text, "lens map of " + mirror.rig);
}

Result<SensorRecord> readSensor(const CalibrationRecord& sensor) {
    const Result<std::string> text = proc::readFile(sensor.file);
    if (!text) return text.error();
    return decodeSensor(*text, nameOf(sensor));
}

Result<PlacementSignals> binned(const std::filesystem::path& raw, const View& view) {
    const Result<proc::RawCapture> capture = proc::readGraw(raw);
    if (!capture) return capture.error();
    if (capture->states.empty()) return Error{ErrorKind::File, raw.string() + ": no states"};
    const Window& window = capture->states.front().merged.window;
    if (Result<void> fit = fits(view.corrections, window); !fit)
        return fit.error().in(raw.string());
    const proc::Binning binning(view.lens.fit.map, window, kField);
    const proc::GlareFilter glare = glareFilterOf(view.lens, window);
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
        signals[led][index(state.merged.band)] = signalOf(state, view.corrections, glare, binning);
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
                                      const View& view) {
    const Result<std::string> bytes = proc::readFile(reference.file);
    if (!bytes) return bytes.error();
    Result<ReferenceRecord> record =
        decodeReference(*bytes, reference.kind + " reference of " + reference.rig);
    if (!record) return record;
    std::string seenWith = record->info.calibrationId;
    if (seenWith.empty()) {  // of before it was written down: the newest lens map of then
        const auto mirror = store.newestCalibration(reference.rig, "mirror", reference.id);
        if (!mirror) return mirror.error();
        if (*mirror) seenWith = std::to_string((*mirror)->id);
    }
    if (seenWith == view.id) return record;
    Result<PlacementSignals> again = binned(reference.raw, view);
    if (!again) return again.error();
    const Result<void> complete =
        checkComplete(*again, record->signals.size(), reference.raw.string());
    if (!complete) return complete.error().in(nameOf(reference));
    record->signals = std::move(*again);
    return record;
}

Result<LoadedSet> loadSet(Store& store, const CalibrationSet& set) {
    Result<View> view = viewOf(set);
    if (!view) return view.error();
    Result<ReferenceRecord> black = readReference(store, set.black, *view);
    if (!black) return black.error();
    Result<ReferenceRecord> white = readReference(store, set.white, *view);
    if (!white) return white.error();
    LoadedSet loaded{std::move(*view), std::move(*black), std::move(*white), std::nullopt};
    if (!set.zero) return loaded;
    Result<ReferenceRecord> zero = readReference(store, *set.zero, loaded.view);
    if (!zero) return zero.error();
    loaded.zero = std::move(*zero);
    return loaded;
}

RigReferences referencesOf(const LoadedSet& loaded,
                           const References& certified,
                           const RigProfile& profile) {
    RigReferences references{.lens = loaded.view.lens,
                             .white = loaded.white,
                             .black = loaded.black,
                             .certified = certified,
                             .profile = profile,
                             .zero = loaded.zero ? &*loaded.zero : nullptr};
    if (const auto& leds = loaded.view.corrections.leds) {
        // They may have been captured anywhere within the kelvin that a tile is good for.
        const double kelvin = profile.validity.kelvin / std::sqrt(3.0);
        for (const Band band : kBands)
            references.uMonitor[index(band)] = leds->bands[index(band)].uPerKelvin * kelvin;
    }
    return references;
}

}  // namespace gonio::daemon
