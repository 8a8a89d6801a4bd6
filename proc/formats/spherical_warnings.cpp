#include "proc/formats/spherical_warnings.h"

#include <algorithm>

#include "proc/table/peak_quarter.h"

namespace gonio::proc {

std::vector<std::string> sphericalWarnings(const SphericalTable& table) {
    std::vector<std::string> warnings;
    std::ptrdiff_t negative = 0;
    for (const SphericalBlock& block : table.blocks) {
        negative += std::count_if(block.f.begin(), block.f.end(), [](double f) { return f < 0; });
    }
    if (negative > 0) warnings.push_back(std::to_string(negative) + " negative values");
    const auto isPlane = [](const SphericalBlock& block) {
        return block.azimuthDeg.size() == 1 && !block.isRound();
    };
    const auto planes = std::count_if(table.blocks.begin(), table.blocks.end(), isPlane);
    if (planes > 0 && !table.cellCentred) {
        warnings.push_back(std::to_string(planes) +
                           " blocks have values at a single azimuth: they answer on it alone");
    }
    if (auto peak = peakWarning(table)) warnings.push_back(std::move(*peak));
    return warnings;
}

}  // namespace gonio::proc
