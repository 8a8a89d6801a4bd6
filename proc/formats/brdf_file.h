#pragma once
// One door for every file that holds a BRDF: recognised by its content, read as the table that its
// format keeps, with what it says of itself and what to know before believing it.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proc/core/result.h"
#include "proc/formats/format.h"
#include "proc/table/brdf_rows.h"
#include "proc/table/half_difference_table.h"
#include "proc/table/klems_table.h"
#include "proc/table/metadata.h"
#include "proc/table/sample_set.h"
#include "proc/table/specular_table.h"
#include "proc/table/spherical_table.h"
#include "proc/table/tensor_table.h"

namespace gonio::proc {

using BrdfContent = std::variant<SampleSet,
                                 SpecularTable,
                                 SphericalTable,
                                 HalfDifferenceTable,
                                 TensorTable,
                                 KlemsTable,
                                 BrdfRows>;

struct BrdfFile {
    Format format = Format::Gonio;
    BrdfContent content;
    Metadata about;
    std::vector<std::string> warnings;
    /// Of a file of one value per pair: the LEDs' band that it is, where its wavelength or else its
    /// name tells.
    std::optional<Band> band{};
    std::vector<Band> bands{};  ///< of several, those that are wanted; empty: all

    /// The content where it is this kind of table, else null.
    template <class Table>
    [[nodiscard]] const Table* as() const {
        return std::get_if<Table>(&content);
    }
};

/// The bytes of a file of this format; `name` stands in errors. A File error for a raw capture,
/// which is no BRDF yet; a Usage error for readings that need a black reference.
[[nodiscard]] Result<BrdfFile> decodeBrdf(Format format,
                                          std::string_view bytes,
                                          std::string_view name);

/// `from`: not by its content, but as this.
[[nodiscard]] Result<BrdfFile> readBrdf(const std::filesystem::path& path,
                                        std::optional<Format> from = {});

/// What the file's values are: bands, wavelengths, tristimulus values.
[[nodiscard]] std::vector<Channel> channelsOf(const BrdfFile& file);

/// A file of more incidences than this is finer than the LEDs: it is asked at theirs.
inline constexpr std::size_t kMostFileIncidences = 36;

/// Incidences that the file holds, ascending, each once; empty for one that holds all of them.
[[nodiscard]] std::vector<Radians> incidencesOf(const BrdfFile& file);

}  // namespace gonio::proc
