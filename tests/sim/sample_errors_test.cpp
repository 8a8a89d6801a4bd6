#include "sim/sample_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;

TEST(SampleErrors, ABackingReturnsItsReflectanceOfWhatGetsThrough) {
    const SampleErrors white{.translucency = 0.1, .backing = Backing::White};
    const SampleErrors black{.translucency = 0.1, .backing = Backing::Black};
    EXPECT_NEAR(subsurface(white)[Band::R] * kPi, 0.1 * 0.9, 1e-15);
    EXPECT_NEAR(subsurface(black)[Band::R] * kPi, 0.1 * 0.03, 1e-15);
    EXPECT_NEAR(subsurface(white)[Band::G] / subsurface(white)[Band::R], 0.6, 1e-15);
    EXPECT_NEAR(subsurface(white)[Band::B] / subsurface(white)[Band::R], 0.4, 1e-15);
    EXPECT_EQ(subsurface({}), LedBands{});
}

TEST(SampleErrors, APressedSampleRelaxesInASecond) {
    const SampleErrors soft{.softness = 0.05};
    EXPECT_EQ(pressed(soft, 0s), 0.05);
    EXPECT_NEAR(pressed(soft, 1s), 0.05 * std::exp(-1.0), 1e-15);
    EXPECT_LT(pressed(soft, 20s), 1e-9);
    EXPECT_EQ(pressed({}, 0s), 0);
}

TEST(SampleErrors, TheLobeIsTenDegreesWide) {
    EXPECT_EQ(lobeShape(0_deg), 1);
    EXPECT_NEAR(lobeShape(10_deg), std::exp(-0.5), 1e-12);
}

TEST(SampleErrors, SizesOutOfTheirDomainAreRefused) {
    EXPECT_TRUE(check(SampleErrors{}));
    EXPECT_TRUE(check({.waviness = 10_deg,
                       .translucency = 1,
                       .backing = Backing::White,
                       .softness = 1,
                       .ambient = 1}));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {-1e-9, 1.0001, nan}) {
        for (const SampleErrors& errors : {SampleErrors{.translucency = bad},
                                           SampleErrors{.softness = bad},
                                           SampleErrors{.ambient = bad}}) {
            const auto good = check(errors);
            ASSERT_FALSE(good) << bad;
            EXPECT_EQ(good.error().kind, ErrorKind::Usage);
        }
    }
    for (const Radians bad : {Radians(-1e-9), Radians::fromDegrees(10.0001), Radians(nan)}) {
        ASSERT_FALSE(check({.waviness = bad}));
    }
}

}  // namespace
}  // namespace gonio::sim
