#pragma once
// Glare pixel by pixel and source by source, as proc/optics/glare.h states it: slow and obvious.

#include <cmath>
#include <vector>

#include "proc/optics/glare.h"

namespace gonio::test {

/// What the lens makes of x.
inline Image<double> withGlare(const Image<double>& x,
                               const proc::FieldPixels& field,
                               const proc::GlareSpread& spread) {
    struct At {
        int x, y;
    };
    std::vector<At> pixels;
    double light = 0;
    for (int y = 0; y < x.height(); ++y) {
        for (int u = field.inRow(y).begin; u < field.inRow(y).end; ++u) {
            pixels.push_back({u, y});
            light += x.at(u, y);
        }
    }
    // By squared distance, as all are whole.
    std::vector<double> shape;
    const int farthest = x.width() * x.width() + x.height() * x.height();
    for (int squared = 0; squared <= farthest; ++squared)
        shape.push_back(proc::haloShape(std::sqrt(squared), spread.radius, spread.exponent));
    const auto k = [&](const At& a, const At& b) {
        const int dx = a.x - b.x, dy = a.y - b.y;
        return shape[static_cast<std::size_t>(dx * dx + dy * dy)];
    };
    Image<double> y = x;
    for (const At& i : pixels) {
        y.at(i.x, i.y) *= 1 - spread.share();
        y.at(i.x, i.y) += spread.everywhere * light / static_cast<double>(pixels.size());
    }
    for (const At& j : pixels) {
        if (x.at(j.x, j.y) == 0) continue;
        double landing = 0;
        for (const At& i : pixels) landing += k(i, j);
        for (const At& i : pixels)
            y.at(i.x, i.y) += spread.halo * x.at(j.x, j.y) * k(i, j) / landing;
    }
    return y;
}

inline Image<float> toFloat(const Image<double>& image) {
    Image<float> out(image.size());
    for (std::size_t i = 0; i < out.pixels().size(); ++i)
        out.pixels()[i] = static_cast<float>(image.pixels()[i]);
    return out;
}

}  // namespace gonio::test
