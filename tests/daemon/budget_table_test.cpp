#include "daemon/budget_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json state(double whiteMedian) {
    return {{"led", 0},
            {"band", "r"},
            {"components",
             {{{"name", "white reference, common"},
               {"type", "B"},
               {"correlation", "common"},
               {"median_relative", whiteMedian},
               {"size", 0.005},
               {"unit", "relative"},
               {"sensitivity", whiteMedian / 0.005},
               {"freedom", nullptr}},
              {{"name", "direction of the cell (lens map)"},
               {"type", "A"},
               {"correlation", "per state"},
               {"median_relative", 0.001},
               {"size", 0.0125},
               {"unit", "degree"},
               {"sensitivity", 0.08},
               {"freedom", 58}}}}};
}

std::string tableOf(const Json& budget) { return budgetTable(proc::readBudget(budget.dump())); }

TEST(BudgetTable, HasALineForEachComponentWithMediansOverTheStates) {
    const std::string table = tableOf(Json::array({state(0.004), state(0.005), state(0.006)}));
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3) << table;
    EXPECT_NE(table.find("white reference, common                 B     common"), std::string::npos)
        << table;
    EXPECT_NE(table.find("0.500 %"), std::string::npos) << table;
    EXPECT_NE(table.find("1.000"), std::string::npos) << table;
    EXPECT_NE(table.find("0.0125 deg"), std::string::npos) << table;
    EXPECT_NE(table.find("58"), std::string::npos) << table;
}

TEST(BudgetTable, ABudgetOfBeforeHasNoSizes) {
    Json old = state(0.004);
    for (Json& component : old["components"]) {
        for (const char* key : {"size", "unit", "sensitivity", "freedom"}) component.erase(key);
    }
    const std::string table = tableOf(Json::array({old}));
    EXPECT_NE(table.find("0.400 %"), std::string::npos) << table;
    EXPECT_EQ(table.find("0.500 %"), std::string::npos) << table;
}

TEST(BudgetTable, OfNothingIsEmpty) {
    EXPECT_EQ(budgetTable({}), "");
    EXPECT_EQ(tableOf(Json("broken")), "");
}

}  // namespace
}  // namespace gonio::daemon
