#pragma once
// The only door to OpenEXR: a file as plain parts, each with text attributes and float or unsigned
// 32-bit channels of one size, floats as halves where asked; one part or several, scan lines, ZIP.
// Bytes in memory, so that a reader sees
// the whole file and its length before anything else.
//
// Decoding never trusts the bytes: attribute sizes, picture sizes, part count and compression are
// checked by our own walk over the headers before the library sees them, and what the library
// throws becomes an Error.

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proc/core/image.h"
#include "proc/core/result.h"

namespace gonio::proc {

struct ExrPart {
    std::string name;
    Size size;
    std::map<std::string, std::string> text;
    std::map<std::string, std::vector<float>> numbers{};  ///< attributes of several floats
    /// The floats are stored in 16 bits, rounded to nearest; decoding widens them exactly.
    bool half = false;
    bool packed = true;                                        ///< by ZIP; not read back
    std::map<std::string, std::vector<float>> floats;          ///< row-major, size.pixels() long
    std::map<std::string, std::vector<std::uint32_t>> counts;  ///< likewise
};

struct ExrLimits {
    Size largest;
    std::size_t parts = 0;
    std::size_t bytes = std::numeric_limits<std::size_t>::max();  ///< of all channels, decoded
    std::size_t bytesOfAPart = std::numeric_limits<std::size_t>::max();  ///< of one part's
};

/// At least one part; names differ; every channel has size.pixels() values.
[[nodiscard]] Result<std::string> encodeExr(std::span<const ExrPart> parts);
[[nodiscard]] Result<std::vector<ExrPart>> decodeExr(std::string_view bytes, ExrLimits limits);

}  // namespace gonio::proc
