#include "proc/formats/graw_exr.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/exr_parts.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

using nlohmann::json;

constexpr Size kLargest{8192, 8192};
constexpr std::size_t kMostStates = 768;
constexpr std::size_t kLargestRaw = std::size_t{2} << 30U;

std::string dumped(const json& value) {
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json toJson(const RawExposure& e) {
    json celsius = json::array();
    for (const auto& c : e.celsius) celsius.push_back(c ? json(*c) : json());
    return {{"capture_id", e.captureId},
            {"granted_ns", e.granted.count()},
            {"level", e.level},
            {"frames", e.frames},
            {"black_level", e.blackLevel},
            {"celsius", celsius},
            {"scale", e.scale},
            {"u_scale", e.uScale},
            {"milliamp", e.milliamp}};
}

/// The library would turn 70000 into the level 4464, and 1e300 into anything.
template <class T>
T integerFrom(const json& j) {
    const bool fits = j.is_number_unsigned()
                          ? std::in_range<T>(j.get<std::uint64_t>())
                          : j.is_number_integer() && std::in_range<T>(j.get<std::int64_t>());
    if (!fits) throw std::out_of_range("not an integer of its range");
    return j.get<T>();
}

/// Throws where something is missing or of the wrong kind.
RawExposure exposureFrom(const json& j) {
    RawExposure e;
    e.captureId = integerFrom<std::uint64_t>(j.at("capture_id"));
    e.granted = Nanoseconds(integerFrom<std::int64_t>(j.at("granted_ns")));
    e.level = integerFrom<std::uint16_t>(j.at("level"));
    e.frames = integerFrom<int>(j.at("frames"));
    e.blackLevel = integerFrom<std::uint16_t>(j.at("black_level"));
    e.scale = j.value("scale", 1.0);
    e.uScale = j.value("u_scale", 0.0);
    e.milliamp = j.value("milliamp", 0.0);
    const json& celsius = j.at("celsius");
    for (std::size_t i = 0; i < e.celsius.size(); ++i) {
        if (!celsius.at(i).is_null()) e.celsius[i] = celsius.at(i).get<double>();
    }
    return e;
}

json toJson(const RawState& state) {
    const MergedState& m = state.merged;
    json bracket = json::array();
    for (const RawExposure& e : state.bracket) bracket.push_back(toJson(e));
    return {{"led", m.led},
            {"band", index(m.band)},
            {"window", {m.window.x, m.window.y, m.window.size.width, m.window.size.height}},
            {"binning", m.window.binning},
            {"all_saturated_pixels", m.allSaturatedPixels},
            {"chi_square", m.chiSquare},
            {"freedom", m.freedom},
            {"bracket", bracket}};
}

/// Throws as above; the pictures are still empty.
RawState stateFrom(const json& j) {
    RawState state;
    MergedState& m = state.merged;
    m.led = integerFrom<int>(j.at("led"));
    m.band = kBands.at(integerFrom<std::size_t>(j.at("band")));
    const json& window = j.at("window");
    m.window = {.x = integerFrom<int>(window.at(0)),
                .y = integerFrom<int>(window.at(1)),
                .size = {integerFrom<int>(window.at(2)), integerFrom<int>(window.at(3))},
                .binning = integerFrom<int>(j.at("binning"))};
    m.allSaturatedPixels = integerFrom<std::size_t>(j.at("all_saturated_pixels"));
    m.chiSquare = j.at("chi_square").get<double>();
    m.freedom = integerFrom<std::size_t>(j.at("freedom"));
    for (const json& e : j.at("bracket")) state.bracket.push_back(exposureFrom(e));
    return state;
}

std::string partName(const RawState& state) {
    return "led" + std::to_string(state.merged.led) + "." + std::string(letter(state.merged.band));
}

template <class To, class From>
std::vector<To> pixelsAs(std::span<const From> from) {
    std::vector<To> to;
    to.reserve(from.size());
    for (const From value : from) to.push_back(static_cast<To>(value));
    return to;
}

ExrPart partOf(const RawState& state) {
    const MergedState& m = state.merged;
    ExrPart part;
    part.name = partName(state);
    part.size = m.radiance.size();
    part.text["gonio.state"] = dumped(toJson(state));
    part.floats["radiance"] = pixelsAs<float>(m.radiance.pixels());
    part.floats["variance"] = pixelsAs<float>(m.variance.pixels());
    part.counts["used"] = pixelsAs<std::uint32_t>(m.used.pixels());
    part.counts["saturated"] = pixelsAs<std::uint32_t>(m.saturated.pixels());
    return part;
}

Error malformed(std::string_view name, const std::string& what) {
    return {ErrorKind::File, "graw: " + std::string(name) + ": " + what};
}

bool hasChannels(const ExrPart& part) {
    return part.floats.contains("radiance") && part.floats.contains("variance") &&
           part.counts.contains("used") && part.counts.contains("saturated");
}

/// Does the attribute speak of the part it stands in? Its window is what these pixels show.
bool belongsTo(const RawState& state, const ExrPart& part) {
    const Window& window = state.merged.window;
    return part.name == partName(state) && window.binning > 0 && window.sent() == part.size;
}

/// Throws where the state's attribute is malformed, or another part's.
RawState stateOf(ExrPart&& part) {
    const auto text = part.text.find("gonio.state");
    RawState state = stateFrom(json::parse(text == part.text.end() ? "" : text->second));
    if (!belongsTo(state, part)) throw std::invalid_argument("another part's state");
    const auto bytes = [&](const char* channel) {
        std::vector<std::uint8_t> pixels;
        pixels.reserve(part.size.pixels());
        for (const std::uint32_t n : part.counts.at(channel)) {
            pixels.push_back(static_cast<std::uint8_t>(std::min(n, 255U)));
        }
        return Image<std::uint8_t>(part.size, std::move(pixels));
    };
    state.merged.radiance = Image<float>(part.size, std::move(part.floats["radiance"]));
    state.merged.variance = Image<float>(part.size, std::move(part.floats["variance"]));
    state.merged.used = bytes("used");
    state.merged.saturated = bytes("saturated");
    return state;
}

Result<RawCapture> captureOf(std::vector<ExrPart>&& parts, std::string_view name) {
    const auto& text = parts.front().text;
    const auto schema = text.find("gonio.schema");
    if (schema == text.end() || schema->second != kRawSchema) {
        return malformed(name, "schema is not " + std::string(kRawSchema));
    }
    RawCapture capture;
    std::string part;
    try {
        const auto info = text.find("gonio.info");
        if (info != text.end()) {
            capture.info = json::parse(info->second).get<std::map<std::string, std::string>>();
        }
        for (ExrPart& each : parts) {
            part = each.name;
            if (!hasChannels(each))
                return malformed(name, "part " + shown(part) + ": channels missing");
            capture.states.push_back(stateOf(std::move(each)));
        }
    } catch (const std::exception&) {
        return malformed(name, "part " + shown(part) + ": its attributes are not those of a state");
    }
    return capture;
}

}  // namespace

