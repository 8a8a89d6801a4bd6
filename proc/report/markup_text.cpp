#include "proc/report/markup_text.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace gonio::proc {
namespace {

/// One letter of UTF-8; `bytes` is 0 where there is none.
struct Letter {
    std::size_t bytes = 0;
    std::uint32_t code = 0;
};

Letter firstLetter(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text.front());
    if (lead < 0x80) return {1, lead};
    const std::size_t bytes = lead < 0xC2   ? 0
                              : lead < 0xE0 ? 2
                              : lead < 0xF0 ? 3
                              : lead < 0xF5 ? 4
                                            : 0;
    if (bytes == 0 || text.size() < bytes) return {};
    std::uint32_t code = lead & (0x7FU >> bytes);
    for (const char c : text.substr(1, bytes - 1)) {
        const auto next = static_cast<unsigned char>(c);
        if ((next & 0xC0U) != 0x80U) return {};
        code = code << 6 | (next & 0x3FU);
    }
    constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
    return code < kLeast[bytes] ? Letter{} : Letter{bytes, code};
}

/// XML 1.0, production 2.
bool allowed(std::uint32_t code) {
    if (code < 0x20) return code == '\t' || code == '\n' || code == '\r';
    return code < 0xD800 || (code > 0xDFFF && code < 0xFFFE) || (code > 0xFFFF && code <= 0x10FFFF);
}

}  // namespace

std::string markupText(std::string_view words) {
    std::string out;
    while (!words.empty()) {
        const Letter letter = firstLetter(words);
        const std::size_t bytes = std::max<std::size_t>(letter.bytes, 1);
        if (letter.bytes == 0 || !allowed(letter.code)) {
            out += '?';
        } else {
            switch (letter.code) {
                case '&': out += "&amp;"; break;
                case '<': out += "&lt;"; break;
                case '>': out += "&gt;"; break;
                case '"': out += "&quot;"; break;
                default: out += words.substr(0, bytes);
            }
        }
        words.remove_prefix(bytes);
    }
    return out;
}

std::string shortenedText(std::string_view words, std::size_t most) {
    std::vector<std::size_t> starts;
    for (std::size_t at = 0; at < words.size();
         at += std::max<std::size_t>(firstLetter(words.substr(at)).bytes, 1)) {
        starts.push_back(at);
    }
    if (starts.size() <= most) return std::string(words);
    return std::string(words.substr(0, starts[most < 3 ? 0 : most - 3])) + "...";
}

}  // namespace gonio::proc
