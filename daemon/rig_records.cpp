#include "daemon/rig_records.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "proc/core/bands.h"
#include "proc/formats/exr_parts.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char *kFlatSchema = "gonio/flat/1", *kLedsSchema = "gonio/leds/1",
                     *kSensorSchema = "gonio/sensor/1", *kDarksSchema = "gonio/darks/1";
constexpr proc::ExrLimits kLimits{.largest = {8192, 8192}, .parts = 64, .bytes = 2'000'000'000};

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// What `read` makes of it; what it throws is a File error.
template <class Read>
auto understood(const std::string& name, const std::string& kind, Read read)
    -> Result<decltype(read())> {
    try {
        return read();
    } catch (const std::exception& error) {
        return Error{ErrorKind::File,
                     name + ": " + error.what() + "; run: gonio calibrate " + kind};
    }
}

Json parsed(std::string_view text, const char* schema) {
    Json json = Json::parse(text);
    if (json.at("schema") != schema) {
        throw std::runtime_error("its schema is not " + std::string(schema));
    }
    return json;
}

Json toJson(const Window& window) {
    return {window.x, window.y, window.size.width, window.size.height, window.binning};
}

/// The library would turn 2^32 into 0.
int wholeFrom(const Json& json) {
    const auto value = json.get<std::int64_t>();
    if (!json.is_number_integer() || !std::in_range<int>(value))
        throw std::runtime_error("a number that is out of its range");
    return static_cast<int>(value);
}

double finiteFrom(const Json& json) {
    const auto value = json.get<double>();
    if (!std::isfinite(value)) throw std::runtime_error("a number that is not finite");
    return value;
}

Window windowFrom(const Json& json) {
    const Window window{.x = wholeFrom(json.at(0)),
                        .y = wholeFrom(json.at(1)),
                        .size = {wholeFrom(json.at(2)), wholeFrom(json.at(3))},
                        .binning = wholeFrom(json.at(4))};
    if (window.binning < 1 || window.size.width < 1 || window.size.height < 1)
        throw std::runtime_error("a window without pixels");
    return window;
}

bool allFinite(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

/// A part's text and its one picture, whose window is the text's.
Json aboutOf(const proc::ExrPart& part, const char* schema, const char* picture) {
    const auto text = part.text.find("gonio.about");
    if (text == part.text.end() || !part.floats.contains(picture)) {
        throw std::runtime_error("not a file of this kind");
    }
    Json about = parsed(text->second, schema);
    if (windowFrom(about.at("window")).sent() != part.size) {
        throw std::runtime_error("its picture is not of its window");
    }
    if (!allFinite(part.floats.at(picture))) throw std::runtime_error("pixels without a value");
    return about;
}

std::vector<float> values(const Image<float>& picture) {
    return {picture.pixels().begin(), picture.pixels().end()};
}

Json toJson(const proc::WarmUpFit& fit) {
    return {{"per_kelvin", fit.perKelvin},
            {"u_per_kelvin", fit.uPerKelvin},
            {"celsius", fit.celsius},
            {"chi_square", fit.chiSquare},
            {"freedom", fit.freedom}};
}

proc::ExrPart partOf(const proc::DarkFrame& dark) {
    Json hot = Json::array();
    for (const proc::HotPixel& pixel : dark.hot) hot.push_back({pixel.x, pixel.y, pixel.excessDn});
    const Json about{{"schema", kDarksSchema},
                     {"window", toJson(dark.window)},
                     {"requested_us", dark.exposure.requested.count()},
                     {"granted_ns", dark.exposure.granted.count()},
                     {"gain_db", dark.gainDb},
                     {"frames", dark.frames},
                     {"variance_of_mean", dark.varianceOfMean},
                     {"hot", hot}};
    proc::ExrPart part;
    part.name = "dark." + std::to_string(dark.exposure.granted.count());
    part.size = dark.mean.size();
    part.text["gonio.about"] = about.dump();
    part.floats["mean"] = values(dark.mean);
    return part;
}

proc::DarkFrame darkFrom(proc::ExrPart&& part) {
    const Json about = aboutOf(part, kDarksSchema, "mean");
    proc::DarkFrame dark{
        .mean = Image<float>(part.size, std::move(part.floats["mean"])),
        .varianceOfMean = finiteFrom(about.at("variance_of_mean")),
        .hot = {},
        .exposure = {.requested = Microseconds(about.at("requested_us").get<std::int64_t>()),
                     .granted = Nanoseconds(about.at("granted_ns").get<std::int64_t>())},
        .window = windowFrom(about.at("window")),
        .gainDb = about.at("gain_db"),
        .frames = wholeFrom(about.at("frames"))};
    if (dark.frames < 1 || !(dark.varianceOfMean >= 0)) throw std::runtime_error("no dark frames");
    for (const Json& pixel : about.at("hot")) {
        const proc::HotPixel hot{
            wholeFrom(pixel.at(0)), wholeFrom(pixel.at(1)), finiteFrom(pixel.at(2))};
        const bool inside =
            hot.x >= 0 && hot.y >= 0 && hot.x < dark.mean.width() && hot.y < dark.mean.height();
        if (!inside) throw std::runtime_error("a hot pixel outside of the picture");
        dark.hot.push_back(hot);
    }
    return dark;
}

}  // namespace

Result<std::string> encodeFlat(const proc::FlatField& flat) {
    const Json about{{"schema", kFlatSchema},
                     {"window", toJson(flat.window)},
                     {"spread", flat.spread},
                     {"u_response", flat.uResponse},
                     {"covered_pixels", flat.coveredPixels}};
    proc::ExrPart part;
    part.name = "flat";
    part.size = flat.response.size();
    part.text["gonio.about"] = about.dump();
    part.floats["response"] = values(flat.response);
    return proc::encodeExr(std::span(&part, 1));
}

Result<std::shared_ptr<const proc::FlatField>> decodeFlat(std::string_view bytes,
                                                          const std::string& name) {
    auto parts = proc::decodeExr(bytes, kLimits);
    if (!parts) return parts.error().in(name);
    return understood(name, "flat", [&]() -> std::shared_ptr<const proc::FlatField> {
        proc::ExrPart& part = parts->front();
        const Json about = aboutOf(part, kFlatSchema, "response");
        auto flat = std::make_shared<proc::FlatField>(
            proc::FlatField{.response = Image<float>(part.size, std::move(part.floats["response"])),
                            .window = windowFrom(about.at("window")),
                            .spread = about.at("spread"),
                            .uResponse = about.at("u_response"),
                            .coveredPixels = about.at("covered_pixels")});
        for (const float one : flat->response.pixels()) {
            if (!(one > 0)) throw std::runtime_error("a response that is not positive");
        }
        return flat;
    });
}

std::string encodeLeds(const proc::LedMonitor& leds) {
    Json bands = Json::object();
    for (const Band band : kBands) {
        Json fit = toJson(leds.bands[index(band)]);
        fit["full_milliamp"] = leds.fullMilliamp[index(band)];
        bands[std::string(letter(band))] = fit;
    }
    return dump({{"schema", kLedsSchema}, {"milliamp_step", leds.milliampStep}, {"bands", bands}});
}

Result<proc::LedMonitor> decodeLeds(std::string_view text, const std::string& name) {
    return understood(name, "leds", [&] {
        const Json json = parsed(text, kLedsSchema);
        proc::LedMonitor leds{.milliampStep = json.at("milliamp_step")};
        for (const Band band : kBands) {
            const Json& fit = json.at("bands").at(std::string(letter(band)));
            leds.bands[index(band)] = {.perKelvin = fit.at("per_kelvin"),
                                       .uPerKelvin = fit.at("u_per_kelvin"),
                                       .celsius = fit.at("celsius"),
                                       .chiSquare = fit.at("chi_square"),
                                       .freedom = fit.at("freedom")};
            leds.fullMilliamp[index(band)] = finiteFrom(fit.at("full_milliamp"));
            constexpr double kSteepest = 0.05;  // per kelvin: no LED loses more
            if (!(std::abs(leds.bands[index(band)].perKelvin) < kSteepest))
                throw std::runtime_error("light that changes by more than 5 % per kelvin");
        }
        return leds;
    });
}

std::string encodeSensor(const SensorRecord& sensor) {
    const proc::PhotonTransfer& transfer = sensor.transfer;
    const proc::LinearityFit& fit = sensor.linearity;
    Json sweep = Json::array();
    for (const proc::SweepPoint& point : sensor.sweep)
        sweep.push_back({{"tau_s", point.tau}, {"mean_dn", point.meanDn}, {"u_dn", point.u}});
    return dump({{"schema", kSensorSchema},
                 {"date", sensor.dateUtc},
                 {"celsius", sensor.celsius ? Json(*sensor.celsius) : Json()},
                 {"electrons_per_dn", transfer.electronsPerDn},
                 {"u_electrons_per_dn", transfer.uElectronsPerDn},
                 {"read_noise_electrons", transfer.readNoiseElectrons},
                 {"u_read_noise_electrons", transfer.uReadNoiseElectrons},
                 {"transfer_chi_square", transfer.chiSquare},
                 {"transfer_freedom", transfer.freedom},
                 {"pairs", transfer.pairs},
                 {"black_dn", fit.linearity.blackDn},
                 {"range_dn", fit.linearity.rangeDn},
                 {"coefficients", fit.linearity.coefficients},
                 {"inl_percent", fit.inlPercent},
                 {"largest_residual_dn", fit.largestResidualDn},
                 {"sweep", sweep}});
}

Result<SensorRecord> decodeSensor(std::string_view text, const std::string& name) {
    return understood(name, "sensor", [&] {
        const Json json = parsed(text, kSensorSchema);
        SensorRecord sensor{.transfer = {.electronsPerDn = json.at("electrons_per_dn"),
                                         .uElectronsPerDn = json.at("u_electrons_per_dn"),
                                         .readNoiseElectrons = json.at("read_noise_electrons"),
                                         .uReadNoiseElectrons = json.at("u_read_noise_electrons"),
                                         .chiSquare = json.at("transfer_chi_square"),
                                         .freedom = json.at("transfer_freedom"),
                                         .pairs = json.at("pairs")},
                            .linearity = {.linearity = {.blackDn = json.at("black_dn"),
                                                        .rangeDn = json.at("range_dn"),
                                                        .coefficients = json.at("coefficients")},
                                          .inlPercent = json.at("inl_percent"),
                                          .largestResidualDn = json.at("largest_residual_dn")},
                            .sweep = {},
                            .celsius = {},
                            .dateUtc = json.at("date")};
        if (json.at("celsius").is_number()) sensor.celsius = json.at("celsius").get<double>();
        const bool usable = sensor.transfer.electronsPerDn > 0 &&
                            sensor.transfer.readNoiseElectrons >= 0 &&
                            sensor.linearity.linearity.rangeDn > 0;
        if (!usable) throw std::runtime_error("a gain, noise or range that no sensor has");
        return sensor;
    });
}

Result<std::string> encodeDarks(std::span<const proc::DarkFrame> darks) {
    std::vector<proc::ExrPart> parts;
    for (const proc::DarkFrame& dark : darks) parts.push_back(partOf(dark));
    return proc::encodeExr(parts);
}

Result<std::vector<proc::DarkFrame>> decodeDarks(std::string_view bytes, const std::string& name) {
    auto parts = proc::decodeExr(bytes, kLimits);
    if (!parts) return parts.error().in(name);
    return understood(name, "dark", [&] {
        std::vector<proc::DarkFrame> darks;
        std::set<Microseconds> exposures;
        for (proc::ExrPart& part : *parts) {
            darks.push_back(darkFrom(std::move(part)));
            const proc::DarkFrame& dark = darks.back();
            if (dark.window != darks.front().window || dark.gainDb != darks.front().gainDb ||
                dark.frames != darks.front().frames)
                throw std::runtime_error("exposures that were not taken alike");
            if (!exposures.insert(dark.exposure.requested).second)
                throw std::runtime_error("an exposure that is there twice");
        }
        return darks;
    });
}

}  // namespace gonio::daemon
