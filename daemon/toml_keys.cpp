#include "daemon/toml_keys.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

constexpr double kLongestUs = 3.6e9;  // an hour

bool differ(const std::vector<double>& sorted) {
    return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

void collect(const toml::table& table, const std::string& prefix, std::vector<std::string>& keys) {
    for (const auto& [key, value] : table) {
        const std::string path = prefix + std::string(key.str());
        if (const toml::table* const below = value.as_table()) {
            collect(*below, path + ".", keys);
        } else {
            keys.push_back(path);
        }
    }
}

}  // namespace

struct TomlKeys::Table {
    toml::table keys;
    template <class T>
    [[nodiscard]] std::optional<T> value(std::string_view key) const {
        return keys.at_path(key).value<T>();
    }
};

TomlKeys::TomlKeys(std::string file, std::string bytes, std::unique_ptr<Table> table)
    : file_(std::move(file)), bytes_(std::move(bytes)), table_(std::move(table)) {}
TomlKeys::TomlKeys(TomlKeys&&) noexcept = default;
TomlKeys& TomlKeys::operator=(TomlKeys&&) noexcept = default;
TomlKeys::~TomlKeys() = default;

Result<TomlKeys> TomlKeys::read(const std::filesystem::path& file, std::string_view schema) {
    Result<std::string> text = proc::readFile(file);
    if (!text) return text.error();
    auto table = std::make_unique<Table>();
    try {
        table->keys = toml::parse(*text);
    } catch (const toml::parse_error& error) {
        return Error{ErrorKind::File, file.string() + ": " + std::string(error.description())};
    }
    const auto seen = table->value<std::string>("schema");
    TomlKeys keys(file.string(), std::move(*text), std::move(table));
    keys.asked_.emplace_back("schema");
    if (seen == schema) return keys;
    keys.complain("schema",
                  "\"" + std::string(schema) + "\", " +
                      (seen ? "saw \"" + *seen + "\"" : "it is missing") +
                      ": not a file of this kind that this program knows");
    return *keys.error();
}

bool TomlKeys::holds(std::string_view key) {
    asked_.emplace_back(key);
    return static_cast<bool>(table_->keys.at_path(key));
}

double TomlKeys::positive(std::string_view key) {
    asked_.emplace_back(key);
    const auto value = table_->value<double>(key);
    if (value && *value > 0 && std::isfinite(*value)) return *value;
    complain(key, "a number above 0");
    return 1;
}

double TomlKeys::positiveOr(std::string_view key, double otherwise) {
    return holds(key) ? positive(key) : otherwise;
}

double TomlKeys::notNegativeOr(std::string_view key, double otherwise) {
    if (!holds(key)) return otherwise;
    const auto value = table_->value<double>(key);
    if (value && *value >= 0 && std::isfinite(*value)) return *value;
    complain(key, "a number, 0 or above");
    return 0;
}

double TomlKeys::relative(std::string_view key) {
    asked_.emplace_back(key);
    const auto value = table_->value<double>(key);
    if (value && *value >= 0 && *value < 1) return *value;
    complain(key, "a number from 0 to below 1");
    return 0;
}

double TomlKeys::relativeOr(std::string_view key, double otherwise) {
    return holds(key) ? relative(key) : otherwise;
}

std::string TomlKeys::text(std::string_view key) {
    asked_.emplace_back(key);
    const auto value = table_->value<std::string>(key);
    if (!value || value->empty()) complain(key, "a text");
    return value.value_or("");
}

std::string TomlKeys::textOr(std::string_view key, std::string otherwise) {
    return holds(key) && table_->value<std::string>(key) != "" ? text(key) : std::move(otherwise);
}

int TomlKeys::either(std::string_view key, int first, int second) {
    asked_.emplace_back(key);
    const auto value = table_->value<std::int64_t>(key);
    if (value == first || value == second) return static_cast<int>(*value);
    complain(key, std::to_string(first) + " or " + std::to_string(second));
    return first;
}

std::vector<Microseconds> TomlKeys::wholeMicroseconds(std::string_view key) {
    std::vector<double> values = numbers(key);
    std::sort(values.begin(), values.end());
    const bool whole = std::all_of(values.begin(), values.end(), [](double us) {
        return us >= 1 && us <= kLongestUs && us == std::floor(us);
    });
    std::vector<Microseconds> exposures;
    if (!whole || !differ(values)) {
        complain(key, "a list of different whole numbers above 0, an hour at most");
        return exposures;
    }
    for (const double us : values) exposures.emplace_back(static_cast<std::int64_t>(us));
    return exposures;
}

std::vector<double> TomlKeys::fractions(std::string_view key) {
    std::vector<double> values = numbers(key);
    std::sort(values.rbegin(), values.rend());
    const bool inside = std::all_of(
        values.begin(), values.end(), [](double level) { return level > 0 && level < 1; });
    if (!inside || !differ(values)) complain(key, "a list of different numbers between 0 and 1");
    return values;
}

std::vector<double> TomlKeys::numbers(std::string_view key) {
    asked_.emplace_back(key);
    std::vector<double> values;
    const toml::array* const array = table_->keys.at_path(key).as_array();
    if (array != nullptr) {
        for (const toml::node& node : *array) {
            const auto value = node.value<double>();
            if (value && std::isfinite(*value)) values.push_back(*value);
        }
    }
    if (array == nullptr || values.empty() || values.size() != array->size()) {
        complain(key, "a list of numbers");
    }
    return values;
}

void TomlKeys::nothingElse() {
    std::vector<std::string> all;
    collect(table_->keys, "", all);
    for (const std::string& key : all) {
        if (std::find(asked_.begin(), asked_.end(), key) != asked_.end()) continue;
        std::vector<std::string> known = asked_;
        std::sort(known.begin(), known.end());
        known.erase(std::unique(known.begin(), known.end()), known.end());
        std::string list;
        for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
        return complain(key, "one of " + list);
    }
}

void TomlKeys::complain(std::string_view key, std::string_view wanted) {
    if (error_) return;
    error_ = Error{ErrorKind::File,
                   file_ + ": key '" + std::string(key) + "': wanted " + std::string(wanted)};
}

}  // namespace gonio::daemon
