#include "proc/quality/file_counts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

class Counter {
public:
    explicit Counter(std::vector<Channel> channels) {
        for (Channel& channel : channels) {
            counts_.channels.push_back({.channel = std::move(channel),
                                        .least = std::numeric_limits<double>::quiet_NaN(),
                                        .largest = std::numeric_limits<double>::quiet_NaN()});
        }
    }

    void direction(std::size_t channel, double f, const Direction& wo) {
        ChannelFacts& facts = counts_.channels[channel];
        ++facts.directions;
        if (std::isnan(f)) return;
        ++facts.measured;
        facts.negative += f < 0 ? 1U : 0U;
        facts.least = std::fmin(facts.least, f);
        facts.largest = std::fmax(facts.largest, f);
        (wo.z() < 0 ? counts_.transmission : counts_.reflection) = true;
        const double theta = wo.theta().degrees();
        if (!counts_.thetaOutDeg) counts_.thetaOutDeg = {theta, theta};
        counts_.thetaOutDeg->from = std::min(counts_.thetaOutDeg->from, theta);
        counts_.thetaOutDeg->to = std::max(counts_.thetaOutDeg->to, theta);
    }
    void light(double thetaDeg, double phiDeg) {
        const auto rounded = [](double deg) { return std::llround(deg * 1e6); };
        lights_.emplace(rounded(thetaDeg), thetaDeg == 0 ? 0 : rounded(phiDeg));
    }
    FileCounts finished() {
        counts_.lights = lights_.size();
        return std::move(counts_);
    }

private:
    FileCounts counts_;
    std::set<std::pair<long long, long long>> lights_;
};

void count(Counter& counter, const SampleSet& set) {
    for (const LedTable& led : set.leds) {
        counter.light(led.incidence.degrees(), led.rotation.degrees());
        for (const Band band : kBands) {
            const CellSamples& cells = led.bands[index(band)];
            for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                counter.direction(index(band), cells.f[cell], CellGrid::centre(cell));
            }
        }
    }
}

void count(Counter& counter, const SpecularTable& table) {
    for (TableNode n; n.rotation < table.rotationDeg.size(); ++n.rotation) {
        for (n.incidence = 0; n.incidence < table.incidenceDeg.size(); ++n.incidence) {
            counter.light(table.incidenceDeg[n.incidence], table.rotationDeg[n.rotation]);
            for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
                for (n.radial = 0; n.radial < table.radialDeg.size(); ++n.radial) {
                    if (!table.canHoldData(n) || table.repeatsDirection(n)) continue;
                    const Direction wo = table.pairAt(n).out;
                    for (std::size_t plane = 0; plane < table.planes.size(); ++plane) {
                        const double f = table.planes[plane].f[table.index(n)];
                        const bool has = table.hasData(plane, n);
                        counter.direction(plane, has ? f : std::nan(""), wo);
                    }
                }
            }
        }
    }
}

void count(Counter& counter, const SphericalTable& table) {
    for (const SphericalBlock& block : table.blocks) {
        counter.light(block.incidenceDeg, block.lightAzimuthDeg);
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            if (block.azimuthDeg[a] - block.azimuthDeg.front() >= 360) continue;
            for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
                const double theta = block.thetaDeg[t];
                const bool pole = theta == 0 || theta == 180;
                if (theta == 90 || (pole && a > 0)) continue;
                counter.direction(
                    block.channel, block.f[block.index(a, t)], table.pairAt(block, a, t).out);
            }
        }
    }
}

void count(Counter& counter, const HalfDifferenceTable& table) {
    for (std::size_t i = 0; i < table.nodeCount(); ++i) {
        const LightView pair = table.pairAt(table.nodeAt(i));
        if (!aboveHorizon(pair)) continue;
        for (std::size_t c = 0; c < 3; ++c) counter.direction(c, table.planes[c][i], pair.out);
    }
}

/// Its values are no f by themselves: what counts is how many there are, and their sign.
void count(Counter& counter, const TensorTable& table) {
    const std::size_t channels = table.channels.size();
    const std::size_t slice = table.values.width * table.values.height;
    for (std::size_t i = 0; i < table.values.values.size(); ++i) {
        counter.direction(
            i / slice % channels, static_cast<double>(table.values.values[i]), Direction());
    }
}

void count(Counter& counter, const BrdfRows& rows) {
    for (std::size_t i = 0; i < rows.pairs.size(); ++i) {
        const Direction& wi = rows.pairs[i].in;
        counter.light(wi.theta().degrees(), wi.phi().degrees());
        for (std::size_t c = 0; c < rows.channels.size(); ++c) {
            counter.direction(c, rows.f[rows.index(i, c)], rows.pairs[i].out);
        }
    }
}

}  // namespace

FileCounts countsOf(const BrdfFile& file) {
    Counter counter(channelsOf(file));
    std::visit([&](const auto& content) { count(counter, content); }, file.content);
    FileCounts counts = counter.finished();
    if (file.as<TensorTable>() != nullptr) counts.thetaOutDeg.reset();
    if (file.as<SampleSet>() != nullptr) {
        std::erase_if(counts.channels, [](const ChannelFacts& c) { return c.directions == 0; });
    }
    return counts;
}

}  // namespace gonio::proc
