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
    if (auto peak = peakWarning(table)) warnings.push_back(std::move(*peak));
    return warnings;
}

}  // namespace gonio::proc
