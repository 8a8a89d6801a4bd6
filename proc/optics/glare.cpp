#include "proc/optics/glare.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

constexpr int kPitch = 16;      // pixels between nodes
constexpr int kIterations = 2;  // leave share()^2 of the glare
constexpr double kMatters = 1e-3;

Size nodesOver(Size picture) {
    return {(picture.width - 1) / kPitch + 2, (picture.height - 1) / kPitch + 2};
}

/// The share of the node behind that a pixel's middle has, by its place between two nodes.
constexpr std::array<float, kPitch> kBehind = [] {
    std::array<float, kPitch> shares{};
    for (std::size_t i = 0; i < shares.size(); ++i) {
        shares[i] = (static_cast<float>(i) + 0.5F) / kPitch;
    }
    return shares;
}();

using Row = Eigen::Map<Eigen::ArrayXf>;
using ConstRow = Eigen::Map<const Eigen::ArrayXf>;

Row rowOf(Image<float>& image, int y) {
    const std::span<float> row = image.row(y);
    return {row.data(), static_cast<Eigen::Index>(row.size())};
}

ConstRow rowOf(const Image<float>& image, int y) {
    const std::span<const float> row = image.row(y);
    return {row.data(), static_cast<Eigen::Index>(row.size())};
}

Image<float> kernelOf(Size nodes, double radius, double exponent) {
    Image<float> kernel({2 * nodes.width - 1, 2 * nodes.height - 1});
    for (int y = 0; y < kernel.height(); ++y) {
        for (int x = 0; x < kernel.width(); ++x) {
            const double r = std::hypot(x - nodes.width + 1, y - nodes.height + 1) * kPitch;
            kernel.at(x, y) = static_cast<float>(haloShape(r, radius, exponent));
        }
    }
    return kernel;
}

/// The brightest of the nearest finite pixels to the left, right, above and below; 0: none.
float nearestBright(const Image<float>& image, int x, int y) {
    float bright = 0;
    constexpr std::array<std::array<int, 2>, 4> kWays{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (const auto& [dx, dy] : kWays) {
        int u = x + dx, v = y + dy;
        while (u >= 0 && u < image.width() && v >= 0 && v < image.height()) {
            if (std::isfinite(image.at(u, v))) {
                bright = std::max(bright, image.at(u, v));
                break;
            }
            u += dx;
            v += dy;
        }
    }
    return bright;
}

struct Filled {
    Image<float> picture;  ///< finite throughout
    double share = 0;      ///< of the field's light
};

Filled fill(const Image<float>& radiance, const FieldPixels& field) {
    Filled filled{.picture = radiance};
    double all = 0, added = 0;
    for (int y = 0; y < radiance.height(); ++y) {
        const auto [begin, end] = field.inRow(y);
        for (int x = begin; x < end; ++x) {
            float& pixel = filled.picture.at(x, y);
            if (!std::isfinite(pixel)) {
                pixel = nearestBright(radiance, x, y);
                added += double{pixel};
            }
            all += double{pixel};
        }
    }
    if (all > 0) filled.share = added / all;
    return filled;
}

}  // namespace

double haloShape(double r, double radius, double exponent) {
    return std::pow(1 + r * r / (radius * radius), -exponent);
}

FieldPixels::FieldPixels(const LensMap& map, const Window& window, Radians field)
    : size_(window.sent()), rows_(static_cast<std::size_t>(size_.height)) {
    const auto sees = [&](int x, int y) {
        const auto wo = map.directionAt(
            {window.x + (x + 0.5) * window.binning, window.y + (y + 0.5) * window.binning});
        return wo && wo->theta() <= field;
    };
    for (int y = 0; y < size_.height; ++y) {
        Span& row = rows_[static_cast<std::size_t>(y)];
        row.end = size_.width;
        while (row.begin < row.end && !sees(row.begin, y)) ++row.begin;
        while (row.end > row.begin && !sees(row.end - 1, y)) --row.end;
        count_ += row.end - row.begin;
    }
}

GlareFilter::GlareFilter(const GlareSpread& spread,
                         const LensMap& map,
                         const Window& window,
                         Radians field)
    : spread_(spread),
      field_(map, window, field),
      kernel_(kernelOf(nodesOver(window.sent()), spread.radius / window.binning, spread.exponent)),
      seeing_(nodeSums(Image<float>(window.sent(), 1))),
      landing_(haloSums(seeing_)) {}

