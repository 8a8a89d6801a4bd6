#include "proc/table/specular_fill.h"

#include <cmath>

#include "proc/core/parallel.h"

namespace gonio::proc {
namespace {

std::vector<double> steps(int lastDeg) {
    std::vector<double> axis;
    for (int degree = 0; degree <= lastDeg; ++degree) axis.push_back(degree);
    return axis;
}

TableNode nodeAt(const SpecularTable& table, std::size_t i) {
    TableNode node;
    node.radial = i % table.radialDeg.size();
    i /= table.radialDeg.size();
    node.azimuth = i % table.azimuthDeg.size();
    i /= table.azimuthDeg.size();
    node.incidence = i % table.incidenceDeg.size();
    node.rotation = i / table.incidenceDeg.size();
    return node;
}

/// What a node above the horizon was answered.
struct Got {
    enum Kind : unsigned char {
        NotAsked,
        Nothing,
        Zero,
        Value
    };
    Kind kind = NotAsked;
    bool uncertain = false;
    bool extrapolated = false;
};

Got ask(const Scatterer& from, const LightView& pair, Band band, double& f) {
    const Answer answer = from.answer(pair);
    if (std::isnan(answer.f[band])) return {Got::Nothing};
    f = answer.f[band];
    return {.kind = f == 0 ? Got::Zero : Got::Value,
            .uncertain = f != 0 && (answer.uRandom || answer.uSystematic),
            .extrapolated = answer.flags.has(Flag::Extrapolated)};
}

void count(FilledTable& filled, const std::vector<Got>& got) {
    for (const Got g : got) {
        if (g.kind == Got::NotAsked) continue;
        ++filled.nodes;
        if (g.kind == Got::Nothing) ++filled.unanswered;
        if (g.kind == Got::Zero) ++filled.exactZero;
        if (g.uncertain) ++filled.uncertain;
        if (g.extrapolated) ++filled.extrapolated;
    }
}

}  // namespace

SpecularGrid SpecularGrid::oneDegree(std::vector<double> incidenceDeg, TableSymmetry symmetry) {
    const int lastAzimuth = symmetry == TableSymmetry::PlaneSymmetrical ? 180 : 360;
    return {.symmetry = symmetry,
            .incidenceDeg = std::move(incidenceDeg),
            .azimuthDeg = steps(lastAzimuth),
            .radialDeg = steps(180)};
}

FilledTable fillTable(const Scatterer& from, const SpecularGrid& grid, Band band) {
    FilledTable filled;
    SpecularTable& table = filled.table;
    table.symmetry = grid.symmetry;
    table.rotationDeg = grid.rotationDeg;
    table.incidenceDeg = grid.incidenceDeg;
    table.azimuthDeg = grid.azimuthDeg;
    table.radialDeg = grid.radialDeg;
    TablePlane plane{.f = std::vector(table.nodeCount(), 0.0), .tis = {}};
    std::vector<Got> got(table.nodeCount());
    parallelFor(table.nodeCount(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const TableNode node = nodeAt(table, i);
            if (table.canHoldData(node)) got[i] = ask(from, table.pairAt(node), band, plane.f[i]);
        }
    });
    count(filled, got);
    for (std::size_t r = 0; r < table.rotationDeg.size(); ++r) {
        for (std::size_t i = 0; i < table.incidenceDeg.size(); ++i) {
            const Direction wi = table.pairAt({r, i, 0, 0}).in;
            plane.tis.push_back(table.nodeCount() == 0 ? 0 : totalScatter(from, wi, band));
        }
    }
    table.planes.push_back(std::move(plane));
    return filled;
}

FilledTable fillBands(const Scatterer& from, const SpecularGrid& grid) {
    FilledTable filled = fillTable(from, grid, Band::R);
    if (from.bandCount() == BandCount::One) return filled;
    filled.table.colour = TableColour::LedBands;
    for (const Band band : {Band::G, Band::B}) {
        FilledTable next = fillTable(from, grid, band);
        filled.table.planes.push_back(std::move(next.table.planes.front()));
        filled.nodes += next.nodes;
        filled.unanswered += next.unanswered;
        filled.exactZero += next.exactZero;
        filled.uncertain += next.uncertain;
        filled.extrapolated += next.extrapolated;
    }
    return filled;
}

double totalScatter(const Scatterer& from, const Direction& wi, Band band) {
    constexpr std::size_t kRings = 180;
    constexpr int kSectors = 360;
    constexpr double kRing = kPi / 2 / static_cast<double>(kRings);
    std::vector<double> rings(kRings, 0.0);
    parallelFor(kRings, [&](IndexRange range) {
        for (std::size_t k = range.begin; k < range.end; ++k) {
            const double low = static_cast<double>(k) * kRing;
            // Integral of cos sin over the ring: (sin^2 high - sin^2 low) / 2.
            const double weight = std::sin(2 * low + kRing) * std::sin(kRing) / 2;
            double sum = 0;
            for (int j = 0; j < kSectors; ++j) {
                const Radians phi = Radians::fromDegrees(j + 0.5);
                const Direction wo = Direction::fromSpherical(Radians(low + kRing / 2), phi);
                const double f = from.answer({.in = wi, .out = wo}).f[band];
                if (!std::isnan(f)) sum += f;
            }
            rings[k] = sum * weight * (2 * kPi / kSectors);
        }
    });
    double total = 0;
    for (const double ring : rings) total += ring;
    return total;
}

}  // namespace gonio::proc
