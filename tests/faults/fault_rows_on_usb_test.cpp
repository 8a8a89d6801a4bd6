// Every row of the fault matrix through the real USB code, with the verdict that it has in process,
// and without a file descriptor or a thread left behind.

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/faults/figures.h"
#include "tests/faults/measurement.h"
#include "tests/faults/mocked_rig.h"
#include "tests/faults/row_seeds.h"
#include "tests/support/wait_until.h"

namespace gonio::fault_test {
namespace {

std::size_t threads() {
    const std::filesystem::directory_iterator all("/proc/self/task");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

/// Open device nodes and timers: the driver's alone, while the mocked bus has sockets and events.
std::size_t devices() {
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd")) {
        std::error_code gone;
        const std::string target = std::filesystem::read_symlink(file.path(), gone).string();
        for (const char* part : {"/dev/bus/usb/", "/dev/hidraw", "timerfd"})
            count += target.find(part) != std::string::npos ? 1U : 0U;
    }
    return count;
}

void play(const Row& row, const RigSetup& setup, Figures& figures) {
    const std::string seed = "seed " + std::to_string(row.script.seed);
    const auto door = mocked(setup);
    (void)door->open();
    door->close();  // what the libraries keep for good, they have now
    const std::size_t opened = devices(), running = threads();
    const Outcome outcome = measure(*door, setup, row);
    const auto bad = complaints(row, outcome, undisturbed(setup));
    figures.add(outcome, bad.empty());
    for (const std::string& complaint : bad) ADD_FAILURE() << seed << ": " << complaint;
    // What a busy machine could not end in time ends a little later.
    EXPECT_TRUE(test::waitUntil([&] { return threads() <= running && devices() <= opened; }))
        << seed << ": " << threads() << " threads, were " << running << "; " << devices()
        << " devices, were " << opened;
}

class FaultRowOnUsb : public testing::TestWithParam<std::string> {};

TEST_P(FaultRowOnUsb, HasTheSameVerdict) {
    constexpr int kNightly = 20;
    constexpr int kSide = 256, kChunk = 16384;  // a ring of a hundred transfers, not of a thousand
    const RigSetup setup = setupOf(kSide, kChunk);
    const Row all = readRow(GetParam());
    Figures figures(all, "umockdev");
    const Seeds seeds = seedsOf(kNightly);
    for (Row& row : variantsOf(all)) {
        for (int seed = seeds.first; seed <= seeds.last; ++seed) {
            row.script.seed = static_cast<std::uint64_t>(seed);
            play(row, setup, figures);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Matrix,
                         FaultRowOnUsb,
                         testing::ValuesIn(rowNames("umockdev")),
                         [](const auto& row) { return testName(row.param); });

}  // namespace
}  // namespace gonio::fault_test
