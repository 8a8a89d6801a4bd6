#include "proc/optics/spot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "proc/core/median.h"

namespace gonio::proc {
namespace {

// A spot stands out of everything else by this much; white paper does not.
constexpr double kMinContrast = 50;
constexpr double kEdgeShare = 0.1;   // of the peak: what belongs to the spot
constexpr double kMostPixels = 400;  // sensor pixels; one degree is about 35
constexpr double kMinPixels = 4;
constexpr double kMinInside = 0.95;   // of all spot pixels, near their centroid
constexpr double kPixelLimit = 0.02;  // sensor pixels: finite pixels, uneven source

Error refused(const MergedState& state, const std::string& what) {
    return {ErrorKind::Quality,
            "LED " + std::to_string(state.led) + ": " + what + "; is a clean mirror placed?"};
}

/// Mean over 3 x 3 pixels around (x, y): one hot pixel is no peak.
double patch(const Image<float>& image, int x, int y) {
    double sum = 0;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) sum += image.at(x + i, y + j);
    }
    return sum / 9;
}

/// Bright, and so are its neighbours.
bool belongs(const Image<float>& image, int x, int y, double edge) {
    const double own = image.at(x, y);
    return own >= edge && (9 * patch(image, x, y) - own) / 8 >= edge / 2;
}

double medianOf(const Image<float>& image) {
    return median(std::vector<float>(image.pixels().begin(), image.pixels().end()));
}

struct Moments {
    double weight = 0, x = 0, y = 0, count = 0;

    void add(double w, double atX, double atY) {
        weight += w;
        x += w * atX;
        y += w * atY;
        ++count;
    }
};

}  // namespace

Result<Spot> findSpot(const MergedState& state) {
    const Image<float>& image = state.radiance;
    if (image.width() < 3 || image.height() < 3) return refused(state, "the picture is too small");
    if (state.allSaturatedPixels > 0) {
        return Error{ErrorKind::Quality,
                     "LED " + std::to_string(state.led) + ": " +
                         std::to_string(state.allSaturatedPixels) +
                         " pixels of the mirror are saturated in every frame; dim the LED"};
    }
    double peak = 0;
    for (int y = 1; y < image.height() - 1; ++y) {
        for (int x = 1; x < image.width() - 1; ++x) peak = std::max(peak, patch(image, x, y));
    }
    if (!(peak > kMinContrast * std::max(0.0, medianOf(image))) || peak <= 0) {
        return refused(state, "no bright spot");
    }
    const double edge = kEdgeShare * peak;
    Moments spot;
    double variance = 0;
    for (int y = 1; y < image.height() - 1; ++y) {
        for (int x = 1; x < image.width() - 1; ++x) {
            if (!belongs(image, x, y, edge)) continue;
            spot.add(image.at(x, y), x, y);
        }
    }
    if (spot.count < kMinPixels) return refused(state, "no bright spot");
    const double cx = spot.x / spot.weight;
    const double cy = spot.y / spot.weight;
    const double binning = state.window.binning;
    const double sensorPixels = spot.count * binning * binning;
    if (sensorPixels > kMostPixels) {
        return refused(state, "the bright region is too large for the image of an LED");
    }
    const double reach = 2 * std::sqrt(spot.count / kPi) + 2;
    double inside = 0;
    for (int y = 1; y < image.height() - 1; ++y) {
        for (int x = 1; x < image.width() - 1; ++x) {
            if (!belongs(image, x, y, edge)) continue;
            const double away = std::hypot(x - cx, y - cy);
            if (away > reach) continue;
            ++inside;
            variance += state.variance.at(x, y) * away * away / 2;
        }
    }
    if (inside < kMinInside * spot.count) return refused(state, "more than one bright spot");
    const double sigma = std::sqrt(variance) / spot.weight;
    return Spot{
        .at = {state.window.x + (cx + 0.5) * binning, state.window.y + (cy + 0.5) * binning},
        .sigma = std::hypot(sigma, kPixelLimit) * binning,
        .pixels = sensorPixels};
}

}  // namespace gonio::proc
