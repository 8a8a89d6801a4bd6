#include "sim/glare.h"

#include <cstdint>

#include "proc/core/parallel.h"

namespace gonio::sim {
namespace {

constexpr int kPitch = 16;  // pixels between nodes

double halo(double dx, double dy) {
    return 1 / (1 + (dx * dx + dy * dy) / (kHaloRadius * kHaloRadius));
}

/// The nodes about a pixel's middle and how much each counts.
struct Corner {
    int x = 0, y = 0;
    double right = 0, down = 0;  // shares of the nodes at x + 1 and y + 1
};

Corner cornerOf(int x, int y) {
    return {x / kPitch, y / kPitch, (x % kPitch + 0.5) / kPitch, (y % kPitch + 0.5) / kPitch};
}

using Nodes = Image<double>;

Nodes nodesOver(Size size) {
    return Nodes({(size.width - 1) / kPitch + 2, (size.height - 1) / kPitch + 2});
}

void add(Nodes& nodes, const Corner& c, double amount) {
    nodes.at(c.x, c.y) += amount * (1 - c.right) * (1 - c.down);
    nodes.at(c.x + 1, c.y) += amount * c.right * (1 - c.down);
    nodes.at(c.x, c.y + 1) += amount * (1 - c.right) * c.down;
    nodes.at(c.x + 1, c.y + 1) += amount * c.right * c.down;
}

double between(const Nodes& nodes, const Corner& c) {
    return (nodes.at(c.x, c.y) * (1 - c.right) + nodes.at(c.x + 1, c.y) * c.right) * (1 - c.down) +
           (nodes.at(c.x, c.y + 1) * (1 - c.right) + nodes.at(c.x + 1, c.y + 1) * c.right) * c.down;
}

/// At each node, what all nodes send there by the halo.
Nodes haloSums(const Nodes& sources) {
    Nodes kernel(sources.size());
    for (int y = 0; y < kernel.height(); ++y) {
        for (int x = 0; x < kernel.width(); ++x) {
            kernel.at(x, y) = halo(double{kPitch} * x, double{kPitch} * y);
        }
    }
    Nodes sums(sources.size());
    parallelFor(static_cast<std::size_t>(sums.height()), [&](IndexRange rows) {
        for (std::size_t row = rows.begin; row < rows.end; ++row) {
            const int y = static_cast<int>(row);
            for (int v = 0; v < sources.height(); ++v) {
                for (int u = 0; u < sources.width(); ++u) {
                    const double source = sources.at(u, v);
                    if (source == 0) continue;
                    for (int x = 0; x < sums.width(); ++x) {
                        sums.at(x, y) += source * kernel.at(std::abs(x - u), std::abs(y - v));
                    }
                }
            }
        }
    });
    return sums;
}

/// Calls `visit` for each pixel that sees the field.
template <class Visit>
void forEachSeeing(const FieldOfView& field, Visit visit) {
    const Size size = field.view().size;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            if (field.transmission(x, y) != 0) visit(x, y);
        }
    }
}

/// What one band's light becomes; `landing`: of each node's halo, the sum over the pixels that see
/// the field.
Image<float> spread(const Image<float>& rates,
                    const FieldOfView& field,
                    const Nodes& landing,
                    double share) {
    Nodes sources = nodesOver(rates.size());
    double light = 0;
    double pixels = 0;
    forEachSeeing(field, [&](int x, int y) {
        const double rate = double{rates.at(x, y)};
        add(sources, cornerOf(x, y), rate);
        light += rate;
        ++pixels;
    });
    for (std::size_t i = 0; i < sources.pixels().size(); ++i) {
        if (sources.pixels()[i] != 0) sources.pixels()[i] /= landing.pixels()[i];
    }
    const Nodes sums = haloSums(sources);
    Image<float> out(rates.size());
    forEachSeeing(field, [&](int x, int y) {
        const double glare = (light / pixels + between(sums, cornerOf(x, y))) / 2;
        out.at(x, y) = static_cast<float>((1 - share) * double{rates.at(x, y)} + share * glare);
    });
    return out;
}

}  // namespace

RateImages withGlare(const RateImages& rates, const FieldOfView& field, double share) {
    Nodes seeing = nodesOver(field.view().size);
    forEachSeeing(field, [&](int x, int y) { add(seeing, cornerOf(x, y), 1); });
    const Nodes landing = haloSums(seeing);
    RateImages out;
    for (std::size_t c = 0; c < out.size(); ++c) out[c] = spread(rates[c], field, landing, share);
    return out;
}

Image<float> withGlareReference(const Image<float>& rates, const FieldOfView& field, double share) {
    Image<double> glare(rates.size());
    double pixels = 0;
    forEachSeeing(field, [&](int, int) { ++pixels; });
    forEachSeeing(field, [&](int u, int v) {
        double landing = 0;
        forEachSeeing(field, [&](int x, int y) { landing += halo(x - u, y - v); });
        const double rate = double{rates.at(u, v)};
        forEachSeeing(field, [&](int x, int y) {
            glare.at(x, y) += rate * (1 / pixels + halo(x - u, y - v) / landing) / 2;
        });
    });
    Image<float> out(rates.size());
    forEachSeeing(field, [&](int x, int y) {
        out.at(x, y) =
            static_cast<float>((1 - share) * double{rates.at(x, y)} + share * glare.at(x, y));
    });
    return out;
}

}  // namespace gonio::sim
