#pragma once
// A progress bar with the time still to go, on stderr when that is a terminal; silent otherwise.

#include <string>

#include "proc/core/units.h"

namespace gonio::daemon {

struct ProgressStep {
    int step = 0, steps = 1;
    std::string what;
    Seconds left{0};
};

class Progress {
public:
    Progress(std::string title, bool wanted);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(const ProgressStep& now);
    /// Another word for what is done, where no step is.
    void show(const std::string& what);
    /// Makes room for other text.
    void clear();

private:
    std::string title_;
    bool wanted_;
    bool drawn_ = false;
    ProgressStep last_;
};

}  // namespace gonio::daemon
