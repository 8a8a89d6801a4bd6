#include "proc/formats/flag_column.h"

#include <cmath>
#include <string>

#include "proc/core/number_text.h"

namespace gonio::proc {

Result<std::vector<Flags>> flagsOf(const Points& points, std::string_view column) {
    const Result<std::vector<double>> masks = numbersOf(points, column);
    if (!masks) return masks.error();
    std::vector<Flags> flags;
    flags.reserve(masks->size());
    for (const double mask : *masks) {
        if (!(mask >= 0 && mask < 1 << kFlagCount && mask == std::floor(mask))) {
            return Error{ErrorKind::File,
                         "csv: data row " + std::to_string(flags.size() + 1) + ": " +
                             std::string(column) + ": " + shortest(mask) + ", wanted a mask of " +
                             std::to_string(kFlagCount) + " flags"};
        }
        flags.push_back(Flags::fromMask(static_cast<std::uint32_t>(mask)));
    }
    return flags;
}

bool isLost(Flags flags) {
    return flags.has(Flag::Saturated) || flags.has(Flag::Blocked) || flags.has(Flag::BelowHorizon);
}

}  // namespace gonio::proc
