#pragma once
// The keys of one TOML file, each read with the domain it must lie in. The first that is missing or
// out of its domain is remembered as an error that names the file, the key and what is wanted.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/units.h"

namespace gonio::daemon {

class TomlKeys {
public:
    /// File error where it cannot be read, is not TOML, or is not of this schema ("gonio/rig/1").
    [[nodiscard]] static Result<TomlKeys> read(const std::filesystem::path& file,
                                               std::string_view schema);
    TomlKeys(TomlKeys&&) noexcept;
    TomlKeys& operator=(TomlKeys&&) noexcept;
    ~TomlKeys();

    // Keys are dotted: "led.drift_relative". Where one is wrong, some value of its domain is given.

    [[nodiscard]] double positive(std::string_view key);
    [[nodiscard]] double positiveOr(std::string_view key, double otherwise);
    [[nodiscard]] double notNegativeOr(std::string_view key, double otherwise);
    /// From 0 to below 1.
    [[nodiscard]] double relative(std::string_view key);
    [[nodiscard]] double relativeOr(std::string_view key, double otherwise);
    [[nodiscard]] std::string text(std::string_view key);
    /// An empty one is none.
    [[nodiscard]] std::string textOr(std::string_view key, std::string otherwise);
    /// One of the two.
    [[nodiscard]] int either(std::string_view key, int first, int second);
    /// Ascending.
    [[nodiscard]] std::vector<Microseconds> wholeMicroseconds(std::string_view key);
    /// Descending.
    [[nodiscard]] std::vector<double> fractions(std::string_view key);

    /// Complains of the first key that was not asked for.
    void nothingElse();
    void complain(std::string_view key, std::string_view wanted);
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }
    /// The file's bytes.
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    struct Table;
    TomlKeys(std::string file, std::string bytes, std::unique_ptr<Table> table);
    [[nodiscard]] bool holds(std::string_view key);
    [[nodiscard]] std::vector<double> numbers(std::string_view key);

    std::string file_, bytes_;
    std::unique_ptr<Table> table_;
    std::vector<std::string> asked_;
    std::optional<Error> error_;
};

}  // namespace gonio::daemon
