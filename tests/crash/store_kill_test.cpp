// kill -9 at any moment: what the store acknowledged is there, whole; what it did not is absent or
// whole. A first test by chance; named failpoints prove it later.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <thread>

#include "daemon/store.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

constexpr int kRounds = 40;
constexpr std::size_t kBytes = 200'000;

/// Every sample has bytes of its own that its number tells.
std::string bytesOf(int number) {
    return std::string(kBytes, static_cast<char>('a' + number % 26)) + std::to_string(number);
}

std::string read(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Adds samples from `first` on until it is killed; each number goes down the pipe once the store
/// has said yes.
[[noreturn]] void writeUntilKilled(const std::filesystem::path& folder, int first, int pipe) {
    auto store = Store::open(folder);
    if (!store) _exit(1);
    for (int number = first;; ++number) {
        const auto added = store->addSample(
            {.name = "s" + std::to_string(number), .rig = "R1", .dateUtc = "today"},
            {.file = bytesOf(number), .raw = "raw " + bytesOf(number)});
        if (!added) _exit(2);
        if (::write(pipe, &number, sizeof number) != sizeof number) _exit(3);
    }
}

TEST(StoreKill, NothingAcknowledgedIsLostAndNothingIsHalf) {
    const test::TempFolder folder;
    ASSERT_TRUE(Store::open(folder.path()));
    std::mt19937 random(20);  // the delays
    std::uniform_int_distribution<int> delay(0, 60'000);
    std::set<int> acknowledged;
    int next = 0;
    for (int round = 0; round < kRounds; ++round) {
        int ends[2];
        ASSERT_EQ(::pipe(ends), 0);
        const pid_t child = ::fork();
        if (child == 0) writeUntilKilled(folder.path(), next, ends[1]);
        ::close(ends[1]);
        std::this_thread::sleep_for(std::chrono::microseconds(delay(random)));
        ASSERT_EQ(::kill(child, SIGKILL), 0);
        int status = 0;
        ::waitpid(child, &status, 0);
        ASSERT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself: " << WEXITSTATUS(status);
        for (int number = 0; ::read(ends[0], &number, sizeof number) == sizeof number;) {
            acknowledged.insert(number);
        }
        ::close(ends[0]);

        auto store = Store::open(folder.path());
        ASSERT_TRUE(store) << store.error().message;
        const auto all = store->samples();
        ASSERT_TRUE(all);
        std::set<int> present;
        for (const SampleRecord& sample : *all) {
            const int number = std::stoi(sample.name.substr(1));
            present.insert(number);
            ASSERT_EQ(read(sample.file), bytesOf(number)) << sample.name;
            ASSERT_EQ(read(sample.raw), "raw " + bytesOf(number)) << sample.name;
        }
        for (int number : acknowledged) ASSERT_TRUE(present.contains(number)) << number;
        next = present.empty() ? 0 : *present.rbegin() + 1;
    }
    EXPECT_GT(acknowledged.size(), 20U) << "the writers were killed before they wrote";
}

}  // namespace
}  // namespace gonio::daemon
