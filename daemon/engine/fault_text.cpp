#include "daemon/engine/fault_text.h"

#include "driver/protocol/constants.h"

namespace gonio::daemon {

std::string explained(std::uint16_t fault) {
    const std::string name = driver::statusName(fault);
    switch (fault) {
        case driver::status::kInterlock:
            return name + ": the aperture left the sample, or the hood is open; seat it again";
        case driver::status::kOverTemp: return name + ": too warm to light; let it cool";
        default: return name + ": if it stays, unplug the rig and plug it in again";
    }
}

}  // namespace gonio::daemon
