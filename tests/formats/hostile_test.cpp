// Every reader against every kind of damage to its small sound files: each is taken or refused in
// one File error of one line, with at most 50 MiB and a second for a file of a megabyte. The
// deadline is ten times that second of processor time: what fails it does so on any machine.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "proc/formats/format.h"
#include "tests/formats/allocation_peak.h"
#include "tests/formats/damage.h"
#include "tests/formats/readers.h"

namespace gonio::test {
namespace {

constexpr std::size_t kMostBytes = std::size_t{50} << 20U;
constexpr double kMostSeconds = 10;
constexpr std::size_t kLongestMessage = 600;

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The worst of all files that one reader was given.
struct Cost {
    double seconds = 0;
    std::size_t bytes = 0;
    std::size_t refused = 0;
    std::string slowest, largest;
};

void read(const Reader& reader, const Damaged& file, Cost& cost) {
    const std::string where = std::string(reader.name) + ", " + file.what;
    const double begin = processorSeconds();
    const AllocationPeak peak;
    const std::optional<Error> complaint = reader.complaint(file.bytes);
    const double seconds = processorSeconds() - begin;
    EXPECT_LE(seconds, kMostSeconds) << where;
    EXPECT_LE(peak.bytes(), kMostBytes) << where;
    if (seconds > cost.seconds) cost = {seconds, cost.bytes, cost.refused, where, cost.largest};
    if (peak.bytes() > cost.bytes) {
        cost.bytes = peak.bytes();
        cost.largest = where;
    }
    if (!complaint) return;
    ++cost.refused;
    const std::string& message = complaint->message;
    EXPECT_EQ(complaint->kind, ErrorKind::File) << where << ": " << message;
    EXPECT_LE(message.size(), kLongestMessage) << where << ": " << message.substr(0, 800);
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << where << ": " << message;
    EXPECT_NE(message.find("in: "), std::string::npos) << where << ": " << message;
}

using Damage = std::vector<Damaged> (*)(std::string_view sound);

class HostileFiles : public testing::TestWithParam<Reader> {
protected:
    void suffer(const std::vector<Damaged>& files) {
        for (const Damaged& each : files) {
            if (HasFailure()) return;
            read(GetParam(), each, cost_);
        }
        tried_ += files.size();
    }

    /// Damages each sound file.
    void sufferAll(Damage damage) {
        for (const std::string& sound : GetParam().sound()) suffer(damage(sound));
    }

    void TearDown() override {
        if (tried_ == 0) return;
        std::printf("%zu files, %zu refused; at most %.0f ms (%s), %.1f MiB (%s)\n",
                    tried_,
                    cost_.refused,
                    1e3 * cost_.seconds,
                    cost_.slowest.c_str(),
                    static_cast<double>(cost_.bytes) / (1 << 20),
                    cost_.largest.c_str());
        if (GetParam().name != "sniff") {
            EXPECT_GT(cost_.refused, 0U);
        }
    }

private:
    Cost cost_;
    std::size_t tried_ = 0;
};

TEST_P(HostileFiles, AreSoundToBeginWith) {
    ASSERT_FALSE(GetParam().sound().empty());
    for (const std::string& sound : GetParam().sound()) {
        const auto complaint = GetParam().complaint(sound);
        EXPECT_FALSE(complaint) << complaint->message;
    }
}

TEST_P(HostileFiles, MayEndAnywhere) { sufferAll(truncated); }
TEST_P(HostileFiles, MayHoldMoreThanTheyShould) { sufferAll(extended); }
TEST_P(HostileFiles, MayHoldAnyNumber) {
    if (GetParam().text) sufferAll(withBadNumbers);
}
TEST_P(HostileFiles, MayHaveLinesTwiceOrNot) {
    if (GetParam().text) sufferAll(withBadLines);
}
TEST_P(HostileFiles, MayHoldAnyBytes) { sufferAll(withBadWords); }
TEST_P(HostileFiles, MayHoldAMegabyteOfOneWord) { sufferAll(withAMegabyteOfOne); }
TEST_P(HostileFiles, MayBeAMegabyteOfOneWord) { suffer(megabytesOfOne()); }

std::string nameOf(const testing::TestParamInfo<Reader>& info) {
    std::string name(info.param.name);
    std::erase(name, '-');
    return name;
}
INSTANTIATE_TEST_SUITE_P(Of, HostileFiles, testing::ValuesIn(readers()), nameOf);

TEST(HostileFilesOf, EveryFormatAreTried) {
    for (const proc::FormatFacts& facts : proc::formats()) {
        EXPECT_NE(readerOf(facts.name), nullptr) << facts.name;
    }
}

}  // namespace
}  // namespace gonio::test
