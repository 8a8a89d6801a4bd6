#include "proc/report/png.h"

#include <png.h>

#include <algorithm>
#include <string_view>

namespace gonio::proc {
namespace {

constexpr std::size_t kMostColours = 256;

bool sound(const IndexedPicture& picture) {
    const auto& [width, height, pixels, colours] = picture;
    if (width < 1 || height < 1 || colours.empty() || colours.size() > kMostColours) return false;
    return pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height) &&
           *std::max_element(pixels.begin(), pixels.end()) < colours.size();
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
        std::uint32_t group = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            group = group << 8 | (i < count ? static_cast<unsigned char>(bytes[at + i]) : 0U);
        }
        for (std::size_t i = 0; i < 4; ++i)
            text += i <= count ? kDigits[group >> (18 - 6 * i) & 63U] : '=';
    }
    return text;
}

}  // namespace

Result<std::string> encodePng(const IndexedPicture& picture) {
    if (!sound(picture)) return Error{ErrorKind::Internal, "png: no picture of indexed colours"};
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(picture.width);
    image.height = static_cast<png_uint_32>(picture.height);
    image.format = PNG_FORMAT_RGBA_COLORMAP;
    image.colormap_entries = static_cast<png_uint_32>(picture.colours.size());
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::string bytes(size, '\0');
    const int done = png_image_write_to_memory(
        &image, bytes.data(), &size, 0, picture.pixels.data(), 0, picture.colours.data());
    png_image_free(&image);
    if (done == 0) return Error{ErrorKind::Internal, std::string("png: ") + image.message};
    bytes.resize(size);
    return bytes;
}

std::string pngUri(std::string_view png) { return "data:image/png;base64," + base64(png); }

}  // namespace gonio::proc
