#include "proc/optics/binning.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

constexpr int kPoints = 4;  // per side of a pixel; twice as many where it is binned
constexpr double kSeenWhole = 0.95;
constexpr double kMostSaturated = 0.02;
constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

struct CellShare {
    std::uint32_t cell = kNoCell;
    std::uint32_t pixel = 0;
    float area = 0;  ///< of the pixel inside the cell, 0..1
};

/// The cells that lie under pixels of one picture.
class PixelCells {
public:
    PixelCells(const LensMap& map, const Window& window) : map_(map), window_(window) {}

    /// Of a point in pixels of the window.
    [[nodiscard]] std::uint32_t cellAt(double x, double y) const {
        const auto wo = map_.directionAt(sensor(x, y));
        const auto cell = wo ? CellGrid::cellAt(*wo) : std::nullopt;
        return cell ? static_cast<std::uint32_t>(*cell) : kNoCell;
    }
    [[nodiscard]] SensorPoint sensor(double x, double y) const {
        return {window_.x + x * window_.binning, window_.y + y * window_.binning};
    }
    /// Adds what pixel (x, y) gives to each cell that it touches.
    void split(int x, int y, std::uint32_t pixel, std::vector<CellShare>& out) const {
        const std::size_t first = out.size();
        const int points = kPoints * std::min(window_.binning, 2);
        for (int j = 0; j < points; ++j) {
            for (int i = 0; i < points; ++i) {
                const std::uint32_t cell = cellAt(x + (i + 0.5) / points, y + (j + 0.5) / points);
                if (cell == kNoCell) continue;
                auto known = std::find_if(out.begin() + static_cast<std::ptrdiff_t>(first),
                                          out.end(),
                                          [&](const CellShare& s) { return s.cell == cell; });
                if (known == out.end()) known = out.insert(known, {cell, pixel, 0});
                known->area += 1.0F / static_cast<float>(points * points);
            }
        }
    }

private:
    const LensMap& map_;
    const Window& window_;
};

}  // namespace

CellSignal CellSignal::missing(std::size_t cells) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {.signal = std::vector(cells, nan),
            .variance = std::vector(cells, nan),
            .nEff = std::vector(cells, 0.0),
            .flags = std::vector(cells, Flags{}),
            .uGlare = std::vector(cells, 0.0)};
}

Binning::Binning(const LensMap& map, const Window& window, Radians field) : window_(window) {
    // A row that ends at the field, to rounding, is inside.
    visibleRows_ = std::min(CellGrid::kRows, static_cast<int>(field.degrees() + 1e-9));
    const Size size = window.sent();
    const PixelCells under(map, window);
    std::vector<float> perCosine(size.pixels()), solidAngle(size.pixels());
    std::vector<std::vector<CellShare>> rows(static_cast<std::size_t>(size.height));
    const double area = window.binning * window.binning;
    pixelSolidAngle_ = area * map.solidAnglePerPixel(map.pointOf(Direction()));
    parallelFor(rows.size(), [&](IndexRange range) {
        const auto corners = [&](std::size_t y) {
            std::vector<std::uint32_t> cells;
            for (int x = 0; x <= size.width; ++x) {
                cells.push_back(under.cellAt(x, static_cast<double>(y)));
            }
            return cells;
        };
        std::vector<std::uint32_t> above = corners(range.begin);
        for (std::size_t y = range.begin; y < range.end; ++y) {
            const std::vector<std::uint32_t> below = corners(y + 1);
            for (int x = 0; x < size.width; ++x) {
                const auto i = static_cast<std::size_t>(x);
                const std::size_t pixel = y * static_cast<std::size_t>(size.width) + i;
                const SensorPoint middle = under.sensor(x + 0.5, static_cast<double>(y) + 0.5);
                const auto wo = map.directionAt(middle);
                if (!wo || !wo->aboveHorizon()) continue;
                perCosine[pixel] = static_cast<float>(1 / wo->z());
                solidAngle[pixel] = static_cast<float>(area * map.solidAnglePerPixel(middle));
                const auto id = static_cast<std::uint32_t>(pixel);
                const std::uint32_t cell = above[i];
                if (cell != kNoCell && cell == above[i + 1] && cell == below[i] &&
                    cell == below[i + 1]) {
                    rows[y].push_back({cell, id, 1});
                } else {
                    under.split(x, static_cast<int>(y), id, rows[y]);
                }
            }
            above = below;
        }
    });
    // Counting sort by cell; within a cell, pixels stay in order.
    firstShare_.assign(CellGrid::count() + 1, 0);
    for (const auto& row : rows) {
        for (const CellShare& share : row) ++firstShare_[share.cell + 1];
    }
    for (std::size_t c = 1; c < firstShare_.size(); ++c) firstShare_[c] += firstShare_[c - 1];
    shares_.resize(firstShare_.back());
    pixelsIn_.assign(CellGrid::count(), 0);
    std::vector<std::size_t> next(firstShare_.begin(), firstShare_.end() - 1);
    for (const auto& row : rows) {
        for (const CellShare& share : row) {
            shares_[next[share.cell]++] = {.pixel = share.pixel,
                                           .weight = share.area * perCosine[share.pixel],
                                           .solidAngle = share.area * solidAngle[share.pixel]};
            pixelsIn_[share.cell] += double{share.area};
        }
    }
}

