// coverage_study [REPEATS [FOLDER [FIRST]]]: the coverage report of docs/uncertainty.md. Writes
// coverage.md and coverage.csv into FOLDER, and the table to stdout. Repeat number n draws from
// seed n; FIRST is the number of the first one.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "proc/core/number_text.h"
#include "tests/study/coverage_repeat.h"

namespace {

constexpr std::int64_t kRepeats = 4400;
constexpr std::uint64_t kBlock = 100;

}  // namespace

int main(int argc, char** argv) {
    using namespace gonio::study;
    const auto wanted = argc > 1 ? gonio::parseInteger(argv[1]) : std::optional(kRepeats);
    const auto first = argc > 3 ? gonio::parseInteger(argv[3]) : std::optional<std::int64_t>(0);
    if (!wanted || *wanted < 1 || !first || *first < 0 || argc > 4) {
        std::cerr << "usage: coverage_study [REPEATS [FOLDER [FIRST]]]\n";
        return 2;
    }
    const std::filesystem::path folder = argc > 2 ? argv[2] : ".";
    const CoverageStudy study(kStrip);
    CoverageRows rows;
    const auto repeats = static_cast<std::uint64_t>(*wanted);
    for (std::uint64_t done = 0; done < repeats; done += kBlock) {
        rows.add(
            study.run(static_cast<std::uint64_t>(*first) + done, std::min(kBlock, repeats - done)));
        std::ofstream(folder / "coverage.md") << rows.markdown();
        std::ofstream(folder / "coverage.csv") << rows.csv();
        std::cerr << std::min(done + kBlock, repeats) << " of " << repeats << " repeats\n";
    }
    std::cout << rows.markdown();
}
