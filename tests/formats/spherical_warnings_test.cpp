#include "proc/formats/spherical_warnings.h"

#include <gtest/gtest.h>

#include "tests/support/spherical_tables.h"

namespace gonio::proc {
namespace {

using Sentences = std::vector<std::string>;

TEST(SphericalWarnings, CountNegativesAndBlocksOfOneAzimuth) {
    const auto lambert = [](const LightView&, std::size_t) { return 0.5 / kPi; };
    SphericalTable table = test::sphericalTable({}, lambert);
    EXPECT_EQ(sphericalWarnings(table), Sentences{});
    table.blocks[0].f[0] = -1;
    EXPECT_EQ(sphericalWarnings(table), Sentences{"1 negative values"});
    // Of incidences 0, 20, 40, 60 the first is round.
    EXPECT_EQ(sphericalWarnings(test::sphericalTable({.azimuthDeg = {180}}, lambert)),
              Sentences{"3 blocks have values at a single azimuth: they answer on it alone"});
}

}  // namespace
}  // namespace gonio::proc
