#pragma once
// Numbers of binary files, little-endian, at any alignment: on a little-endian machine their own
// bytes.

#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace gonio::proc {

static_assert(std::endian::native == std::endian::little, "binary files are read as they lie");

/// Precondition: at + sizeof(T) <= bytes.size().
template <class T>
[[nodiscard]] T littleAt(std::string_view bytes, std::size_t at) {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(T));
    return value;
}

template <class T>
void appendLittle(std::string& bytes, T value) {
    static_assert(std::is_arithmetic_v<T>);
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

}  // namespace gonio::proc
