#pragma once
// The parameters of one lobe of a model's spec, asked for by name. Remembers the first complaint;
// what was given and never asked for is unknown.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/result.h"

namespace gonio::proc {

struct ValueRange {
    double low;
    double high;
};

class SpecParameters {
public:
    /// `items` are NAME=VALUE.
    SpecParameters(std::string lobe, const std::vector<std::string_view>& items);

    [[nodiscard]] bool has(const std::string& key) const { return values_.contains(key); }

    [[nodiscard]] LedBands bands(const std::string& key, ValueRange range);
    [[nodiscard]] LedBands bandsOr(const std::string& key, ValueRange range, double otherwise);
    [[nodiscard]] double number(const std::string& key, ValueRange range);
    [[nodiscard]] double numberOr(const std::string& key, ValueRange range, double otherwise);
    [[nodiscard]] std::string text(const std::string& key);
    /// The index of the value among `choices`; 0 when it is not given.
    [[nodiscard]] std::size_t choice(const std::string& key,
                                     const std::vector<std::string>& choices);
    void complain(const std::string& what);
    /// With the kind of the error, such as a file's.
    void refuse(const Error& error);

    /// After all parameters were asked for: the first complaint, unknown names included.
    [[nodiscard]] std::optional<Error> verdict();

private:
    std::string take(const std::string& key);
    double checked(const std::string& key, std::string_view text, ValueRange range);

    std::string lobe_;
    std::map<std::string, std::string> values_;
    std::vector<std::string> known_;
    std::optional<Error> error_;
};

/// "a", "a,b": the parts between the separators, at least one.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace gonio::proc
