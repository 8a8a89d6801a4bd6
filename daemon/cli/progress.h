#pragma once
// A progress bar with the time still to go, on stderr when that is a terminal; silent otherwise.

#include <string>

#include "proc/core/stopwatch.h"

namespace gonio::daemon {

class Progress {
public:
    /// `clock` must outlive the bar.
    Progress(std::string title, int steps, const Clock& clock, bool wanted);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more step is done.
    void step(const std::string& what);

private:
    std::string title_;
    int steps_;
    int done_ = 0;
    Stopwatch watch_;
    bool shown_;
};

}  // namespace gonio::daemon
