#pragma once
// The memory that frames are made in: buffers that wait to be used, and used again, so that nothing
// is allocated while a rig sends. They are made before the rig is told to expose. Never more wait
// than were asked for at once.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "proc/core/image.h"

namespace gonio::driver {

/// `Shape` is what a Buffer is made from, and what its size() says.
template <class Buffer, class Shape>
class FrameMemory {
public:
    /// At least `count` buffers of `shape` wait from now on; those of another shape are let go.
    void provide(Shape shape, std::size_t count) {
        if (!(shape == shape_)) {
            spares_.clear();
            most_ = 0;
        }
        shape_ = shape;
        most_ = std::max(most_, count);
        spares_.reserve(most_);
        while (spares_.size() < count) spares_.emplace_back(shape);
    }
    /// So many of `shape` have been asked for: as many wait, but for those that are in use or kept.
    [[nodiscard]] std::size_t most(const Shape& shape) const { return shape == shape_ ? most_ : 0; }
    /// One that waits; where none does, a new one. What it holds is of no meaning.
    [[nodiscard]] Buffer take() {
        if (spares_.empty()) return Buffer(shape_);
        Buffer buffer = std::move(spares_.back());
        spares_.pop_back();
        return buffer;
    }
    /// A buffer that somebody else has kept may be given back too: nothing happens.
    void giveBack(Buffer&& buffer) {
        const bool wanted = !buffer.empty() && buffer.size() == shape_;
        if (wanted && spares_.size() < most_) spares_.push_back(std::move(buffer));
    }

private:
    Shape shape_{};
    std::size_t most_ = 0;
    std::vector<Buffer> spares_;
};

/// Frames as they were sent.
using WireMemory = FrameMemory<std::vector<std::uint8_t>, std::size_t>;
using PixelMemory = FrameMemory<Image<std::uint16_t>, Size>;

}  // namespace gonio::driver
