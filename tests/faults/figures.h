#pragma once
// What a row of the fault matrix showed over its seeds, for docs/reliability.md: one line of CSV at
// the end of the file that GONIO_FAULT_FIGURES names; without it nothing is written.
// figures.sh makes a table of such a file.

#include <string>

#include "tests/faults/measurement.h"

namespace gonio::fault_test {

class Figures {
public:
    Figures(const Row& row, std::string door) : row_(row.name), door_(std::move(door)) {}
    ~Figures();
    Figures(const Figures&) = delete;
    Figures& operator=(const Figures&) = delete;

    void add(const Outcome& outcome, bool passed);

private:
    std::string row_, door_, verdict_;
    int seeds_ = 0, passed_ = 0;
    long chunksResent_ = 0, framesRedone_ = 0, interruptions_ = 0, repeats_ = 0;
    Nanoseconds detected_{0}, reclaimed_{0}, noticed_{0}, call_{0};  ///< the longest
};

}  // namespace gonio::fault_test
