// Every row of the fault matrix through the real USB code, with the verdict that it has in process,
// and without a file descriptor or a thread left behind.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/faults/measurement.h"
#include "tests/faults/mocked_rig.h"
#include "tests/faults/row_seeds.h"

namespace gonio::fault_test {
namespace {

/// What this process holds.
std::size_t held(const char* what) {
    const std::filesystem::directory_iterator all("/proc/self/" + std::string(what));
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

class FaultRowOnUsb : public testing::TestWithParam<std::string> {};

TEST_P(FaultRowOnUsb, HasTheSameVerdict) {
    constexpr int kNightly = 20, kInCheck = 1;
    constexpr int kSide = 256, kChunk = 16384;  // a ring of a hundred transfers, not of a thousand
    const RigSetup setup = setupOf(kSide, kChunk);
    Row row = readRow(GetParam());
    row.seeds = kInCheck;
    const Seeds seeds = seedsOf(row, kNightly);
    for (int seed = seeds.first; seed <= seeds.last && !HasFailure(); ++seed) {
        row.script.seed = static_cast<std::uint64_t>(seed);
        const auto door = mocked(setup);
        (void)door->open();
        door->close();  // what the libraries keep for good, they have now
        const std::size_t files = held("fd"), threads = held("task");
        const Outcome outcome = measure(*door, setup, row);
        for (const std::string& complaint : complaints(row, outcome, undisturbed(setup)))
            ADD_FAILURE() << "seed " << seed << ": " << complaint;
        EXPECT_EQ(held("task"), threads) << "seed " << seed;
        EXPECT_EQ(held("fd"), files) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Matrix, FaultRowOnUsb, testing::ValuesIn(rowNames()), [](const auto& row) {
    return testName(row.param);
});

}  // namespace
}  // namespace gonio::fault_test
