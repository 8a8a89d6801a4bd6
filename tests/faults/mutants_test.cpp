// The tests see: each driver that is broken on purpose fails its row of the fault matrix, and the
// same driver with nothing broken passes them all.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <set>

#include "tests/faults/measurement.h"
#include "tests/faults/mocked_rig.h"
#include "tests/faults/mutant.h"

namespace gonio::fault_test {
namespace {

constexpr int kSeeds = 20;  // that a mutant may need to be seen

std::atomic<int> active{-1};

/// The first seed with which the row complains, and its first complaint; empty: it passes.
std::string complaintOf(const Mutant& mutant, int seeds) {
    const bool usb = mutant.door == Door::usb;
    const RigSetup setup = usb ? setupOf(256, 16384) : smallSetup();
    for (Row& row : variantsOf(readRow(mutant.row))) {
        for (int seed = 1; seed <= seeds; ++seed) {
            row.script.seed = static_cast<std::uint64_t>(seed);
            const auto door = usb ? mocked(setup) : inProcess(setup);
            const Outcome outcome = measure(*door, setup, row);
            const auto list = complaints(row, outcome, undisturbed(setup));
            if (!list.empty()) return "seed " + std::to_string(seed) + ": " + list.front();
        }
    }
    return {};
}

/// What is compared with was made by a sound driver.
class Mutants : public testing::Test {
protected:
    void SetUp() override {
        activateMutant(-1);
        (void)undisturbed(smallSetup());
        (void)undisturbed(setupOf(256, 16384));
    }
    void TearDown() override { activateMutant(-1); }
};

TEST_F(Mutants, EachFailsItsRow) {
    int caught = 0, id = 0;
    for (const Mutant& mutant : mutants()) {
        activateMutant(id++);
        const std::string complaint = complaintOf(mutant, mutant.door == Door::usb ? 1 : kSeeds);
        caught += complaint.empty() ? 0 : 1;
        EXPECT_NE(complaint, "") << mutant.row << " does not see " << mutant.file << ": "
                                 << mutant.broken << " for " << mutant.sound;
        fprintf(
            stderr, "%-16s %-34s %s\n", mutant.row.c_str(), mutant.file.c_str(), complaint.c_str());
    }
    fprintf(stderr, "mutants caught %d / %zu\n", caught, mutants().size());
}

TEST_F(Mutants, TheSoundDriverAmongThemPasses) {
    for (const Mutant& mutant : mutants()) {
        if (mutant.door == Door::usb) continue;  // that door's own tests do it
        EXPECT_EQ(complaintOf(mutant, 1), "") << mutant.row;
    }
}

TEST_F(Mutants, EveryRowOfTheMatrixHasOne) {
    std::set<std::string> have;
    for (const Mutant& mutant : mutants()) have.insert(mutant.row.substr(0, 3));
    for (const std::string& row : rowNames("umockdev")) {
        const bool ofMatrix = row.front() == 'F';
        EXPECT_TRUE(!ofMatrix || have.contains(row.substr(0, 3))) << row;
    }
}

}  // namespace

void activateMutant(int id) { active = id; }
bool mutant(int id) { return active == id; }

}  // namespace gonio::fault_test
