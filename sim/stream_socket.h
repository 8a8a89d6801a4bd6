#pragma once
// A connected stream socket that never blocks longer than it is told to, and that is closed with
// its owner.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>

#include "proc/core/stopwatch.h"

namespace gonio::sim {

class StreamSocket {
public:
    /// Takes the descriptor over.
    explicit StreamSocket(int descriptor);
    ~StreamSocket();
    StreamSocket(StreamSocket&& other) noexcept;
    StreamSocket& operator=(StreamSocket&& other) noexcept;

    [[nodiscard]] int descriptor() const { return descriptor_; }
    /// Bytes read, 0 when `wait` passed without any; empty: the other end is gone.
    [[nodiscard]] std::optional<std::size_t> read(std::span<std::uint8_t> buffer, Nanoseconds wait);
    /// False: the other end is gone, or took nothing for `patience`, or `stop` was asked for.
    [[nodiscard]] bool write(std::span<const std::uint8_t> bytes,
                             Nanoseconds patience,
                             const std::stop_token& stop = {});
    /// A TCP connection whose other end says nothing is asked whether it is there, and ended when
    /// it does not answer for so long: computers and cables go without a word.
    void watchOtherEnd();

private:
    int descriptor_;
};

}  // namespace gonio::sim
