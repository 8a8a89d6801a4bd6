#pragma once
// Lists of BRDF values for tests of the formats that hold them, and how two of them compare.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "proc/models/spec.h"
#include "proc/table/brdf_rows.h"

namespace gonio::test {

inline LightView pairOfDegrees(double thetaI, double phiI, double thetaO, double phiO) {
    return {
        .in = Direction::fromSpherical(Radians::fromDegrees(thetaI), Radians::fromDegrees(phiI)),
        .out = Direction::fromSpherical(Radians::fromDegrees(thetaO), Radians::fromDegrees(phiO))};
}

/// Lights at 0, 20, 40 and 60 degrees and the azimuth `phiI`; views by 10 and 30 degrees, each
/// direction once. `f(pair, band)`, three bands.
template <class F>
proc::BrdfRows rowsOn(double phiI, const F& f) {
    proc::BrdfRows rows;
    rows.channels = proc::Channel::ofBands();
    for (const double thetaI : {0.0, 20.0, 40.0, 60.0}) {
        for (int thetaO = 0; thetaO <= 80; thetaO += 10) {
            for (int phiO = 0; phiO < (thetaO == 0 ? 1 : 360); phiO += 30) {
                rows.pairs.push_back(pairOfDegrees(thetaI, phiI, thetaO, phiO));
                for (const Band band : kBands) rows.f.push_back(f(rows.pairs.back(), band));
            }
        }
    }
    return rows;
}

inline proc::BrdfRows modelRows(std::string_view spec) {
    const auto model = proc::makeModel(spec);
    EXPECT_TRUE(model) << spec;
    return rowsOn(0,
                  [&](const LightView& pair, Band band) { return (*model)->answer(pair).f[band]; });
}

/// Differs between +phi and -phi, and by band.
inline proc::BrdfRows asymmetricRows(double phiI = 0) {
    return rowsOn(phiI, [](const LightView& pair, Band band) {
        return 1.0 + 0.3 * pair.out.x() + 0.2 * pair.out.y() + 0.1 * pair.in.x() +
               0.01 * static_cast<double>(index(band));
    });
}

/// The same with uncertainties and flags.
inline proc::BrdfRows measuredRows() {
    proc::BrdfRows rows = asymmetricRows();
    for (std::size_t i = 0; i < rows.f.size(); ++i) {
        rows.uRandom.push_back(0.001 * rows.f[i]);
        rows.uSystematic.push_back(0.002 * static_cast<double>(1 + i % 7));
        Flags flags{Flag::Measured};
        if (i % 5 == 0) flags.set(Flag::GlareCorrected);
        rows.flags.push_back(flags);
    }
    return rows;
}

inline bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
inline bool near(double a, double b, double tolerance) {
    return same(a, b) || std::abs(a - b) <= tolerance * std::abs(b);
}

/// Values and uncertainties to a relative `tolerance`, directions to `angle` radians.
inline void expectSameRows(const proc::BrdfRows& a,
                           const proc::BrdfRows& b,
                           double tolerance = 0,
                           double angle = 1e-10) {
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.isotropic, b.isotropic);
    ASSERT_EQ(a.pairs.size(), b.pairs.size());
    ASSERT_EQ(a.f.size(), b.f.size());
    ASSERT_EQ(a.uRandom.size(), b.uRandom.size());
    ASSERT_EQ(a.uSystematic.size(), b.uSystematic.size());
    ASSERT_EQ(a.flags.size(), b.flags.size());
    std::size_t directions = 0, values = 0, uncertainties = 0, flags = 0;
    for (std::size_t i = 0; i < a.pairs.size(); ++i) {
        const double off = std::hypot((a.pairs[i].in.vector() - b.pairs[i].in.vector()).norm(),
                                      (a.pairs[i].out.vector() - b.pairs[i].out.vector()).norm());
        directions += off <= angle ? 0U : 1U;
    }
    for (std::size_t i = 0; i < a.f.size(); ++i) {
        values += near(a.f[i], b.f[i], tolerance) ? 0U : 1U;
    }
    for (std::size_t i = 0; i < a.uRandom.size(); ++i) {
        uncertainties += near(a.uRandom[i], b.uRandom[i], tolerance) ? 0U : 1U;
    }
    for (std::size_t i = 0; i < a.uSystematic.size(); ++i) {
        uncertainties += near(a.uSystematic[i], b.uSystematic[i], tolerance) ? 0U : 1U;
    }
    for (std::size_t i = 0; i < a.flags.size(); ++i) flags += a.flags[i] == b.flags[i] ? 0U : 1U;
    EXPECT_EQ(directions, 0U);
    EXPECT_EQ(values, 0U);
    EXPECT_EQ(uncertainties, 0U);
    EXPECT_EQ(flags, 0U);
}

/// Of a narrow lobe: the largest value of each light stands at its mirror direction.
inline void expectPeaksAtTheMirror(const proc::BrdfRows& rows) {
    for (std::size_t i = 0; i < rows.pairs.size();) {
        const Direction light = rows.pairs[i].in;
        std::size_t peak = i;
        for (; i < rows.pairs.size() && (rows.pairs[i].in.vector() - light.vector()).norm() < 1e-9;
             ++i) {
            if (rows.f[rows.index(i, 0)] > rows.f[rows.index(peak, 0)]) peak = i;
        }
        const Direction mirror = mirrorOf(light);
        EXPECT_LT((rows.pairs[peak].out.vector() - mirror.vector()).norm(), 1e-9)
            << light.theta().degrees();
    }
}

}  // namespace gonio::test
