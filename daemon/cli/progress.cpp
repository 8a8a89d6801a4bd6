#include "daemon/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "proc/core/number_text.h"

namespace gonio::daemon {

Progress::Progress(std::string title, int steps, const Clock& clock, bool wanted)
    : title_(std::move(title)),
      steps_(std::max(1, steps)),
      watch_(clock),
      shown_(wanted && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    if (shown_ && done_ > 0) std::cerr << "\r\033[K" << std::flush;
}

void Progress::step(const std::string& what) {
    done_ = std::min(done_ + 1, steps_);
    if (!shown_) return;
    constexpr int kWidth = 24;
    const auto filled = static_cast<std::size_t>(kWidth * done_ / steps_);
    const double left = watch_.elapsed().count() * (steps_ - done_) / done_;
    std::cerr << "\r\033[K" << title_ << " [" << std::string(filled, '#')
              << std::string(kWidth - filled, '.') << "] " << done_ << "/" << steps_ << "  " << what
              << "  " << fixed(left, 0) << " s to go" << std::flush;
}

}  // namespace gonio::daemon
