#pragma once
// The figures of the study that proposed a cubic of Schlick's form for cos^n [Zavalniuk2024], each
// with what it is here.

#include <string>
#include <vector>

#include "proc/models/power_errors.h"
#include "proc/models/schlick_regression.h"

namespace gonio::proc {

/// A figure of the paper and what it is here.
struct PaperFigure {
    std::string what;
    std::string printed;
    double here = 0;
    bool reproduces = false;
    std::string remark;
};
/// A figure reproduces where it is the same when rounded to the digits that were printed; "most n"
/// where it is more than half of them.
[[nodiscard]] std::vector<PaperFigure> paperFigures(const SchlickRegression& regression,
                                                    const PowerGrid& grid,
                                                    const StudyProgress& progress = {});

}  // namespace gonio::proc
