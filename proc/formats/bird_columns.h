#pragma once
// The columns of a BiRD file as it lists them: one number or text for each entry, whatever the
// layout of the file was. What the rows are made of (proc/formats/bird.h).

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/result.h"
#include "proc/table/metadata.h"

namespace gonio::proc::bird {

enum Number : std::size_t {
    ThetaI,
    PhiI,
    ThetaR,
    PhiR,
    Value,
    Combined,
    WavelengthI,
    WavelengthR,
    Random,
    Systematic,
    FlagMask,
    Negative,
    kNumbers
};
inline constexpr std::array<std::string_view, kNumbers> kNumberNames{"theta_i",
                                                                     "phi_i",
                                                                     "theta_r",
                                                                     "phi_r",
                                                                     "BRDF",
                                                                     "uBRDF",
                                                                     "wavelength_i",
                                                                     "wavelength_r",
                                                                     "u_random",
                                                                     "u_systematic",
                                                                     "flags",
                                                                     "negative"};
enum Word : std::size_t {
    PolarizationI,
    PolarizationR,
    ChannelName,
    kWords
};
inline constexpr std::array<std::string_view, kWords> kWordNames{
    "polarization_i", "polarization_r", "channel"};

struct NumberColumn {
    bool given = false;
    std::string unit;
    std::vector<double> values;
};

/// Texts of which few differ: each once, and which one each entry has.
struct WordColumn {
    bool given = false;
    std::vector<std::string> texts;
    std::vector<std::uint32_t> values;

    static constexpr std::size_t kMostTexts = 1024;
    /// False: too many.
    bool add(std::string_view text) {
        if (!values.empty() && texts[values.back()] == text) {
            values.push_back(values.back());
            return true;
        }
        const auto found = std::find(texts.begin(), texts.end(), text);
        if (found == texts.end() && texts.size() >= kMostTexts) return false;
        values.push_back(static_cast<std::uint32_t>(found - texts.begin()));
        if (found == texts.end()) texts.emplace_back(text);
        return true;
    }
};

struct Columns {
    std::array<NumberColumn, kNumbers> numbers;
    std::array<WordColumn, kWords> words;
    std::size_t entries = 0;
    /// BRDF.uncertainty: one for all values; used where there is no uBRDF.
    std::optional<double> constantU;
    std::string constantUnit;
    bool coverageIsSaid = false;  ///< k = 1 stands in the comments of uBRDF
    Metadata about;
    std::string symmetry;
    std::vector<std::string> warnings;

    [[nodiscard]] const std::vector<double>& of(Number number) const {
        return numbers[number].values;
    }
    [[nodiscard]] bool has(Number number) const { return numbers[number].given; }
};

/// As they stand in the file. Errors as parseBird() has them.
[[nodiscard]] Result<Columns> readColumns(std::string_view text, std::string_view name);

/// Angles to radians, wavelengths to nanometres, uncertainties to 1/sr, negative values put back;
/// all columns must be there and of one length. The complaint, or empty.
[[nodiscard]] std::string convertColumns(Columns& columns);

}  // namespace gonio::proc::bird
