#include "sim/rig_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/number_text.h"

namespace gonio::sim {
namespace {

struct Entry {
    std::string_view name;
    double usual;  // NaN: has to be said
    double least;
    double most;
    bool typical;  // one of those that `typical` stands for
    void (*set)(RigErrors&, double);
};

constexpr double kSaid = std::numeric_limits<double>::quiet_NaN();

constexpr std::array kEntries{
    Entry{"glare", 0.001, 0, 0.05, true, [](RigErrors& e, double v) { e.glare = v; }},
    Entry{"drift", 0.002, 0, 0.05, true, [](RigErrors& e, double v) { e.ledDrift = v; }},
    Entry{"offset_us",
          0.2,
          -14,
          14,
          true,
          [](RigErrors& e, double v) { e.exposureOffset = Nanoseconds(std::llround(1000 * v)); }},
    Entry{"prnu", 0.007, 0, 0.05, true, [](RigErrors& e, double v) { e.nonUniformity = v; }},
    Entry{"column_e", 0.5, 0, 20, true, [](RigErrors& e, double v) { e.columnNoise = v; }},
    Entry{"celsius", kSaid, 0, 80, false, [](RigErrors& e, double v) { e.celsius = v; }},
    Entry{"doubling_k", 7, 6, 8, false, [](RigErrors& e, double v) { e.doublingKelvin = v; }},
    Entry{"inl", 0.003, -0.02, 0.02, true, [](RigErrors& e, double v) { e.nonLinearity = v; }},
    Entry{"crosstalk", 0.01, 0, 0.2, true, [](RigErrors& e, double v) { e.crosstalk = v; }},
    Entry{"source_deg",
          1,
          0,
          2,
          true,
          [](RigErrors& e, double v) { e.sourceDiameter = Radians::fromDegrees(v); }},
    Entry{"wedge_deg",
          0.01,
          0,
          0.5,
          true,
          [](RigErrors& e, double v) { e.wedges = Radians::fromDegrees(v); }},
    Entry{
        "bits", kSaid, 8, 12, false, [](RigErrors& e, double v) { e.bits = static_cast<int>(v); }},
};

constexpr double kLargestStep = 0.5;

Error refused(std::string_view part, const std::string& wanted) {
    return {ErrorKind::Usage, "rig errors: '" + std::string(part) + "': wanted " + wanted};
}

std::string names() {
    std::string list = "none, typical, step";
    for (const Entry& entry : kEntries) list.append(", ").append(entry.name);
    return list;
}

/// "name" or "name=size".
struct Part {
    std::string_view whole;
    std::string_view name;
    std::optional<std::string_view> size;
};

Part partOf(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return {text, text, {}};
    return {text, text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<Part> partsOf(std::string_view text) {
    std::vector<Part> parts;
    while (true) {
        const std::size_t comma = text.find(',');
        parts.push_back(partOf(text.substr(0, comma)));
        if (comma == std::string_view::npos) return parts;
        text.remove_prefix(comma + 1);
    }
}

Result<void> setStep(RigErrors& errors, const Part& part) {
    const std::string_view text = part.size.value_or("");
    const std::size_t at = std::min(text.find('@'), text.size());
    const auto size = parseDouble(text.substr(0, at));
    const std::int64_t planStep =
        at == text.size() ? -1 : parseInteger(text.substr(at + 1)).value_or(-1);
    if (!size || !(std::abs(*size) <= kLargestStep) || planStep < 0) {
        return refused(part.whole, "step=SIZE@PLAN_STEP with SIZE in -0.5..0.5");
    }
    errors.ledStep = {.size = *size, .planStep = static_cast<std::uint64_t>(planStep)};
    return {};
}

Result<void> setSize(RigErrors& errors, const Part& part, const Entry& entry) {
    const std::optional<double> size = part.size ? parseDouble(*part.size) : entry.usual;
    const bool good = size && *size >= entry.least && *size <= entry.most &&
                      (entry.name != "bits" || std::fmod(*size, 2) == 0);
    if (!good) {
        const std::string domain = entry.name == "bits"
                                       ? "8, 10 or 12"
                                       : shortest(entry.least) + ".." + shortest(entry.most);
        return refused(part.whole, std::string(entry.name) + "=SIZE with SIZE " + domain);
    }
    entry.set(errors, *size);
    return {};
}

Result<void> setPart(RigErrors& errors, const Part& part) {
    if (part.whole == "typical") {
        for (const Entry& entry : kEntries) {
            if (entry.typical) entry.set(errors, entry.usual);
        }
        return {};
    }
    if (part.name == "step") return setStep(errors, part);
    const auto entry = std::find_if(
        kEntries.begin(), kEntries.end(), [&](const Entry& e) { return e.name == part.name; });
    if (entry == kEntries.end()) return refused(part.whole, names());
    return setSize(errors, part, *entry);
}

}  // namespace

Result<RigErrors> parseRigErrors(std::string_view text, const RigErrors& base) {
    RigErrors errors = base;
    if (text == "none") return errors;
    std::vector<std::string_view> said;
    for (const Part& part : partsOf(text)) {
        if (std::find(said.begin(), said.end(), part.name) != said.end()) {
            return refused(part.whole, "each name once");
        }
        said.push_back(part.name);
        if (Result<void> done = setPart(errors, part); !done) return done.error();
    }
    return errors;
}

}  // namespace gonio::sim
