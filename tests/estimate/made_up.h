#pragma once
// Data and estimators made up for the tests of this folder.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "proc/core/result.h"
#include "proc/table/scattered_set.h"

namespace gonio::proc::test {

inline LightView pairAt(double thetaInDeg, double thetaOutDeg, double phiOutDeg = 0) {
    return {.in = Direction::fromSpherical(Radians::fromDegrees(thetaInDeg), Radians(0)),
            .out = Direction::fromSpherical(Radians::fromDegrees(thetaOutDeg),
                                            Radians::fromDegrees(phiOutDeg))};
}

/// 10 % random and 5 % systematic, of the size of f.
inline ScatteredSample sampleAt(const LightView& pair, double f) {
    return {.pair = pair,
            .f = {{f, 2 * f, 3 * f}},
            .uRandom = LedBands{{0.1, 0.2, 0.3}} * std::abs(f),
            .uSystematic = LedBands{{0.05, 0.1, 0.15}} * std::abs(f)};
}

inline ScatteredSet setOf(const std::vector<ScatteredSample>& samples,
                          PairSymmetry symmetry = PairSymmetry::Isotropic) {
    ScatteredSet set(symmetry);
    EXPECT_TRUE(set.add(samples));
    return set;
}

/// f at (theta_i, theta_o, phi) in degrees.
using OfAngles = std::function<double(double, double, double)>;

/// Samples at incidences 0, 20, 40, 60, theta_o = 0, 5 .. 75, phi = 0, 15 .. 345 degrees.
inline ScatteredSet gridOf(const OfAngles& f) {
    std::vector<ScatteredSample> samples;
    for (double i = 0; i <= 60; i += 20) {
        for (double o = 0; o <= 75; o += 5) {
            for (double phi = 0; phi < 360; phi += 15) {
                samples.push_back(sampleAt(pairAt(i, o, phi), f(i, o, phi)));
            }
        }
    }
    return setOf(samples);
}

inline std::unique_ptr<Scatterer> made(Result<std::unique_ptr<Scatterer>> result) {
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return result ? std::move(*result) : nullptr;
}

inline void expectUsageError(const Result<std::unique_ptr<Scatterer>>& result) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::Usage);
    EXPECT_FALSE(result.error().message.empty());
}

/// Answers f of the angles everywhere above the horizon, as measured.
class Everywhere : public Scatterer {
public:
    explicit Everywhere(OfAngles f) : f_(std::move(f)) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        const double phi = pair.out.phi().degrees();
        const double f = f_(pair.in.theta().degrees(), pair.out.theta().degrees(), phi);
        return {.f = {{f, 2 * f, 3 * f}},
                .uRandom = LedBands{{0.1, 0.2, 0.3}} * std::abs(f),
                .uSystematic = LedBands{{0.05, 0.1, 0.15}} * std::abs(f),
                .flags = {Flag::Measured, Flag::GlareCorrected},
                .source = Source::Measured};
    }

private:
    OfAngles f_;
};

/// Answers nothing.
class Nowhere : public Scatterer {
public:
    [[nodiscard]] Answer answer(const LightView& /*pair*/) const override {
        return Answer::none({Flag::Blocked}, Source::Interpolated);
    }
};

}  // namespace gonio::proc::test
