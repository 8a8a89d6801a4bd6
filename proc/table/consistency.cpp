#include "proc/table/consistency.h"

#include <cmath>

#include "proc/core/median.h"
#include "proc/solve/chi_square.h"

namespace gonio::proc {

double Consistency::perFreedom() const {
    return freedom == 0 ? std::numeric_limits<double>::quiet_NaN()
                        : chiSquare / static_cast<double>(freedom);
}

double Consistency::probability() const {
    return freedom == 0 ? 1 : chiSquareTail(chiSquare, static_cast<double>(freedom));
}

void ConsistencySum::add(const Group& group) {
    if (group.freedom == 0) return;
    sum_.chiSquare += group.chiSquare;
    sum_.freedom += group.freedom;
    sum_.values += group.freedom + 1;
    sum_.outliers += group.outliers;
    if (std::isfinite(group.relative)) relative_.push_back(group.relative);
}

Consistency ConsistencySum::result() const {
    Consistency result = sum_;
    result.medianRelative = median(relative_);
    return result;
}

}  // namespace gonio::proc
