#include "driver/usb_power.h"

#include <fstream>
#include <mutex>
#include <set>

#include "driver/udev_rule.h"
#include "proc/core/log.h"

namespace gonio::driver {
namespace {

std::string pathOf(const std::string& place) {
    return "/sys/bus/usb/devices/" + place + "/power/control";
}

bool firstTime(const std::string& place) {
    static std::mutex mutex;
    static std::set<std::string> told;
    const std::scoped_lock lock(mutex);
    return told.insert(place).second;
}

}  // namespace

std::string powerControl(const std::string& place) {
    std::ifstream file(pathOf(place));
    std::string word;
    file >> word;
    return word;
}

void keepAwake(const std::string& place) {
    const std::string found = powerControl(place);
    if (found.empty() || found == "on") return;
    {
        std::ofstream file(pathOf(place));
        file << "on" << std::flush;
    }
    if (powerControl(place) == "on" || !firstTime(place)) return;
    log::warning("USB device " + place + " may be put to sleep by the system: write \"on\" into " +
                 pathOf(place) + ", or install " + std::string(kUdevRuleFile));
}

}  // namespace gonio::driver
