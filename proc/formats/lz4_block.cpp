#include "proc/formats/lz4_block.h"

#include <cstdint>

namespace gonio::proc {
namespace {

constexpr std::size_t kMore = 15;  ///< a length of 15 in a token goes on in the bytes behind it
constexpr std::size_t kShortestCopy = 4;

class Tokens {
public:
    explicit Tokens(std::string_view block) : block_(block) {}

    [[nodiscard]] bool done() const { return at_ == block_.size(); }
    [[nodiscard]] std::optional<std::size_t> byte() {
        if (done()) return std::nullopt;
        return static_cast<std::uint8_t>(block_[at_++]);
    }
    /// What follows a length of four bits: bytes of 255 and one that is less.
    [[nodiscard]] std::optional<std::size_t> length(std::size_t bits) {
        std::size_t sum = bits;
        for (std::size_t more = bits == kMore ? 255 : 0; more == 255;) {
            const auto next = byte();
            if (!next) return std::nullopt;
            more = *next;
            sum += more;
        }
        return sum;
    }
    [[nodiscard]] std::optional<std::string_view> literals(std::size_t count) {
        if (count > block_.size() - at_) return std::nullopt;
        at_ += count;
        return block_.substr(at_ - count, count);
    }

private:
    std::string_view block_;
    std::size_t at_ = 0;
};

/// Appends what a copy stands for; false where it does not fit.
bool copy(Tokens& tokens, std::size_t bits, std::size_t size, std::string& out) {
    const auto low = tokens.byte();
    const auto high = tokens.byte();
    if (!low || !high) return false;
    const std::size_t back = *low | *high << 8U;
    const auto length = tokens.length(bits);
    if (!length || back == 0 || back > out.size()) return false;
    const std::size_t count = *length + kShortestCopy;
    if (count > size - out.size()) return false;
    for (std::size_t i = 0; i < count; ++i) out += out[out.size() - back];  // may overlap itself
    return true;
}

}  // namespace

std::optional<std::string> decodeLz4(std::string_view block, std::size_t size) {
    Tokens tokens(block);
    std::string out;
    out.reserve(size);
    while (const auto token = tokens.byte()) {
        const auto length = tokens.length(*token >> 4U);
        const auto literals = length ? tokens.literals(*length) : std::nullopt;
        if (!literals || literals->size() > size - out.size()) return std::nullopt;
        out += *literals;
        if (tokens.done()) break;  // the last token has literals only
        if (!copy(tokens, *token & 15U, size, out)) return std::nullopt;
    }
    if (out.size() != size) return std::nullopt;
    return out;
}

}  // namespace gonio::proc
