#include "proc/models/spec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proc/core/number_text.h"
#include "proc/models/ggx.h"
#include "proc/models/lambert.h"
#include "proc/models/oren_nayar.h"
#include "proc/models/sum.h"

namespace gonio::proc {
namespace {

using Lobe = std::unique_ptr<const Scatterer>;

constexpr double kSmallestAlpha = 1e-7;

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t start = 0;;) {
        const std::size_t end = text.find(separator, start);
        parts.push_back(text.substr(start, end - start));
        if (end == std::string_view::npos) return parts;
        start = end + 1;
    }
}

/// '+' joins lobes, except inside a number's exponent ("1e+3").
std::vector<std::string_view> splitLobes(std::string_view spec) {
    std::vector<std::string_view> lobes;
    std::size_t start = 0;
    for (std::size_t i = 0; i < spec.size(); ++i) {
        if (spec[i] != '+') continue;
        const bool exponent = i >= 2 && (spec[i - 1] == 'e' || spec[i - 1] == 'E') &&
                              spec[i - 2] >= '0' && spec[i - 2] <= '9';
        if (exponent) continue;
        lobes.push_back(spec.substr(start, i - start));
        start = i + 1;
    }
    lobes.push_back(spec.substr(start));
    return lobes;
}

struct Range {
    double low;
    double high;
};

/// The parameters of one lobe. Remembers the first complaint; what was not asked for is unknown.
class Parameters {
public:
    Parameters(std::string lobe, const std::vector<std::string_view>& items)
        : lobe_(std::move(lobe)) {
        for (std::string_view item : items) {
            const std::size_t equals = item.find('=');
            if (equals == std::string_view::npos) {
                complain("'" + std::string(item) + "' is not NAME=VALUE");
                continue;
            }
            const std::string key(item.substr(0, equals));
            if (!values_.emplace(key, item.substr(equals + 1)).second) {
                complain("parameter '" + key + "' is given twice");
            }
        }
    }

    [[nodiscard]] bool has(const std::string& key) const { return values_.contains(key); }

    LedBands bands(const std::string& key, Range range) {
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
    double number(const std::string& key, Range range) { return checked(key, take(key), range); }
    /// The index of the value among `choices`; 0 when it is not given.
    std::size_t choice(const std::string& key, const std::vector<std::string>& choices) {
        if (!has(key)) {
            known_.push_back(key);
            return 0;
        }
        const std::string text = take(key);
        const auto found = std::find(choices.begin(), choices.end(), text);
        if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
        std::string list;
        for (const std::string& c : choices) list += (list.empty() ? "" : ", ") + c;
        complain("parameter '" + key + "=" + text + "': wanted one of " + list);
        return 0;
    }
    void complain(const std::string& what) {
        if (!error_) error_ = Error{ErrorKind::Usage, "model " + lobe_ + ": " + what};
    }

    /// After all parameters were asked for: the first complaint, unknown names included.
    [[nodiscard]] std::optional<Error> verdict() {
        for (const auto& [key, value] : values_) {
            if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
            std::string list;
            for (const std::string& k : known_) list += (list.empty() ? "" : ", ") + k;
            complain("unknown parameter '" + key + "'; it takes " + list);
        }
        return error_;
    }

private:
    std::string take(const std::string& key) {
        known_.push_back(key);
        const auto found = values_.find(key);
        if (found != values_.end()) return std::string(found->second);
        complain("parameter '" + key + "' is missing");
        return "";
    }
    double checked(const std::string& key, std::string_view text, Range range) {
        const std::optional<double> value = parseDouble(text);
        if (value && *value >= range.low && *value <= range.high) return *value;
        complain("parameter '" + key + "=" + std::string(text) + "': wanted a number in [" +
                 shortest(range.low) + ", " + shortest(range.high) + "]");
        return range.low;
    }

    std::string lobe_;
    std::map<std::string, std::string_view> values_;
    std::vector<std::string> known_;
    std::optional<Error> error_;
};

Lobe makeLambert(Parameters& p) { return std::make_unique<Lambert>(p.bands("albedo", {0, 1})); }

Lobe makeOrenNayar(Parameters& p) {
    const LedBands albedo = p.bands("albedo", {0, 1});
    return std::make_unique<OrenNayar>(albedo, Radians(p.number("sigma", {0, kPi / 2})));
}

GgxAlpha ggxAlpha(Parameters& p) {
    const Range range{kSmallestAlpha, 1};
    if (p.has("roughness")) {
        const double roughness = p.number("roughness", {std::sqrt(kSmallestAlpha), 1});
        return {roughness * roughness, roughness * roughness};
    }
    if (p.has("alpha_x") || p.has("alpha_y")) {
        const double x = p.number("alpha_x", range);
        return {x, p.number("alpha_y", range)};
    }
    const double alpha = p.number("alpha", range);
    return {alpha, alpha};
}

Lobe makeGgx(Parameters& p) {
    const GgxAlpha alpha = ggxAlpha(p);
    const LedBands f0 = p.bands("f0", {0, 1});
    const auto masking = p.choice("masking", {"height-correlated", "separable"});
    return std::make_unique<Ggx>(
        alpha, f0, masking == 0 ? Masking::HeightCorrelated : Masking::Separable);
}

struct Entry {
    std::string_view name;
    Lobe (*make)(Parameters&);
};
constexpr std::array kModels{
    Entry{"lambert", makeLambert}, Entry{"oren-nayar", makeOrenNayar}, Entry{"ggx", makeGgx}};

Result<Lobe> makeLobe(std::string_view text) {
    std::vector<std::string_view> items = split(text, ',');
    const std::string name(items.front());
    items.erase(items.begin());
    const auto found = std::find_if(
        kModels.begin(), kModels.end(), [&](const Entry& entry) { return entry.name == name; });
    if (found == kModels.end()) {
        std::string list;
        for (const Entry& entry : kModels)
            list += (list.empty() ? "" : ", ") + std::string(entry.name);
        return Error{ErrorKind::Usage, "unknown model '" + name + "'; known are " + list};
    }
    Parameters parameters(name, items);
    Lobe lobe = found->make(parameters);
    if (auto error = parameters.verdict()) return *error;
    return lobe;
}

}  // namespace

Result<std::unique_ptr<const Scatterer>> makeModel(std::string_view spec) {
    std::vector<Lobe> lobes;
    for (std::string_view text : splitLobes(spec)) {
        Result<Lobe> lobe = makeLobe(text);
        if (!lobe) return lobe.error();
        lobes.push_back(std::move(*lobe));
    }
    if (lobes.size() == 1) return std::move(lobes.front());
    return Lobe(std::make_unique<Sum>(std::move(lobes)));
}

}  // namespace gonio::proc
