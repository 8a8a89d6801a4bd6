#include "tests/faults/figures.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>

namespace gonio::fault_test {
namespace {

int countOf(const Outcome& outcome, const char* name) {
    const auto found = outcome.counts.find(name);
    return found == outcome.counts.end() ? 0 : found->second;
}

}  // namespace

void Figures::add(const Outcome& outcome, bool passed) {
    ++seeds_;
    passed_ += passed ? 1 : 0;
    verdict_ = outcome.verdict;
    chunksResent_ += countOf(outcome, "chunksResent");
    framesRedone_ += countOf(outcome, "redone");
    interruptions_ += countOf(outcome, "interruptions");
    repeats_ += countOf(outcome, "repeats");
    detected_ = std::max(detected_, outcome.detected);
    reclaimed_ = std::max(reclaimed_, outcome.reclaimed);
    noticed_ = std::max(noticed_, outcome.noticed);
    call_ = std::max(call_, outcome.longestCall);
}

Figures::~Figures() {
    const char* file = std::getenv("GONIO_FAULT_FIGURES");
    if (!file || seeds_ == 0) return;
    const auto ms = [](Nanoseconds time) {
        return std::chrono::duration<double, std::milli>(time).count();
    };
    std::ofstream(file, std::ios::app)
        << row_ << ',' << door_ << ',' << seeds_ << ',' << passed_ << ',' << verdict_ << ','
        << ms(detected_) << ',' << ms(reclaimed_) << ',' << ms(noticed_) << ',' << ms(call_) << ','
        << chunksResent_ << ',' << framesRedone_ << ',' << interruptions_ << ',' << repeats_
        << '\n';
}

}  // namespace gonio::fault_test