/// Each pixel of the field split between its four nodes.
GlareFilter::Nodes GlareFilter::nodeSums(const Image<float>& picture) const {
    Nodes sums(nodesOver(picture.size()));
    std::vector<float> line(static_cast<std::size_t>(sums.width()));
    for (int y = 0; y < picture.height(); ++y) {
        const auto [begin, end] = field_.inRow(y);
        std::fill(line.begin(), line.end(), 0.F);
        const std::span<const float> row = picture.row(y);
        for (int x = begin; x < end; ++x) {
            const auto node = static_cast<std::size_t>(x / kPitch);
            const float value = row[static_cast<std::size_t>(x)];
            const float behind = value * kBehind[static_cast<std::size_t>(x % kPitch)];
            line[node] += value - behind;
            line[node + 1] += behind;
        }
        const float below = kBehind[static_cast<std::size_t>(y % kPitch)];
        const ConstRow all(line.data(), sums.width());
        rowOf(sums, y / kPitch) += (1 - below) * all;
        rowOf(sums, y / kPitch + 1) += below * all;
    }
    return sums;
}

/// At each node, what all nodes send there by K.
GlareFilter::Nodes GlareFilter::haloSums(const Nodes& sources) const {
    const int width = sources.width(), height = sources.height();
    Nodes sums(sources.size());
    parallelFor(static_cast<std::size_t>(height), [&](IndexRange rows) {
        for (int y = static_cast<int>(rows.begin); y < static_cast<int>(rows.end); ++y) {
            Row sum = rowOf(sums, y);
            for (int v = 0; v < height; ++v) {
                const ConstRow shape = rowOf(kernel_, y - v + height - 1);
                for (int u = 0; u < width; ++u) {
                    const float source = sources.at(u, v);
                    if (source != 0) sum += source * shape.segment(width - 1 - u, width);
                }
            }
        }
    });
    return sums;
}

/// The glare at each node, of what the nodes hold.
GlareFilter::Nodes GlareFilter::glareAt(const Nodes& sources) const {
    Nodes relative(sources.size());
    double light = 0;
    for (std::size_t i = 0; i < sources.pixels().size(); ++i) {
        if (sources.pixels()[i] == 0) continue;
        light += double{sources.pixels()[i]};
        relative.pixels()[i] = sources.pixels()[i] / landing_.pixels()[i];
    }
    Nodes glare = haloSums(relative);
    const auto even = static_cast<float>(spread_.everywhere * light / field_.count());
    const auto halo = static_cast<float>(spread_.halo);
    for (float& node : glare.pixels()) node = even + halo * node;
    return glare;
}

GlareFilter::Cleaned GlareFilter::clean(const Image<float>& radiance) const {
    assert(radiance.size() == field_.size());
    Cleaned cleaned{.radiance = radiance};
    const double share = spread_.share();
    if (share <= 0) return cleaned;
    const Filled filled = fill(radiance, field_);
    cleaned.filled = filled.share;
    const Nodes seen = nodeSums(filled.picture);
    const auto kept = static_cast<float>(1 - share);
    Nodes light = seen;
    Nodes glare;
    for (int i = 0; i < kIterations; ++i) {
        glare = glareAt(light);
        for (std::size_t n = 0; n < light.pixels().size(); ++n) {
            light.pixels()[n] = (seen.pixels()[n] - seeing_.pixels()[n] * glare.pixels()[n]) / kept;
        }
    }
    std::vector<float> line(static_cast<std::size_t>(glare.width()));
    for (int y = 0; y < radiance.height(); ++y) {
        const auto [begin, end] = field_.inRow(y);
        const float below = kBehind[static_cast<std::size_t>(y % kPitch)];
        Row(line.data(), glare.width()) =
            (1 - below) * rowOf(glare, y / kPitch) + below * rowOf(glare, y / kPitch + 1);
        const std::span<float> row = cleaned.radiance.row(y);
        for (int x = begin; x < end; ++x) {
            const auto node = static_cast<std::size_t>(x / kPitch);
            const float behind = kBehind[static_cast<std::size_t>(x % kPitch)];
            const float here = line[node] + behind * (line[node + 1] - line[node]);
            float& pixel = row[static_cast<std::size_t>(x)];
            pixel = (pixel - here) / kept;
        }
    }
    return cleaned;
}

CellSignal GlareFilter::bin(const MergedState& state, const Binning& binning) const {
    if (spread_.share() <= 0) return binning.bin(state);
    const Cleaned cleaned = clean(state.radiance);
    auto [out, seen] = binning.bin(cleaned.radiance, state.variance, state.radiance);
    const double uRelative = std::hypot(spread_.uRelative, cleaned.filled);
    for (std::size_t cell = 0; cell < out.size(); ++cell) {
        if (!out.present(cell)) continue;
        const double takenOff = std::abs(seen[cell] - out.signal[cell]);
        out.uGlare[cell] = uRelative * takenOff;
        if (takenOff > kMatters * std::abs(out.signal[cell])) {
            out.flags[cell].set(Flag::GlareCorrected);
        }
    }
    return out;
}

}  // namespace gonio::proc
