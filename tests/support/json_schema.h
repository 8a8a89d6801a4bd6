#pragma once
// Holds JSON against a schema of docs/json: the keywords of draft 2020-12 that are used there, and
// no other. A schema with a keyword that is not known here is itself wrong.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

namespace gonio::test {

class JsonSchema {
public:
    using Json = nlohmann::json;

    /// The schema of docs/json/NAME.json.
    explicit JsonSchema(const std::string& name) : root_(load(name + ".json")) {}

    /// Each way in which it does not conform, a line; empty: it conforms.
    [[nodiscard]] std::string complaints(const Json& value) const {
        std::string text;
        check(root_, root_, value, "$", text);
        return text;
    }

    static std::filesystem::path folder() { return GONIO_SOURCE_DIR "/docs/json"; }

private:
    static Json load(const std::string& file) {
        std::ifstream in(folder() / file);
        return Json::parse(in);  // a schema that is none fails the test by its exception
    }
    static bool isOf(const std::string& type, const Json& value) {
        if (type == "object") return value.is_object();
        if (type == "array") return value.is_array();
        if (type == "string") return value.is_string();
        if (type == "integer") return value.is_number_integer();
        if (type == "number") return value.is_number();
        if (type == "boolean") return value.is_boolean();
        return type == "null" && value.is_null();
    }
    static bool isOfAny(const Json& types, const Json& value) {
        if (types.is_string()) return isOf(types, value);
        return std::any_of(
            types.begin(), types.end(), [&](const Json& type) { return isOf(type, value); });
    }
    static void refer(const Json& root,
                      const std::string& reference,
                      const Json& value,
                      const std::string& at,
                      std::string& text) {
        const std::size_t hash = reference.find('#');
        const std::string file = reference.substr(0, hash);
        const Json other = file.empty() ? root : load(file);
        const std::string pointer = hash == std::string::npos ? "" : reference.substr(hash + 1);
        check(other, other.at(Json::json_pointer(pointer)), value, at, text);
    }
    static void checkObject(const Json& root,
                            const Json& schema,
                            const Json& value,
                            const std::string& at,
                            std::string& text) {
        for (const Json& name : schema.value("required", Json::array())) {
            if (!value.contains(name)) text += at + ": without " + name.dump() + "\n";
        }
        const Json known = schema.value("properties", Json::object());
        const Json others = schema.value("additionalProperties", Json(true));
        for (const auto& [name, member] : value.items()) {
            const std::string there = at + "." + name;
            if (known.contains(name)) {
                check(root, known[name], member, there, text);
            } else if (others == false) {
                text += there + ": not in the schema\n";
            } else {
                check(root, others, member, there, text);
            }
        }
    }
    static void check(const Json& root,
                      const Json& schema,
                      const Json& value,
                      const std::string& at,
                      std::string& text) {
        if (schema == true) return;
        for (const auto& [keyword, wanted] : schema.items()) {
            if (keyword == "$ref") {
                refer(root, wanted, value, at, text);
            } else if (keyword == "type") {
                if (!isOfAny(wanted, value)) text += at + ": wanted " + wanted.dump() + "\n";
            } else if (keyword == "const") {
                if (value != wanted) text += at + ": wanted " + wanted.dump() + "\n";
            } else if (keyword == "enum") {
                const bool in = std::find(wanted.begin(), wanted.end(), value) != wanted.end();
                if (!in) text += at + ": " + value.dump() + " is not in " + wanted.dump() + "\n";
            } else if (keyword == "pattern") {
                const std::regex pattern(wanted.get<std::string>());
                const bool fits =
                    !value.is_string() || std::regex_search(value.get<std::string>(), pattern);
                if (!fits) text += at + ": " + value.dump() + " is not as " + wanted.dump() + "\n";
            } else if (keyword == "minimum") {
                if (value.is_number() && value < wanted) text += at + ": below the least\n";
            } else if (keyword == "items") {
                for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
                    check(root, wanted, value[i], at + "[" + std::to_string(i) + "]", text);
                }
            } else if (keyword == "properties") {
                if (value.is_object()) checkObject(root, schema, value, at, text);
            } else if (!isSilent(keyword)) {
                text += at + ": schema keyword '" + keyword + "' is not known to this test\n";
            }
        }
        const bool bare = !schema.contains("properties") && value.is_object();
        if (bare) checkObject(root, schema, value, at, text);
    }
    /// Says nothing of the value, or is looked at with another.
    static bool isSilent(const std::string& keyword) {
        for (const char* silent :
             {"$schema", "$defs", "title", "description", "required", "additionalProperties"}) {
            if (keyword == silent) return true;
        }
        return false;
    }

    Json root_;
};

/// What does not conform in a document that names its schema; `kind` tells documents of `info`.
inline std::string complaintsOf(const nlohmann::json& document) {
    const std::string schema = document.value("schema", "");
    constexpr std::string_view kHead = "gonio/", kTail = "/1";
    if (!schema.starts_with(kHead) || !schema.ends_with(kTail)) return "no schema: " + schema;
    std::string name = schema.substr(kHead.size(), schema.size() - kHead.size() - kTail.size());
    if (name == "info") {
        const std::string kind = document.value("kind", "");
        const bool own = std::filesystem::exists(JsonSchema::folder() / ("info-" + kind + ".json"));
        name += "-" + (own ? kind : std::string("file"));
    }
    if (!std::filesystem::exists(JsonSchema::folder() / (name + ".json"))) {
        return "no docs/json/" + name + ".json";
    }
    std::string complaints = JsonSchema(name).complaints(document);
    // A job carries the document that came of it.
    const bool carries = document.contains("result") && document["result"].is_object();
    return carries ? complaints + complaintsOf(document["result"]) : complaints;
}

}  // namespace gonio::test
