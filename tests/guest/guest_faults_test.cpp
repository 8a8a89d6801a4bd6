// The starred rows of the fault matrix on a real kernel: the scripts, the measurement and the
// verdicts of the other doors.

#include <gtest/gtest.h>

#include "tests/faults/measurement.h"
#include "tests/faults/row_seeds.h"
#include "tests/guest/cabled_door.h"

namespace gonio::guest_test {
namespace {

class GuestFaults : public testing::TestWithParam<const char*> {};

TEST_P(GuestFaults, HaveTheSameVerdict) {
    constexpr int kSide = 128, kChunk = 4096;  // eight chunks, as on the other doors
    fault_test::RigSetup setup = fault_test::setupOf(kSide, kChunk);
    setup.config.serial = "SIM-0044";  // the other tests' rig is plugged in meanwhile
    fault_test::Row row = fault_test::readRow(GetParam());
    row.script.seed = 1;
    const auto door = cabled(setup);
    const fault_test::Outcome outcome = fault_test::measure(*door, setup, row);
    for (const std::string& complaint :
         fault_test::complaints(row, outcome, fault_test::undisturbed(setup)))
        ADD_FAILURE() << complaint;
}

INSTANTIATE_TEST_SUITE_P(Starred,
                         GuestFaults,
                         testing::Values("F01", "F02", "F03", "F04", "F06", "F06-third"),
                         [](const auto& row) { return fault_test::testName(row.param); });

}  // namespace
}  // namespace gonio::guest_test
