#include "proc/calibrate/budget.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/calibrate/budget_text.h"

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

TEST(BudgetText, ReadsWhatCanBeReadAndLeavesTheRest) {
    const auto states =
        readBudget(R"([1, {"led":-1,"band":"r"}, {"led":0}, {"led":1e300,"band":"g"},)"
                   R"({"led":3,"band":"b","monte_carlo_cells":7,"components":["x",)"
                   R"({"name":"a","type":"A","correlation":"per state","median_relative":0.1,)"
                   R"("size":0.2,"unit":"degree","freedom":4},{"name":7,"median_relative":null}]},)"
                   R"({"led":0,"band":"g","components":{}}])");
    ASSERT_EQ(states.size(), 2U);
    EXPECT_EQ(states[0].led, 3U);
    EXPECT_EQ(states[0].band, Band::B);
    EXPECT_EQ(states[0].monteCarloCells, 7U);
    ASSERT_EQ(states[0].components.size(), 2U);
    const BudgetComponent& first = states[0].components[0];
    EXPECT_EQ(first.type, 'A');
    EXPECT_EQ(first.correlation, Correlation::PerState);
    EXPECT_EQ(first.sensitivity(), 0.5);
    EXPECT_EQ(first.unit, "degree");
    EXPECT_EQ(first.freedom, 4);
    EXPECT_TRUE(std::isnan(states[0].components[1].medianRelative));
    EXPECT_TRUE(states[1].components.empty());
    for (const char* none : {"", "banana", "{}", "7"}) EXPECT_TRUE(readBudget(none).empty());
}

}  // namespace
}  // namespace gonio::proc
