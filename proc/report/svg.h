#pragma once
// The few SVG elements that our plots are made of. Coordinates are user units (pixels at scale 1),
// x to the right, y down. Text may be anything: it is escaped, and what no XML may hold (control
// characters, bytes that are no UTF-8) becomes '?'.

#include <string>
#include <string_view>
#include <vector>

namespace gonio::proc {

struct Point {
    double x = 0;
    double y = 0;
};

struct Stroke {
    std::string colour = "#333";
    double width = 1;
    std::string dash;  ///< e.g. "3 3"; empty: solid
};

enum class Anchor {
    Start,
    Middle,
    End
};

class Svg {
public:
    Svg(double width, double height);

    void line(Point from, Point to, const Stroke& stroke);
    void polyline(const std::vector<Point>& points, const Stroke& stroke);
    void polygon(const std::vector<Point>& points, std::string_view fill, double opacity);
    void circle(Point centre, double radius, const Stroke& stroke);
    void rectangle(Point corner, Point size, std::string_view fill);
    /// Ready-made path data, stroked one unit wide without smoothing, so that neighbours leave no
    /// seam: runs of raster pixels.
    void runs(std::string_view pathData, std::string_view colour);
    /// Ready-made data of a picture, each of whose pixels stays a rectangle.
    void image(Point corner, Point size, std::string_view uri);
    void text(Point at, std::string_view words, Anchor anchor = Anchor::Start, double size = 11);
    /// Large, and cut with dots where it would leave the picture.
    void title(Point at, std::string_view words);

    /// The whole document.
    [[nodiscard]] std::string document() const;

private:
    double width_;
    double height_;
    std::string body_;
};

}  // namespace gonio::proc
