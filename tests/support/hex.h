#pragma once
// Byte vectors as the protocol page prints them: "20 88 77".

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

namespace gonio::test {

inline std::vector<std::uint8_t> hex(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::uint8_t> bytes;
    for (unsigned byte = 0; in >> std::hex >> byte;)
        bytes.push_back(static_cast<std::uint8_t>(byte));
    return bytes;
}

}  // namespace gonio::test
