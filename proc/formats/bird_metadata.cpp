#include "proc/formats/bird_metadata.h"

#include <algorithm>
#include <array>
#include <span>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kForeign = "bird.";
constexpr std::string_view kSymmetry = "sample.properties_symmetry";
constexpr std::string_view kSolidAngle = "instrumentation.detection_system.solid_angle";
constexpr std::string_view kNotKnown = "NA";

/// A text that the schema requires: where it stands, which key of ours tells it, and what is
/// written where nothing does.
struct Field {
    std::string_view path;
    std::string_view key;
    std::string_view otherwise;
};
constexpr std::array<Field, 15> kFields{{
    {"schema",
     "",
     "https://raw.githubusercontent.com/BiRD-project/BiRD_view/master/BRDF_JSON_schema/"
     "brdf_json_schema_v1.0.json"},
    {"id", "", "urn:gonio:brdf"},
    {"type", "", "BRDF"},
    {"timestamp", key::kDate, "1970-01-01T00:00:00Z"},
    {"provenance.organization", "", kNotKnown},
    {"provenance.location.country", "", kNotKnown},
    {"provenance.location.city", "", kNotKnown},
    {"provenance.location.street", "", kNotKnown},
    {"provenance.location.building_nr", "", kNotKnown},
    {"provenance.location.postal_code", "", kNotKnown},
    {"provenance.email", "", "unknown@example.invalid"},
    {"provenance.contact_person", "", kNotKnown},
    {"description", "", "BRDF by direction pair and channel."},
    {"method", "", "measurement"},
    {"environment", "", kNotKnown},
}};

const Field* fieldAt(std::string_view path) {
    const auto found = std::find_if(
        kFields.begin(), kFields.end(), [&](const Field& field) { return field.path == path; });
    return found == kFields.end() ? nullptr : &*found;
}

/// RFC 3339: 2026-01-31T12:00:00Z, or with an offset, or a fraction of a second.
bool isTimestamp(std::string_view text) {
    constexpr std::string_view kShape = "dddd-dd-ddTdd:dd:dd";
    if (text.size() <= kShape.size()) return false;
    for (std::size_t i = 0; i < kShape.size(); ++i) {
        const bool digit = text[i] >= '0' && text[i] <= '9';
        if (kShape[i] == 'd' ? !digit : text[i] != kShape[i]) return false;
    }
    const std::string_view zone = text.substr(kShape.size());
    return zone == "Z" || zone.front() == '+' || zone.front() == '-' || zone.front() == '.';
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

class MetadataReader {
public:
    explicit MetadataReader(JsonScan& scan) : scan_(scan) {}

    std::optional<BirdMetadata> read() {
        if (!value("")) return std::nullopt;
        std::vector<std::string> own;
        if (!comments_.empty()) own = linesOf(comments_);
        Metadata told = metadataOfLines(own);
        // What our own lines say is more exact than the schema's fields.
        for (auto& [name, text] : told.values) read_.about.set(name, std::move(text));
        read_.about.comments = std::move(told.comments);
        return std::move(read_);
    }

private:
    bool value(const std::string& path) {
        switch (scan_.next()) {
            case JsonToken::ObjectBegin: return object(path);
            case JsonToken::ArrayBegin: return array(path);
            case JsonToken::String: keep(path, scan_.text()); return true;
            case JsonToken::Number:
            case JsonToken::Literal: keep(path, std::string(scan_.raw())); return true;
            default: return false;
        }
    }
    bool object(const std::string& path) {
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ObjectEnd) return true;
            if (token != JsonToken::Key) return false;
            const std::string inner = path.empty() ? scan_.text() : path + "." + scan_.text();
            const bool fits = inner.size() <= kLongestPath;
            if (!fits) ++read_.leftOut;
            if (fits ? !value(inner) : !scan_.skipValue()) return false;
        }
    }
    /// Elements by number; a metadata file has few.
    bool array(const std::string& path) {
        JsonScan ahead = scan_;
        for (std::size_t number = 0; ahead.next() != JsonToken::ArrayEnd; ++number) {
            if (number >= kMostElements) {
                ++read_.leftOut;
                return scan_.skipRest();
            }
            if (!value(path + "." + std::to_string(number))) return false;
            ahead = scan_;
        }
        return scan_.next() == JsonToken::ArrayEnd;
    }

    void keep(const std::string& path, std::string text) {
        const Field* field = fieldAt(path);
        if (path == "comments") {
            comments_ = std::move(text);
        } else if (path == kSymmetry) {
            read_.symmetry = std::move(text);
        } else if (field != nullptr && text == field->otherwise) {
            return;
        } else if (field != nullptr && !field->key.empty()) {
            read_.about.set(field->key, std::move(text));
        } else if (const std::string_view known = keyAt(path); !known.empty()) {
            if (text != kNotKnown) read_.about.set(known, std::move(text));
        } else if (read_.about.values.size() >= kMostValues) {
            ++read_.leftOut;
        } else if (text != kNotKnown && !isOurFiller(path, text)) {
            read_.about.set(std::string(kForeign) + path, std::move(text));
        }
    }
    static std::string_view keyAt(std::string_view path) {
        if (path == "sample.name") return key::kSample;
        if (path == "software.version") return key::kSoftware;
        if (path == "instrumentation.serial_number") return key::kRig;
        if (path == std::string(kSolidAngle) + ".value") return key::kSolidAngle;
        return {};
    }
    static bool isOurFiller(std::string_view path, std::string_view text) {
        return (path == std::string(kSolidAngle) + ".unit" && text == "sr") ||
               (path == "software.name" && text == "gonio");
    }

    // A path is kept with each value: what a file may ask for is bounded here.
    static constexpr std::size_t kMostElements = 256;
    static constexpr std::size_t kMostValues = 4096;
    static constexpr std::size_t kLongestPath = 256;
    JsonScan& scan_;
    BirdMetadata read_;
    std::string comments_;
};

