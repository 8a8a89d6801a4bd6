#pragma once
// What one column of values in a file is: a band of the LEDs, a tristimulus value, a wavelength, or
// something that the file does not name.

#include <optional>
#include <string>
#include <vector>

#include "proc/core/bands.h"

namespace gonio::proc {

struct Channel {
    /// "R", "G", "B": as the file calls them; "X", "Y", "Z": CIE tristimulus values; empty: a
    /// wavelength, or one value of which nothing is known.
    std::string name;
    std::optional<double> nanometres;

    bool operator==(const Channel&) const = default;

    /// One of the LEDs' bands.
    [[nodiscard]] static Channel of(Band band) {
        constexpr std::string_view kLetters = "RGB";
        return {std::string(kLetters.substr(index(band), 1)), gonio::nanometres(band)};
    }
    /// The LED's own channel where the wavelength is one of theirs, else one without a name.
    [[nodiscard]] static Channel at(double nanometres) {
        for (const Band band : kBands) {
            if (gonio::nanometres(band) == nanometres) return of(band);
        }
        return {"", nanometres};
    }
    /// R, G, B.
    [[nodiscard]] static std::vector<Channel> ofBands() {
        return {of(Band::R), of(Band::G), of(Band::B)};
    }
};

}  // namespace gonio::proc
