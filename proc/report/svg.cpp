#include "proc/report/svg.h"

#include <algorithm>
#include <cstddef>

#include "proc/core/number_text.h"
#include "proc/report/markup_text.h"

namespace gonio::proc {
namespace {

std::string number(double v) { return fixed(v, 1); }

std::string attribute(std::string_view name, std::string_view value) {
    return " " + std::string(name) + "=\"" + std::string(value) + "\"";
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

void Svg::image(Point corner, Point size, std::string_view uri) {
    body_ += "<image" + attribute("x", number(corner.x)) + attribute("y", number(corner.y)) +
             attribute("width", number(size.x)) + attribute("height", number(size.y)) +
             attribute("style", "image-rendering:pixelated") + attribute("href", uri) + "/>\n";
}

void Svg::text(Point at, std::string_view words, Anchor anchor, double size) {
    const std::string_view where = anchor == Anchor::Start    ? "start"
                                   : anchor == Anchor::Middle ? "middle"
                                                              : "end";
    body_ += "<text" + attribute("x", number(at.x)) + attribute("y", number(at.y)) +
             attribute("font-size", number(size)) + attribute("text-anchor", where) + ">" +
             markupText(words) + "</text>\n";
}

void Svg::title(Point at, std::string_view words) {
    constexpr double kSize = 15;
    constexpr double kLetter = 0.65 * kSize;  // DejaVu Sans, a wide one
    const double room = std::max(0.0, (width_ - at.x) / kLetter);
    text(at, shortenedText(words, static_cast<std::size_t>(room)), Anchor::Start, kSize);
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
