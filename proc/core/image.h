#pragma once
// A dense picture, row-major, row 0 on top. Pixel (x, y): x to the right, y down.

#include <cassert>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

struct Size {
    int width = 0;
    int height = 0;

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    bool operator==(const Size&) const = default;
};

template <class T>
class Image {
public:
    Image() = default;
    explicit Image(Size size, T fill = T{}) : size_(size), pixels_(size.pixels(), fill) {}
    Image(Size size, std::vector<T> pixels) : size_(size), pixels_(std::move(pixels)) {
        assert(pixels_.size() == size_.pixels());
    }

    [[nodiscard]] Size size() const { return size_; }
    [[nodiscard]] int width() const { return size_.width; }
    [[nodiscard]] int height() const { return size_.height; }
    [[nodiscard]] bool empty() const { return pixels_.empty(); }

    [[nodiscard]] T& at(int x, int y) { return pixels_[offset(x, y)]; }
    [[nodiscard]] const T& at(int x, int y) const { return pixels_[offset(x, y)]; }
    [[nodiscard]] std::span<T> pixels() { return pixels_; }
    [[nodiscard]] std::span<const T> pixels() const { return pixels_; }
    [[nodiscard]] std::span<T> row(int y) {
        return std::span(pixels_).subspan(offset(0, y), static_cast<std::size_t>(size_.width));
    }
    [[nodiscard]] std::span<const T> row(int y) const {
        return std::span(pixels_).subspan(offset(0, y), static_cast<std::size_t>(size_.width));
    }
    bool operator==(const Image&) const = default;

private:
    [[nodiscard]] std::size_t offset(int x, int y) const {
        assert(x >= 0 && x < size_.width && y >= 0 && y < size_.height);
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
               static_cast<std::size_t>(x);
    }
    Size size_;
    std::vector<T> pixels_;
};

}  // namespace gonio
