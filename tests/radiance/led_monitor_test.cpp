#include "proc/radiance/led_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace gonio::proc {
namespace {

constexpr double kPerKelvin = -0.004, kNoise = 1e-4;

/// `wander`: by how much the light changes steadily from the first cycle to the last.
std::vector<WarmUpPoint> warmUp(std::uint64_t seed, double wander = 0) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> draw;
    std::vector<WarmUpPoint> points;
    for (int cycle = 0; cycle < 4; ++cycle) {
        for (int i = 0; i < 6; ++i) {
            const double celsius = 26 + 0.5 * i, current = 1 + 0.001 * i;
            const double time = 6 * cycle + i, level = 5e4 * (1 + wander * time / 24);
            const double light = level * current * (1 + kPerKelvin * (celsius - 27.25));
            points.push_back({.signal = light * (1 + kNoise * draw(random)),
                              .u = kNoise * 5e4,
                              .current = current,
                              .celsius = celsius,
                              .time = time});
        }
    }
    return points;
}

TEST(WarmUp, SlopeIsFoundWithinItsUncertainty) {
    double chiSquare = 0, z = 0;
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const auto fit = fitWarmUp(warmUp(seed));
        ASSERT_TRUE(fit) << fit.error().message;
        EXPECT_NEAR(fit->celsius, 27.25, 0.01);
        EXPECT_EQ(fit->freedom, 21U);
        EXPECT_NEAR(fit->perKelvin, kPerKelvin, 5 * fit->uPerKelvin);
        chiSquare += fit->chiSquare / 50;
        z += std::pow((fit->perKelvin - kPerKelvin) / fit->uPerKelvin, 2) / 50;
    }
    EXPECT_NEAR(chiSquare, 21, 3);
    EXPECT_NEAR(z, 1, 0.5);
}

TEST(WarmUp, AnLedThatWandersSteadilyIsToldFromItsWarmth) {
    const auto steady = fitWarmUp(warmUp(7)), wandering = fitWarmUp(warmUp(7, 0.02));
    ASSERT_TRUE(steady && wandering);
    EXPECT_NEAR(wandering->perKelvin, kPerKelvin, 5 * steady->uPerKelvin + 0.02 * 0.004);
}

TEST(WarmUp, WhatTellsNothingIsRefused) {
    const std::vector<WarmUpPoint> good = warmUp(1);
    EXPECT_FALSE(fitWarmUp(std::span(good).first(7)));
    std::vector<WarmUpPoint> flat = good;
    for (WarmUpPoint& point : flat) point.celsius = 26;
    const auto refused = fitWarmUp(flat);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("cool"), std::string::npos);
    for (double* member : {&flat[3].signal, &flat[3].u, &flat[3].current}) {
        flat = good;
        *member = 0;
        EXPECT_EQ(fitWarmUp(flat).error().kind, ErrorKind::Quality);
    }
    flat = good;
    for (WarmUpPoint& point : flat) point.time = 3 * point.celsius;
    EXPECT_FALSE(fitWarmUp(flat)) << "never cold again";
}

TEST(LedMonitor, CurrentCountsWhereItsMeterIsFineEnough) {
    LedMonitor monitor;
    monitor.bands[index(Band::R)] = {.perKelvin = -0.01, .celsius = 25};
    monitor.fullMilliamp = {350, 350, 0};
    EXPECT_NEAR(monitor.light(Band::R, {65535, 353.5, 26}), 1.01 * 0.99, 1e-12);
    EXPECT_NEAR(monitor.light(Band::R, {3277, 17.6, 26}), 0.99, 1e-12) << "0.2 % is its step";
    EXPECT_EQ(monitor.light(Band::G, {65535, 0, 30}), 1) << "not known";
    EXPECT_EQ(monitor.light(Band::B, {65535, 350, 30}), 1) << "full level not known";
}

}  // namespace
}  // namespace gonio::proc
