#include "proc/core/units.h"

#include <gtest/gtest.h>

namespace gonio {
namespace {

TEST(Radians, DegreesRoundTrip) {
    for (double degrees : {0.0, 1e-9, 0.5, 45.0, 89.99, 90.0, 360.0, -75.3}) {
        // Two roundings, each of half an ulp.
        EXPECT_NEAR(Radians::fromDegrees(degrees).degrees(), degrees, 2.3e-16 * std::abs(degrees));
    }
}

TEST(Radians, FunctionsTakeTheAngleItself) {
    EXPECT_DOUBLE_EQ(sin(30_deg), 0.5);
    EXPECT_DOUBLE_EQ(cos(60_deg), 0.5);
    EXPECT_DOUBLE_EQ(tan(45_deg), 1);
    EXPECT_EQ(sin(Radians()), 0);
    EXPECT_EQ(cos(Radians()), 1);
}

TEST(Exposure, ComparesWhatWasAskedAndWhatWasGranted) {
    const Exposure a{Microseconds(20), Nanoseconds(19760)};
    EXPECT_EQ(a, (Exposure{Microseconds(20), Nanoseconds(19760)}));
    EXPECT_NE(a, (Exposure{Microseconds(21), Nanoseconds(19760)}));
    EXPECT_NE(a, (Exposure{Microseconds(20), Nanoseconds(19761)}));
}

}  // namespace
}  // namespace gonio
