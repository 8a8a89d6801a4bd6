#include "proc/table/peak_quarter.h"

#include <gtest/gtest.h>

#include "tests/support/spherical_tables.h"

namespace gonio::proc {
namespace {

using test::sphericalTable;
using test::steps;

double lobe(const LightView& pair, std::size_t) { return test::mirrorLobe(pair, 10); }

TEST(PeakQuarter, LiesAtTheMirrorOfASoundTable) {
    for (const double mirror : {0.0, 180.0, 270.0}) {
        const SphericalTable table = sphericalTable({.mirrorAzimuthDeg = mirror}, lobe);
        EXPECT_EQ(peakQuarters(table), (std::array<std::size_t, 4>{3, 0, 0, 0}));  // not at 0
        EXPECT_FALSE(peakWarning(table));
    }
}

TEST(PeakQuarter, TellsEveryOtherConvention) {
    for (const std::size_t quarter : {1U, 2U, 3U}) {
        SphericalTable table = sphericalTable({.mirrorAzimuthDeg = 270}, lobe);
        table.mirrorAzimuthDeg -= 90.0 * static_cast<double>(quarter);
        EXPECT_EQ(peakQuarters(table)[quarter], 3U);
        ASSERT_TRUE(peakWarning(table));
        EXPECT_NE(peakWarning(table)->find("azimuth 270"), std::string::npos);
        EXPECT_NE(peakWarning(table)->find(quarter == 2 ? "the light" : "neither"),
                  std::string::npos);
    }
}

TEST(PeakQuarter, ReadsHalfACircle) {
    SphericalTable table =
        sphericalTable({.planeSymmetrical = true, .azimuthDeg = steps(0, 180, 10)}, lobe);
    EXPECT_EQ(peakQuarters(table)[0], 3U);
    table.mirrorAzimuthDeg = 0;
    EXPECT_EQ(peakQuarters(table)[2], 3U);
}

TEST(PeakQuarter, DoesNotJudgeWhatHasNoPeak) {
    const auto flat = [](const LightView&, std::size_t) { return 0.3; };
    EXPECT_EQ(peakQuarters(sphericalTable({}, flat)), (std::array<std::size_t, 4>{}));
    const auto zero = [](const LightView&, std::size_t) { return 0.0; };
    EXPECT_EQ(peakQuarters(sphericalTable({}, zero)), (std::array<std::size_t, 4>{}));
    EXPECT_EQ(peakQuarters(sphericalTable({.azimuthDeg = steps(0, 40, 10)}, lobe)),
              (std::array<std::size_t, 4>{}));
}

}  // namespace
}  // namespace gonio::proc
