#include "proc/formats/exr_tile_pixels.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

std::vector<std::string> channelNames(bool bands) {
    if (bands) return {"R", "G", "B"};
    return {"Y"};
}

/// The column of the other half, where a table has one side only.
std::size_t azimuthOf(const SpecularTable& table, std::size_t x, std::size_t width) {
    return x < table.azimuthDeg.size() ? x : width - 1 - x;
}

}  // namespace

void paintSamples(ExrPart& part,
                  std::span<const AtlasSample> samples,
                  const ExrTileLayout& layout,
                  LossReport& loss) {
    const bool bands = std::any_of(samples.begin(), samples.end(), [](const AtlasSample& sample) {
        return sample.table.colour == TableColour::LedBands;
    });
    std::size_t missing = 0;
    const std::vector<std::string> names = channelNames(bands);
    for (std::size_t c = 0; c < names.size(); ++c) {
        std::vector<float>& pixels = part.floats[names[c]];
        pixels.assign(part.size.pixels(), 0.0F);
        for (std::size_t s = 0; s < samples.size(); ++s) {
            const SpecularTable& table = samples[s].table;
            const std::vector<double>& f = table.planes[std::min(c, table.planes.size() - 1)].f;
            for (TableNode n; n.incidence < layout.tiles; ++n.incidence) {
                for (n.radial = 0; n.radial < layout.height; ++n.radial) {
                    float* row = pixels.data() + layout.offset(n.incidence, s, n.radial);
                    for (std::size_t x = 0; x < layout.width; ++x) {
                        n.azimuth = azimuthOf(table, x, layout.width);
                        if (!table.canHoldData(n)) continue;
                        const auto value = static_cast<float>(f[table.index(n)]);
                        missing += std::isfinite(value) ? 0U : 1U;
                        row[x] = std::isfinite(value) ? value : 0.0F;
                    }
                }
            }
        }
    }
    loss.add(Loss::Masked, "pixels without a finite value, written as 0", missing);
}

void takeSamples(ExrPart& part, std::span<SpecularTable> tables, const ExrTileLayout& layout) {
    for (const std::string& name : channelNames(part.floats.contains("R"))) {
        const std::vector<float> pixels = std::move(part.floats[name]);
        for (std::size_t s = 0; s < tables.size(); ++s) {
            TablePlane plane{.f = std::vector<double>(tables[s].nodeCount()), .tis = {}};
            TableNode n;
            for (n.incidence = 0; n.incidence < layout.tiles; ++n.incidence) {
                for (n.radial = 0; n.radial < layout.height; ++n.radial) {
                    const float* row = pixels.data() + layout.offset(n.incidence, s, n.radial);
                    for (n.azimuth = 0; n.azimuth < layout.width; ++n.azimuth) {
                        plane.f[tables[s].index(n)] = static_cast<double>(row[n.azimuth]);
                    }
                }
            }
            tables[s].planes.push_back(std::move(plane));
        }
    }
}

bool isMirrored(const SpecularTable& table) {
    const std::size_t width = table.azimuthDeg.size();
    if (width % 2 != 0) return false;
    for (const TablePlane& plane : table.planes) {
        for (TableNode n; n.incidence < table.incidenceDeg.size(); ++n.incidence) {
            for (n.azimuth = 0; n.azimuth < width / 2; ++n.azimuth) {
                TableNode other = n;
                other.azimuth = width - 1 - n.azimuth;
                const auto begin = plane.f.begin();
                const auto from = begin + static_cast<std::ptrdiff_t>(table.index(n));
                const auto to = begin + static_cast<std::ptrdiff_t>(table.index(other));
                if (!std::equal(
                        from, from + static_cast<std::ptrdiff_t>(table.radialDeg.size()), to)) {
                    return false;
                }
            }
        }
    }
    return true;
}

void keepOneSide(SpecularTable& table) {
    const std::size_t block = table.azimuthDeg.size() * table.radialDeg.size();
    for (TablePlane& plane : table.planes) {
        std::vector<double> f;
        f.reserve(plane.f.size() / 2);
        for (std::size_t at = 0; at < plane.f.size(); at += block) {
            const auto begin = plane.f.begin() + static_cast<std::ptrdiff_t>(at);
            f.insert(f.end(), begin, begin + static_cast<std::ptrdiff_t>(block / 2));
        }
        plane.f = std::move(f);
    }
    table.azimuthDeg.resize(table.azimuthDeg.size() / 2);
    table.symmetry = TableSymmetry::PlaneSymmetrical;
}

}  // namespace gonio::proc
