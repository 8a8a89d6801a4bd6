// The soak in process and in virtual time: nothing is lost, nothing is wrong, and the driver counts
// exactly what was done to it. Five minutes; an hour nightly.

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <limits>

#include "tests/faults/row_seeds.h"
#include "tests/faults/soak.h"

namespace gonio::fault_test {
namespace {

TEST(Soak, LosesNoFrameTakesNoWrongOneAndCountsExactly) {
    const bool nightly = std::getenv("GONIO_NIGHTLY") != nullptr;
    const SoakPlan plan{.captures = nightly ? 7200 : 600, .seed = seedOr(1)};
    const RigSetup setup = smallSetup();
    const auto door = inProcess(setup, std::numeric_limits<int>::max());
    const Soaked soaked = soak(*door, setup, plan);
    for (const std::string& trouble : soaked.troubles) ADD_FAILURE() << trouble;
    EXPECT_GE(soaked.captures, plan.captures);
    EXPECT_EQ(soaked.frames, soaked.captures * SoakPlan::kFramesPerCapture);
    EXPECT_GE(soaked.faults, plan.captures / 20 - 3) << "one in ten seconds";
    EXPECT_GE(soaked.pulls, 1);
    std::cout << summaryOf(soaked) << "\n";
}

}  // namespace
}  // namespace gonio::fault_test
