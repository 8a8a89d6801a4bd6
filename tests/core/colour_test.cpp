#include "proc/core/colour.h"

#include <gtest/gtest.h>

namespace gonio {
namespace {

void expectNear(const std::array<double, 3>& is, const std::array<double, 3>& wanted, double by) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(is[i], wanted[i], by) << i;
}

TEST(Colour, WhiteOfLinearSrgbIsD65) {
    // xy (0.3127, 0.3290) with Y = 1.
    expectNear(toXyz({{1, 1, 1}}).value, {0.3127 / 0.329, 1, (1 - 0.3127 - 0.329) / 0.329}, 1e-14);
    expectNear(toXyz({}).value, {0, 0, 0}, 0);
}

/// The printed matrix has four digits.
TEST(Colour, HasThePrintedMatrixOfSrgb) {
    expectNear(toXyz({{1, 0, 0}}).value, {0.4124, 0.2126, 0.0193}, 5e-5);
    expectNear(toXyz({{0, 1, 0}}).value, {0.3576, 0.7152, 0.1192}, 5e-5);
    expectNear(toXyz({{0, 0, 1}}).value, {0.1805, 0.0722, 0.9505}, 5e-5);
}

TEST(Colour, GoesBothWays) {
    const std::array<double, 3> v{0.25, -0.125, 3};
    expectNear(toLinearSrgb(toXyz({v})).value, v, 1e-14);
    expectNear(toXyz(toLinearSrgb({v})).value, v, 1e-14);
}

}  // namespace
}  // namespace gonio
