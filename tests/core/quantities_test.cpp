#include "proc/core/quantities.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace gonio {
namespace {

TEST(Quantity, AddsScalesAndComparesAsItsNumber) {
    const Brdf a(0.25);
    const Brdf b(0.5);
    EXPECT_EQ((a + b).value(), 0.75);
    EXPECT_EQ((a - b).value(), -0.25);
    EXPECT_EQ((a * 3).value(), 0.75);
    EXPECT_EQ(a / b, 0.5);  // of the same kind: a plain number
    EXPECT_LT(a, b);
    EXPECT_EQ(a + a, b);
    EXPECT_EQ(Counts().value(), 0);
}

template <class A, class B>
concept Adds = requires(A a, B b) { a + b; };

TEST(Quantity, KindsDoNotMix) {
    static_assert(Adds<Brdf, Brdf>);
    static_assert(!Adds<Brdf, Ars>);
    static_assert(!Adds<Counts, Radiance>);
    static_assert(!Adds<Brdf, double>);
    static_assert(!std::is_convertible_v<double, Brdf>);
    static_assert(!std::is_convertible_v<Brdf, double>);
    static_assert(!std::is_constructible_v<Brdf, Ars>);
}

TEST(Ars, IsBelowFAwayFromTheNormal) {
    EXPECT_EQ(toArs(Brdf(0.3), 1), Ars(0.3));
    EXPECT_EQ(toArs(Brdf(0.3), 0), Ars(0));
    for (double cosine : {1.0, 0.7, 1e-2, kMinCosForBrdf}) {
        // One rounding of the product and one of the quotient.
        EXPECT_NEAR(toBrdf(toArs(Brdf(0.3), cosine), cosine).value(), 0.3, 1e-16);
    }
}

}  // namespace
}  // namespace gonio
