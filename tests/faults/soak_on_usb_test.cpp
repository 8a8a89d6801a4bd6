// The soak through the real USB code and in real time: nothing is lost, nothing is wrong, what was
// done to the stream and the reports is counted exactly, and nothing is left behind. A few seconds;
// half an hour nightly.

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "driver/usb_ledger.h"
#include "tests/device/holdings.h"
#include "tests/faults/mocked_rig.h"
#include "tests/faults/row_seeds.h"
#include "tests/faults/soak.h"
#include "tests/support/wait_until.h"

namespace gonio::fault_test {
namespace {

using device_test::Holdings;

constexpr int kSide = 256, kChunk = 16384;  // a ring of a hundred transfers, not of a thousand

/// Seven seconds. This seed's faults: a lost chunk, an unknown one, a loss of power, and a hang
/// until the port is reset.
SoakPlan shortPlan() {
    return {.captures = 12, .every = "1.4s..1.6s", .seed = seedOr(5), .realTime = true};
}
SoakPlan halfAnHour() { return {.captures = 3600, .seed = seedOr(1), .realTime = true}; }

TEST(SoakOnUsb, LosesNoFrameTakesNoWrongOneAndLeavesNothingBehind) {
    const bool nightly = std::getenv("GONIO_NIGHTLY") != nullptr;
    const SoakPlan plan = nightly ? halfAnHour() : shortPlan();
    const RigSetup setup = setupOf(kSide, kChunk);
    const auto door = mocked(setup);
    // What is made once is made before anything is counted.
    const Soaked calm = soak(*door, setup, {.captures = 1, .realTime = true});
    ASSERT_TRUE(calm.troubles.empty()) << calm.troubles.front();
    const Holdings before;
    const Soaked soaked = soak(*door, setup, plan);
    // What a busy machine could not end in time ends a little later.
    (void)test::waitUntil([&] {
        const Holdings now;
        return now.threads <= before.threads && now.fds <= before.fds;
    });
    const Holdings after;
    for (const std::string& trouble : soaked.troubles) ADD_FAILURE() << trouble;
    EXPECT_GE(soaked.captures, plan.captures);
    EXPECT_EQ(soaked.frames, soaked.captures * SoakPlan::kFramesPerCapture);
    EXPECT_GE(soaked.pulls, 1);
    const auto& ledger = driver::usbLedger();
    EXPECT_EQ(ledger.transfersInFlight, 0);
    EXPECT_EQ(ledger.quarantinedTransfers, 0);
    EXPECT_EQ(ledger.streams, 0);
    EXPECT_EQ(ledger.hidThreads, 0);
    EXPECT_LE(after.fds, before.fds);
    EXPECT_LE(after.threads, before.threads);
    const auto grown = static_cast<double>(after.heap) - static_cast<double>(before.heap);
    std::cout << summaryOf(soaked) << "\nfiles " << before.fds << " to " << after.fds
              << ", threads " << before.threads << " to " << after.threads << ", heap "
              << grown / 1000 << " kB larger\n";
}

}  // namespace
}  // namespace gonio::fault_test
