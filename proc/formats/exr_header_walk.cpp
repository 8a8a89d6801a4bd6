#include "proc/formats/exr_header_walk.h"

#include <array>
#include <cstdint>
#include <optional>

#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kMagic("\x76\x2f\x31\x01", 4);
constexpr std::uint32_t kMultiPart = 0x1000;
constexpr std::uint32_t kKnownFlags = 0x0400 | kMultiPart;  // long names, several parts
constexpr int kLastLossless = 3;                            // none, RLE, ZIPS, ZIP

Error malformed(const std::string& what) { return {ErrorKind::File, "exr: " + what}; }

/// Little-endian words and zero-ended names, never beyond the end.
class Bytes {
public:
    explicit Bytes(std::string_view bytes) : left_(bytes) {}

    std::optional<std::uint32_t> word() {
        if (left_.size() < 4) return std::nullopt;
        std::uint32_t value = 0;
        for (unsigned i = 0; i < 4; ++i) {
            value |= static_cast<std::uint32_t>(static_cast<unsigned char>(left_[i])) << (8 * i);
        }
        left_.remove_prefix(4);
        return value;
    }
    std::optional<std::string_view> name() {
        constexpr std::size_t kLongestName = 255;
        const std::size_t end = left_.substr(0, kLongestName + 1).find('\0');
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view text = left_.substr(0, end);
        left_.remove_prefix(end + 1);
        return text;
    }
    std::optional<std::string_view> block(std::size_t size) {
        if (left_.size() < size) return std::nullopt;
        const std::string_view text = left_.substr(0, size);
        left_.remove_prefix(size);
        return text;
    }
    [[nodiscard]] bool empty() const { return left_.empty(); }
    [[nodiscard]] bool atZero() const { return !left_.empty() && left_[0] == '\0'; }

private:
    std::string_view left_;
};

/// Box: first and last pixel of both axes, as signed words.
bool windowFits(std::string_view box, Size largest) {
    Bytes words(box);
    std::array<std::int64_t, 4> corner{};
    for (auto& c : corner) {
        const auto word = words.word();
        if (!word) return false;
        c = static_cast<std::int32_t>(*word);
    }
    const std::int64_t width = corner[2] - corner[0] + 1;
    const std::int64_t height = corner[3] - corner[1] + 1;
    return width >= 1 && height >= 1 && width <= largest.width && height <= largest.height;
}

/// Bytes of a value of these types, whatever the header says: the library reads as many.
struct FixedSize {
    std::string_view type;
    std::size_t bytes;
};
constexpr std::array kFixedSizes{
    FixedSize{"box2f", 16},         FixedSize{"box2i", 16},   FixedSize{"chromaticities", 32},
    FixedSize{"compression", 1},    FixedSize{"double", 8},   FixedSize{"envmap", 1},
    FixedSize{"float", 4},          FixedSize{"int", 4},      FixedSize{"keycode", 28},
    FixedSize{"lineOrder", 1},      FixedSize{"m33d", 72},    FixedSize{"m33f", 36},
    FixedSize{"m44d", 128},         FixedSize{"m44f", 64},    FixedSize{"rational", 8},
    FixedSize{"deepImageState", 1}, FixedSize{"tiledesc", 9}, FixedSize{"timecode", 8},
    FixedSize{"v2d", 16},           FixedSize{"v2f", 8},      FixedSize{"v2i", 8},
    FixedSize{"v3d", 24},           FixedSize{"v3f", 12},     FixedSize{"v3i", 12},
};

/// Names with 16 bytes each, and an empty one exactly at the end.
bool isChannelList(std::string_view value) {
    constexpr std::size_t kChannel = 16;
    Bytes bytes(value);
    while (!bytes.atZero()) {
        if (!bytes.name() || !bytes.block(kChannel)) return false;
    }
    return bytes.block(1) && bytes.empty();
}

bool isStringVector(std::string_view value) {
    Bytes bytes(value);
    while (!bytes.empty()) {
        const auto size = bytes.word();
        if (!size || !bytes.block(*size)) return false;
    }
    return true;
}

/// Width, height and four bytes of each pixel.
bool isPreview(std::string_view value) {
    Bytes bytes(value);
    const auto width = bytes.word();
    const auto height = bytes.word();
    if (!width || !height) return false;
    const std::uint64_t pixels = std::uint64_t{*width} * *height;
    return pixels <= value.size() && bytes.block(static_cast<std::size_t>(4 * pixels)) &&
           bytes.empty();
}

/// The library reads exactly these bytes for a value of this type: else it would take what follows
/// for something else than we do.
bool valueFits(std::string_view type, std::string_view value) {
    for (const FixedSize& fixed : kFixedSizes) {
        if (type == fixed.type) return value.size() == fixed.bytes;
    }
    if (type == "chlist") return isChannelList(value);
    if (type == "floatvector") return value.size() % sizeof(float) == 0;
    if (type == "stringvector") return isStringVector(value);
    if (type == "preview") return isPreview(value);
    return true;  // text, and what the library does not know: as long as the header says
}

/// What is wrong with one attribute of a header; empty when nothing is.
std::string complaint(std::string_view name, std::string_view value, Size largest) {
    if (name == "dataWindow" && !windowFits(value, largest)) {
        return "picture size outside 1 x 1 .. " + std::to_string(largest.width) + " x " +
               std::to_string(largest.height);
    }
    if (name == "compression" && (value.size() != 1 || value[0] < 0 || value[0] > kLastLossless)) {
        return "compression is not one of none, RLE, ZIPS, ZIP";
    }
    if (name == "type" && value != "scanlineimage") return "a part is not of scan lines";
    return "";
}

Result<void> walkHeader(Bytes& bytes, Size largest) {
    while (!bytes.atZero()) {
        const auto name = bytes.name();
        const auto type = name ? bytes.name() : std::nullopt;
        const auto size = type ? bytes.word() : std::nullopt;
        const auto value = size ? bytes.block(*size) : std::nullopt;
        if (!value) return malformed("truncated in a header");
        if (!valueFits(*type, *value)) {
            return malformed("attribute " + shown(*name) + " is not " + shown(*type) +
                             ", which it " + "says that it is");
        }
        if (const std::string wrong = complaint(*name, *value, largest); !wrong.empty()) {
            return malformed(wrong);
        }
    }
    (void)bytes.block(1);
    return {};
}

}  // namespace

Result<void> walkExrHeaders(std::string_view file, ExrLimits limits) {
    if (!file.starts_with(kMagic)) return malformed("not an OpenEXR file");
    Bytes bytes(file.substr(kMagic.size()));
    const auto version = bytes.word();
    if (!version) return malformed("truncated in a header");
    if ((*version & 0xffU) != 2 || (*version & ~(0xffU | kKnownFlags)) != 0) {
        return malformed("a version or kind that is not read: scan lines of version 2 are");
    }
    std::size_t parts = 0;
    do {
        if (++parts > limits.parts) {
            return malformed("more than " + std::to_string(limits.parts) + " parts");
        }
        if (auto header = walkHeader(bytes, limits.largest); !header) return header.error();
    } while ((*version & kMultiPart) != 0 && !bytes.atZero());
    return {};
}

}  // namespace gonio::proc
