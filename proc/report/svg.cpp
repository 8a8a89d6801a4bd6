#include "proc/report/svg.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

std::string number(double v) { return fixed(v, 1); }

std::string attribute(std::string_view name, std::string_view value) {
    return " " + std::string(name) + "=\"" + std::string(value) + "\"";
}

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

std::string escaped(std::string_view words) {
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

/// At most `most` letters, the last three of them dots where there are more.
std::string shortened(std::string_view words, std::size_t most) {
    std::vector<std::size_t> starts;
    for (std::size_t at = 0; at < words.size();
         at += std::max<std::size_t>(firstLetter(words.substr(at)).bytes, 1)) {
        starts.push_back(at);
    }
    if (starts.size() <= most) return std::string(words);
    return std::string(words.substr(0, starts[most < 3 ? 0 : most - 3])) + "...";
}

std::string strokeAttributes(const Stroke& stroke) {
    std::string text = attribute("stroke", stroke.colour) +
                       attribute("stroke-width", number(stroke.width)) + attribute("fill", "none");
    if (!stroke.dash.empty()) text += attribute("stroke-dasharray", stroke.dash);
    return text;
}

std::string pointList(const std::vector<Point>& points) {
    std::string text;
    for (const Point& p : points) text += number(p.x) + "," + number(p.y) + " ";
    return text;
}

}  // namespace

Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::line(Point from, Point to, const Stroke& stroke) { polyline({from, to}, stroke); }

void Svg::polyline(const std::vector<Point>& points, const Stroke& stroke) {
    body_ +=
        "<polyline" + attribute("points", pointList(points)) + strokeAttributes(stroke) + "/>\n";
}

void Svg::polygon(const std::vector<Point>& points, std::string_view fill, double opacity) {
    body_ += "<polygon" + attribute("points", pointList(points)) + attribute("fill", fill) +
             attribute("fill-opacity", fixed(opacity, 2)) + "/>\n";
}

void Svg::circle(Point centre, double radius, const Stroke& stroke) {
    body_ += "<circle" + attribute("cx", number(centre.x)) + attribute("cy", number(centre.y)) +
             attribute("r", number(radius)) + strokeAttributes(stroke) + "/>\n";
}

void Svg::rectangle(Point corner, Point size, std::string_view fill) {
    body_ += "<rect" + attribute("x", number(corner.x)) + attribute("y", number(corner.y)) +
             attribute("width", number(size.x)) + attribute("height", number(size.y)) +
             attribute("fill", fill) + "/>\n";
}

void Svg::runs(std::string_view pathData, std::string_view colour) {
    body_ += "<path" + attribute("d", pathData) + attribute("stroke", colour) +
             attribute("stroke-width", "1") + attribute("fill", "none") +
             attribute("shape-rendering", "crispEdges") + "/>\n";
}

void Svg::text(Point at, std::string_view words, Anchor anchor, double size) {
    const std::string_view where = anchor == Anchor::Start    ? "start"
                                   : anchor == Anchor::Middle ? "middle"
                                                              : "end";
    body_ += "<text" + attribute("x", number(at.x)) + attribute("y", number(at.y)) +
             attribute("font-size", number(size)) + attribute("text-anchor", where) + ">" +
             escaped(words) + "</text>\n";
}

void Svg::title(Point at, std::string_view words) {
    constexpr double kSize = 15;
    constexpr double kLetter = 0.65 * kSize;  // DejaVu Sans, a wide one
    const double room = std::max(0.0, (width_ - at.x) / kLetter);
    text(at, shortened(words, static_cast<std::size_t>(room)), Anchor::Start, kSize);
}

std::string Svg::document() const {
    const std::string w = number(width_);
    const std::string h = number(height_);
    return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", w) +
           attribute("height", h) + attribute("viewBox", "0 0 " + w + " " + h) +
           " font-family=\"DejaVu Sans, Arial, sans-serif\" fill=\"#222\">\n" +
           "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + body_ + "</svg>\n";
}

}  // namespace gonio::proc
