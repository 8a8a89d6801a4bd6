#include "daemon/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "proc/core/number_text.h"

namespace gonio::daemon {

Progress::Progress(std::string title, bool wanted)
    : title_(std::move(title)), wanted_(wanted && isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() { clear(); }

void Progress::clear() {
    if (drawn_) std::cerr << "\r\033[K" << std::flush;
    drawn_ = false;
}

void Progress::show(const ProgressStep& now) {
    if (!wanted_) return;
    constexpr int kWidth = 24;
    const int steps = std::max(1, now.steps);
    const auto filled = static_cast<std::size_t>(kWidth * std::clamp(now.step, 0, steps) / steps);
    std::cerr << "\r\033[K" << title_ << " [" << std::string(filled, '#')
              << std::string(kWidth - filled, '.') << "] " << now.step << "/" << steps << "  "
              << now.what;
    if (now.left.count() > 0) std::cerr << "  " << fixed(now.left.count(), 0) << " s to go";
    std::cerr << std::flush;
    drawn_ = true;
    last_ = now;
}

void Progress::show(const std::string& what) {
    ProgressStep now = last_;
    now.what = what;
    now.left = Seconds(0);
    show(now);
}

}  // namespace gonio::daemon
