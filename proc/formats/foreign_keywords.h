#pragma once
// Keywords of a file that have no key of ours: kept among the metadata under the format's prefix,
// and written as keywords again where the format can have them.

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proc/table/metadata.h"

namespace gonio::proc {

/// Takes the entries under `prefix` out of `rest` that the format's reader would keep: one word,
/// none of `taken` (lower case: the format's own keywords), none twice whatever its case. The
/// others stay in `rest`, as free text. Pairs of keyword, without the prefix, and value.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> takeForeignKeywords(
    Metadata& rest, std::string_view prefix, std::span<const std::string_view> taken);

}  // namespace gonio::proc