/// Objects of texts, indented by tabs as the schema's own example is.
class MetadataWriter {
public:
    explicit MetadataWriter(const Metadata& about) : about_(about) {}

    std::string written(bool isotropic) {
        text_ = "{";
        for (const std::string_view path : {"schema", "id", "type", "timestamp"}) field(path);
        open("provenance");
        field("provenance.organization");
        open("location");
        for (const Field& one : kFields) {
            if (one.path.starts_with("provenance.location.")) field(one.path);
        }
        close();
        for (const std::string_view path : {"provenance.email", "provenance.contact_person"}) {
            field(path);
        }
        close();
        for (const std::string_view path : {"description", "method"}) field(path);
        instrumentation();
        open("software");
        put("name", jsonString(told("bird.software.name", "gonio")));
        put("version", jsonString(told(key::kSoftware, kNotKnown)));
        close();
        open("sample");
        put("name", jsonString(told(key::kSample, kNotKnown)));
        put("properties_symmetry", isotropic ? "\"isotropic\"" : "\"anisotropic\"");
        close();
        field("environment");
        comments();
        return text_ + "\n\t}";
    }

private:
    void line() {
        text_ += text_.back() == '{' ? "\n" : ",\n";
        text_.append(depth_, '\t');
    }
    void put(std::string_view name, const std::string& json) {
        line();
        text_ += jsonString(name) + ": " + json;
    }
    void open(std::string_view name) {
        put(name, "{");
        ++depth_;
    }
    void close() {
        --depth_;
        text_ += "\n";
        text_.append(depth_, '\t');
        text_ += "}";
    }
    [[nodiscard]] std::string_view told(std::string_view name, std::string_view otherwise) const {
        const std::string_view value = about_.at(name);
        return value.empty() ? otherwise : value;
    }
    void field(std::string_view path) {
        const Field& one = *fieldAt(path);
        std::string_view value =
            told(one.key.empty() ? std::string(kForeign) + std::string(path) : std::string(one.key),
                 one.otherwise);
        if (path == "timestamp" && !isTimestamp(value)) value = one.otherwise;
        put(path.substr(path.rfind('.') + 1), jsonString(value));
    }
    /// An object needs a detector with a solid angle, or the schema refuses it.
    void instrumentation() {
        const auto angle = parseDouble(about_.at(key::kSolidAngle));
        if (!angle) return put("instrumentation", jsonString(kNotKnown));
        open("instrumentation");
        put("name", jsonString(told("bird.instrumentation.name", kNotKnown)));
        if (!about_.at(key::kRig).empty()) put("serial_number", jsonString(about_.at(key::kRig)));
        open("illumination_system");
        put("name", jsonString(kNotKnown));
        open("source");
        put("name", jsonString(kNotKnown));
        close();
        close();
        open("detection_system");
        put("name", jsonString(kNotKnown));
        put("sensors", "[{\"name\": \"NA\"}]");
        put("solid_angle", "{\"value\": " + shortest(*angle) + ", \"unit\": \"sr\"}");
        close();
        close();
    }
    void comments() {
        const std::vector<std::string> lines = metadataLines(about_);
        if (lines.empty()) return;
        std::string all;
        for (const std::string& one : lines) all += (&one == lines.data() ? "" : "\n") + one;
        if (!all.empty()) put("comments", jsonString(all));
    }

    const Metadata& about_;
    std::string text_;
    std::size_t depth_ = 2;
};

}  // namespace

std::optional<BirdMetadata> readBirdMetadata(JsonScan& scan) { return MetadataReader(scan).read(); }

std::string birdMetadataJson(const Metadata& about, bool isotropic) {
    return MetadataWriter(about).written(isotropic);
}

}  // namespace gonio::proc