std::span<const Binning::Share> Binning::sharesOf(std::size_t cell) const {
    return std::span(shares_).subspan(firstShare_[cell], firstShare_[cell + 1] - firstShare_[cell]);
}

CellSignal Binning::blank() const {
    CellSignal signal = CellSignal::missing(CellGrid::count());
    signal.pixelSolidAngle = pixelSolidAngle_;
    return signal;
}

CellSignal Binning::bin(const Image<float>& radiance, const Image<float>& variance) const {
    assert(radiance.size() == window_.sent() && variance.size() == radiance.size());
    const Picture picture{
        .radiance = radiance.pixels(), .variance = variance.pixels(), .second = {}};
    CellSignal out = blank();
    parallelFor(CellGrid::count(), [&](IndexRange cells) {
        for (std::size_t cell = cells.begin; cell < cells.end; ++cell) bin(picture, cell, out);
    });
    return out;
}

Binning::Both Binning::bin(const Image<float>& radiance,
                           const Image<float>& variance,
                           const Image<float>& second) const {
    assert(radiance.size() == window_.sent() && variance.size() == radiance.size() &&
           second.size() == radiance.size());
    const Picture picture{
        .radiance = radiance.pixels(), .variance = variance.pixels(), .second = second.pixels()};
    Both both{.first = blank(), .second = {}};
    both.second = both.first.signal;
    parallelFor(CellGrid::count(), [&](IndexRange cells) {
        for (std::size_t cell = cells.begin; cell < cells.end; ++cell) {
            both.second[cell] = bin(picture, cell, both.first);
        }
    });
    return both;
}

double Binning::bin(const Picture& picture, std::size_t cell, CellSignal& out) const {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (CellGrid::place(cell).row >= visibleRows_) {
        out.flags[cell].set(Flag::Blocked);
        return nan;
    }
    const auto& [radiance, noise, second] = picture;
    double signal = 0, secondSignal = 0;
    double variance = 0;
    double used = 0;       // steradian
    double saturated = 0;  // steradian
    double weights = 0;
    double squares = 0;
    for (const Share& share : sharesOf(cell)) {
        const double omega = share.solidAngle;
        if (!std::isfinite(radiance[share.pixel])) {
            saturated += omega;
            continue;
        }
        const double weight = share.weight;
        signal += weight * radiance[share.pixel];
        if (!second.empty()) secondSignal += weight * second[share.pixel];
        variance += weight * weight * noise[share.pixel];
        used += omega;
        weights += weight;
        squares += weight * weight;
    }
    if (saturated > kMostSaturated * (used + saturated)) {
        out.flags[cell].set(Flag::Saturated);
        return nan;
    }
    if (used + saturated < kSeenWhole * CellGrid::solidAngle(cell)) {
        out.flags[cell].set(Flag::Blocked);
        return nan;
    }
    out.signal[cell] = signal / used;
    out.variance[cell] = variance / (used * used);
    out.nEff[cell] = weights * weights / squares;
    out.flags[cell].set(Flag::Measured);
    return secondSignal / used;
}

}  // namespace gonio::proc
