#pragma once
// A real scattered set: the goniometer's samples of a retro-reflective tape in GONIO_DATA_DIR, at
// 15, 30 and 60 degrees, in irregular directions. Its columns are theta_i, theta_o cos(dphi),
// theta_o sin(dphi) in radians, and f cos(theta_o).

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "proc/core/quantities.h"
#include "proc/table/scattered_set.h"
#include "tests/support/data_file.h"

namespace gonio::test {

/// Empty where the file is absent. Rows at the horizon hold no f and are left out.
inline std::vector<proc::ScatteredSample> retroreflectiveTape() {
    std::vector<proc::ScatteredSample> samples;
    const auto path = dataFile("retroreflective/retro-3M-jaune.dat");
    if (!path) return samples;
    std::ifstream file(*path);
    while (file.peek() == '#') file.ignore(1 << 16, '\n');
    double thetaIn = 0, projectedX = 0, projectedY = 0, ars = 0;
    while (file >> thetaIn >> projectedX >> projectedY >> ars) {
        const Direction wo = Direction::fromSpherical(Radians(std::hypot(projectedX, projectedY)),
                                                      Radians(std::atan2(projectedY, projectedX)));
        const double f = toBrdf(Ars(ars), wo.z()).value();
        if (std::isnan(f)) continue;
        samples.push_back(
            {.pair = {.in = Direction::fromSpherical(Radians(thetaIn), Radians(0)), .out = wo},
             .f = LedBands::all(f),
             .uRandom = {},
             .uSystematic = {}});
    }
    return samples;
}

}  // namespace gonio::test
