// Every row of the fault matrix on the in-process door.

#include <gtest/gtest.h>

#include "tests/faults/figures.h"
#include "tests/faults/measurement.h"
#include "tests/faults/row_seeds.h"

namespace gonio::fault_test {
namespace {

class FaultRow : public testing::TestWithParam<std::string> {};

TEST_P(FaultRow, HasItsVerdictInProcess) {
    constexpr int kNightly = 1000;
    const RigSetup setup = smallSetup();
    const Row all = readRow(GetParam());
    Figures figures(all, "inproc");
    const Seeds seeds = seedsOf(kNightly);
    for (Row& row : variantsOf(all)) {
        for (int seed = seeds.first; seed <= seeds.last && !HasFailure(); ++seed) {
            row.script.seed = static_cast<std::uint64_t>(seed);
            const auto door = inProcess(setup);
            const Outcome outcome = measure(*door, setup, row);
            const auto bad = complaints(row, outcome, undisturbed(setup));
            figures.add(outcome, bad.empty());
            for (const std::string& complaint : bad)
                ADD_FAILURE() << "seed " << seed << ": " << complaint;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Matrix,
                         FaultRow,
                         testing::ValuesIn(rowNames("inproc")),
                         [](const auto& row) { return testName(row.param); });

}  // namespace
}  // namespace gonio::fault_test
