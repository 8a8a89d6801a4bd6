#pragma once
// Little-endian fields at fixed offsets, as every report and chunk of GRP/1 has them.

#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace gonio::driver {

/// Precondition: the field lies inside `bytes`.
template <std::integral T>
[[nodiscard]] T get(std::span<const std::uint8_t> bytes, std::size_t offset) {
    assert(offset + sizeof(T) <= bytes.size());
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
        value |= std::uint64_t{bytes[offset + i]} << (8 * i);
    return static_cast<T>(value);
}

template <std::integral T>
void put(std::span<std::uint8_t> bytes, std::size_t offset, T value) {
    assert(offset + sizeof(T) <= bytes.size());
    const auto bits = static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(value));
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        bytes[offset + i] = static_cast<std::uint8_t>(bits >> (8 * i));
    }
}

}  // namespace gonio::driver
