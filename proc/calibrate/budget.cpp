#include "proc/calibrate/budget.h"

namespace gonio::proc {

std::string_view name(Correlation correlation) {
    switch (correlation) {
        case Correlation::PerCell: return "per cell";
        case Correlation::PerState: return "per state";
        case Correlation::Common: return "common";
    }
    return "";
}

}  // namespace gonio::proc
