#include "proc/models/spec_parameters.h"

#include <algorithm>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

std::string listed(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
    return list;
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t start = 0;;) {
        const std::size_t end = text.find(separator, start);
        parts.push_back(text.substr(start, end - start));
        if (end == std::string_view::npos) return parts;
        start = end + 1;
    }
}

SpecParameters::SpecParameters(std::string lobe, const std::vector<std::string_view>& items)
    : lobe_(std::move(lobe)) {
    for (std::string_view item : items) {
        const std::size_t equals = item.find('=');
        if (equals == std::string_view::npos) {
            complain("'" + std::string(item) + "' is not NAME=VALUE");
            continue;
        }
        const std::string key(item.substr(0, equals));
        std::string_view value = item.substr(equals + 1);
        if (value.size() > 1 && value.starts_with('"') && value.ends_with('"')) {
            value = value.substr(1, value.size() - 2);
        }
        if (!values_.emplace(key, value).second) {
            complain("parameter '" + key + "' is given twice");
        }
    }
}

LedBands SpecParameters::bands(const std::string& key, ValueRange range) {
    const std::string text = take(key);
    const std::vector<std::string_view> parts = split(text, '/');
    if (parts.size() != 1 && parts.size() != 3) {
        complain("parameter '" + key + "=" + text + "': wanted one value or r/g/b");
        return {};
    }
    LedBands bands;
    for (Band b : kBands) {
        bands[b] = checked(key, parts[parts.size() == 1 ? 0 : index(b)], range);
    }
    return bands;
}

LedBands SpecParameters::bandsOr(const std::string& key, ValueRange range, double otherwise) {
    if (has(key)) return bands(key, range);
    known_.push_back(key);
    return LedBands::all(otherwise);
}

double SpecParameters::number(const std::string& key, ValueRange range) {
    return checked(key, take(key), range);
}

double SpecParameters::numberOr(const std::string& key, ValueRange range, double otherwise) {
    if (has(key)) return number(key, range);
    known_.push_back(key);
    return otherwise;
}

std::string SpecParameters::text(const std::string& key) {
    std::string text = take(key);
    if (text.empty()) complain("parameter '" + key + "' is empty");
    return text;
}

std::size_t SpecParameters::choice(const std::string& key,
                                   const std::vector<std::string>& choices) {
    if (!has(key)) {
        known_.push_back(key);
        return 0;
    }
    const std::string text = take(key);
    const auto found = std::find(choices.begin(), choices.end(), text);
    if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
    complain("parameter '" + key + "=" + text + "': wanted one of " + listed(choices));
    return 0;
}

void SpecParameters::complain(const std::string& what) { refuse({ErrorKind::Usage, what}); }

void SpecParameters::refuse(const Error& error) {
    if (!error_) error_ = error.in("model " + lobe_);
}

std::optional<Error> SpecParameters::verdict() {
    for (const auto& [key, value] : values_) {
        if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
        complain("unknown parameter '" + key + "'; it takes " + listed(known_));
    }
    return error_;
}

std::string SpecParameters::take(const std::string& key) {
    known_.push_back(key);
    const auto found = values_.find(key);
    if (found != values_.end()) return found->second;
    complain("parameter '" + key + "' is missing");
    return "";
}

double SpecParameters::checked(const std::string& key, std::string_view text, ValueRange range) {
    const std::optional<double> value = parseDouble(text);
    if (value && *value >= range.low && *value <= range.high) return *value;
    complain("parameter '" + key + "=" + std::string(text) + "': wanted a number in [" +
             shortest(range.low) + ", " + shortest(range.high) + "]");
    return range.low;
}

}  // namespace gonio::proc
