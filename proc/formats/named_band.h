#pragma once
// Which band of the LEDs a file of one value is: by the wavelength that it states, or by its name.

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "proc/core/bands.h"
#include "proc/table/channel.h"

namespace gonio::proc {

/// By the last of its words that names one, R, G, B, red, green or blue: "paint_R", "Red-paint".
[[nodiscard]] std::optional<Band> bandOfName(const std::filesystem::path& file);
/// The band within 25 nm; empty where there is none.
[[nodiscard]] std::optional<Band> bandOfWavelength(double nanometres);

/// By its name, else by its wavelength.
[[nodiscard]] std::optional<Band> bandOfChannel(const Channel& channel);

/// What a comment of the file says of its wavelength in nm, as converters write it: "Wavelength
/// (nm) = 525"; else "Light source: red laser (650 nm, ...)".
[[nodiscard]] std::optional<double> wavelengthIn(std::span<const std::string> comments);

}  // namespace gonio::proc
