#include "proc/formats/loss_report.h"

namespace gonio::proc {

std::string_view name(Loss kind) {
    switch (kind) {
        case Loss::Resampled: return "resampled";
        case Loss::Clamped: return "clamped";
        case Loss::Masked: return "masked";
        case Loss::Extrapolated: return "extrapolated";
        case Loss::Dropped: return "dropped";
    }
    return "lost";
}

}  // namespace gonio::proc
