#include "proc/calibrate/budget.h"

#include <gtest/gtest.h>

namespace gonio::proc {
namespace {

TEST(Budget, CorrelationsHaveTheirNames) {
    EXPECT_EQ(name(Correlation::PerCell), "per cell");
    EXPECT_EQ(name(Correlation::PerState), "per state");
    EXPECT_EQ(name(Correlation::Common), "common");
}

TEST(Budget, AComponentIsOfTypeBAndIndependentUnlessItSaysOtherwise) {
    const BudgetComponent component;
    EXPECT_EQ(component.type, 'B');
    EXPECT_EQ(component.correlation, Correlation::PerCell);
    EXPECT_EQ(component.medianRelative, 0);
}

}  // namespace
}  // namespace gonio::proc
