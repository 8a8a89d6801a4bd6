#pragma once
// Data of a known model: at 0, 20, 40 and 60 degrees, the cells within 10 degrees of the mirror
// direction and others evenly, up to theta_o = 75 degrees. u = hypot(relative f, floor).

#include <cmath>
#include <random>

#include "proc/core/scatterer.h"
#include "proc/fit/brdf_data.h"
#include "proc/optics/cell_grid.h"

namespace gonio::test {

struct Noise {
    double relative = 0.01;
    double floor = 2e-4;  ///< 1/sr
};

/// Without noise, with its uncertainties.
inline proc::BrdfData simulated(const Scatterer& surface,
                                std::size_t perIncidence,
                                const Noise& noise = {}) {
    proc::BrdfData data;
    for (const Radians incidence : {0_deg, 20_deg, 40_deg, 60_deg}) {
        const auto group = static_cast<std::uint16_t>(data.incidences.size());
        data.incidences.push_back(incidence);
        const Direction wi = Direction::fromSpherical(incidence, Radians(0));
        std::vector<std::size_t> near;
        std::vector<std::size_t> far;
        for (std::size_t cell = 0; cell < proc::CellGrid::count(); ++cell) {
            if (proc::CellGrid::place(cell).row >= 75) continue;
            const Direction wo = proc::CellGrid::centre(cell);
            const bool lobe = angleBetween({.in = mirrorOf(wi), .out = wo}) < 10_deg;
            (lobe ? near : far).push_back(cell);
        }
        const std::size_t left = perIncidence - std::min(perIncidence, near.size());
        for (std::size_t k = 0; k < left; ++k) near.push_back(far[k * far.size() / left]);
        for (const std::size_t cell : near) {
            const LightView pair{.in = wi, .out = proc::CellGrid::centre(cell)};
            const LedBands f = surface.answer(pair).f;
            proc::FitRow row;
            row.firstNode = static_cast<std::uint32_t>(data.nodes.size());
            row.group = group;
            row.cell = static_cast<std::int32_t>(cell);
            row.patch = static_cast<std::uint32_t>(proc::patchOf(cell));
            row.solidAngle = proc::CellGrid::solidAngle(cell);
            row.cosThetaO = pair.out.z();
            data.nodes.push_back({proc::pairOf<double>(pair), 1});
            for (std::size_t b = 0; b < 3; ++b) {
                row.f[b] = f.value[b];
                row.uRandom[b] = std::hypot(noise.relative * f.value[b], noise.floor);
            }
            data.rows.push_back(row);
        }
    }
    return data;
}

/// The same with noise drawn from a seed.
inline proc::BrdfData noisy(proc::BrdfData data, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (proc::FitRow& row : data.rows) {
        for (std::size_t b = 0; b < 3; ++b) row.f[b] += row.uRandom[b] * normal(random);
    }
    return data;
}

}  // namespace gonio::test