Result<std::string> encodeGraw(RawCapture capture) {
    std::vector<ExrPart> parts;
    std::set<std::string> names;
    for (RawState& state : capture.states) {
        if (!names.insert(partName(state)).second) {
            return Error{ErrorKind::Internal, "graw: state " + partName(state) + " is there twice"};
        }
        parts.push_back(partOf(state));
        state.merged = {};  // 10 MB: not twice in memory
    }
    if (parts.empty()) return Error{ErrorKind::Internal, "graw: the capture has no states"};
    parts.front().text["gonio.schema"] = kRawSchema;
    parts.front().text["gonio.info"] = dumped(json(capture.info));
    return encodeExr(parts);
}

Result<RawCapture> decodeGraw(std::string_view bytes, std::string_view name) {
    auto parts = decodeExr(bytes, {.largest = kLargest, .parts = kMostStates});
    if (!parts) return parts.error().in("graw: " + std::string(name));
    return captureOf(std::move(*parts), name);
}

Result<void> writeGraw(const std::filesystem::path& path, const RawCapture& capture) {
    const Result<std::string> bytes = encodeGraw(capture);
    if (!bytes) return bytes.error();
    return writeFile(path, *bytes);
}

Result<RawCapture> readGraw(const std::filesystem::path& path) {
    const Result<std::string> bytes = readFile(path, kLargestRaw);
    if (!bytes) return bytes.error();
    return decodeGraw(*bytes, path.string());
}

}  // namespace gonio::proc
