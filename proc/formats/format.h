#pragma once
// The file formats by name, as the command line and errors call them, and what each is good for.

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "proc/core/result.h"

namespace gonio::proc {

enum class Format {
    Gonio,
    Graw,
    Zemax,
    LightTools,
    Merl,
    Utia,
    Rgl,
    Bird,
    Astm,
    Speos,
    Mbsdf,
    Ssdd,
    Pab,
    Alta,
    Csv,
    ExrTiles,
    ExrAtlas,
    Rt300s,
    Klems,
};
inline constexpr std::size_t kFormatCount = 19;

struct FormatFacts {
    Format format;
    std::string_view name;       ///< of --from and --to: "zemax"
    std::string_view title;      ///< in messages: "Zemax BSDF"
    std::string_view extension;  ///< that a file gets: ".bsdf"
    bool writes = true;          ///< else it is only read
};

/// All of them, in the order of the enumeration.
[[nodiscard]] std::span<const FormatFacts, kFormatCount> formats();
[[nodiscard]] const FormatFacts& factsOf(Format format);
[[nodiscard]] std::string_view name(Format format);
/// A Usage error that lists the names for what is none.
[[nodiscard]] Result<Format> parseFormat(std::string_view name);

/// Its files list directions in any order, and nothing answers between them but an estimator.
[[nodiscard]] bool listsDirections(Format format);

/// The format that a file of this name is written in. Usage error for an extension that names none,
/// or several: it says which, and that --to decides.
[[nodiscard]] Result<Format> formatToWrite(const std::filesystem::path& path);

}  // namespace gonio::proc
