#include "daemon/cli/incidence_list.h"

#include "proc/core/number_text.h"
#include "proc/models/spec_parameters.h"

namespace gonio::daemon {

Result<std::vector<Radians>> incidenceList(const std::string& list) {
    std::vector<Radians> all;
    for (const std::string_view word : proc::split(list, ',')) {
        const auto degrees = parseDouble(word);
        if (!degrees || *degrees < 0 || *degrees >= 90) {
            return Error{ErrorKind::Usage,
                         "--incidences '" + std::string(word) +
                             "', wanted degrees from 0 to below 90, with commas"};
        }
        all.push_back(Radians::fromDegrees(*degrees));
    }
    return all;
}

}  // namespace gonio::daemon
