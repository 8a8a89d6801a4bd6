#include "daemon/doctor_system.h"

#include <unistd.h>

#include <array>
#include <fstream>

#include "driver/udev_rule.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {

namespace fs = std::filesystem;

namespace {

constexpr const char* kRule = "70-gonio.rules";
// A rig's stream keeps 2 MiB in flight (docs/protocol.md 3); other devices share the rest.
constexpr std::int64_t kLeastUsbMegabytes = 16;
constexpr std::uintmax_t kLeastFreeBytes = 1ULL << 30;  // some 60 measurements with their raw data
constexpr double kMebibyte = 1024.0 * 1024.0;

Finding usb(const Patient& patient) {
    if (!patient.rigs) {
        return {"usb",
                Verdict::Warn,
                patient.rigs.error().message,
                "in a container: hand /dev/bus/usb in; the simulated rig works without"};
    }
    if (patient.rigs->empty()) {
        return {"usb", Verdict::Note, "no rig is plugged in", "plug it in, or use --rig sim"};
    }
    std::string seen;
    for (const driver::UsbRig& rig : *patient.rigs) {
        seen += (seen.empty() ? "" : ", ") + (rig.serial.empty() ? "a rig" : rig.serial) + " at " +
                rig.place;
    }
    return {"usb", Verdict::Ok, seen, ""};
}

Finding udevRule(const Patient& patient) {
    constexpr std::array kPlaces{"/etc/udev/rules.d",
                                 "/usr/local/lib/udev/rules.d",
                                 "/usr/lib/udev/rules.d",
                                 "/lib/udev/rules.d"};
    std::error_code ignored;
    for (const char* place : kPlaces) {
        const fs::path rule = under(patient.root, place) / kRule;
        if (fs::exists(rule, ignored)) return {"udev-rule", Verdict::Ok, rule.string(), ""};
    }
    if (::geteuid() == 0) return {"udev-rule", Verdict::Note, "missing, root does without", ""};
    return {"udev-rule", Verdict::Warn, "missing: only root can open a rig", ruleInFull({})};
}

Finding hotplug(const Patient& patient) {
    std::error_code ignored;
    if (fs::exists(under(patient.root, "/run/udev/control"), ignored)) {
        return {"hotplug", Verdict::Ok, "udevd runs", ""};
    }
    return {"hotplug",
            Verdict::Note,
            "no udevd (a container?): a rig is looked for each 500 ms instead",
            ""};
}

Finding usbfsMemory(const Patient& patient) {
    const fs::path file = under(patient.root, "/sys/module/usbcore/parameters/usbfs_memory_mb");
    const auto megabytes = parseInteger(firstLine(file));
    if (!megabytes) {
        return {"usbfs-memory", Verdict::Note, "this kernel has no USB", "use --rig sim"};
    }
    const std::string seen = std::to_string(*megabytes) + " MiB for all USB devices";
    // 0 is no limit.
    if (*megabytes == 0 || *megabytes >= kLeastUsbMegabytes) {
        return {"usbfs-memory", Verdict::Ok, seen, ""};
    }
    return {"usbfs-memory", Verdict::Warn, seen, "as root: echo 64 > " + file.string()};
}

Finding hidraw(const Patient& patient) {
    std::error_code failed;
    const fs::directory_iterator nodes(under(patient.root, "/sys/class/hidraw"), failed);
    if (failed) {
        return {"hidraw",
                Verdict::Warn,
                "this kernel has no hidraw (CONFIG_HIDRAW)",
                "a rig's LED controller needs it; the simulated rig works without"};
    }
    const auto count = std::distance(begin(nodes), end(nodes));
    return {"hidraw", Verdict::Ok, std::to_string(count) + (count == 1 ? " node" : " nodes"), ""};
}

/// The nearest folder above that exists: there the store would be made.
fs::path existing(fs::path folder) {
    std::error_code ignored;
    folder = fs::absolute(folder, ignored);
    while (!fs::exists(folder, ignored) && folder.has_relative_path())
        folder = folder.parent_path();
    return folder;
}

Finding store(const Patient& patient) {
    const fs::path folder = existing(patient.store);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) {
        return {"store",
                Verdict::Fail,
                patient.store.string() + " cannot be written",
                "choose another with --store DIR, or change its owner"};
    }
    std::error_code failed;
    const fs::space_info space = fs::space(folder, failed);
    const std::string seen = patient.store.string() + ", " +
                             fixed(static_cast<double>(space.available) / kMebibyte / 1024, 1) +
                             " GiB free";
    if (!failed && space.available < kLeastFreeBytes) {
        return {"store", Verdict::Warn, seen, "make room: a measurement takes about 16 MiB"};
    }
    return {"store", Verdict::Ok, seen, ""};
}

Finding daemonReached(const Patient& patient) {
    if (patient.daemon) {
        const std::string seen = "goniod answers, pid " + std::to_string(patient.daemon->pid);
        const std::string& obstacle = patient.daemon->obstacle;
        if (obstacle.empty()) return {"daemon", Verdict::Ok, seen, ""};
        const std::string& serial = patient.daemon->rigSerial;
        return {"daemon",
                Verdict::Warn,
                seen + ", and is hindered: " + obstacle,
                serial.empty() ? "see usb, and permission and holder of the rig"
                               : "see claim of rig " + serial};
    }
    // What to do about it is said below.
    const std::string& why = patient.daemon.error().message;
    return {"daemon",
            Verdict::Warn,
            why.substr(0, why.find("; start one")),
            "start it: goniod --rig usb, or goniod --rig sim"};
}

}  // namespace

fs::path under(const fs::path& root, const std::string& path) { return root / path.substr(1); }

std::string firstLine(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

std::string ruleInFull(const driver::UsbSelection& ids) {
    const auto [usb, hidraw] = driver::udevRule(ids.vendor, ids.product);
    return std::string("put these two lines into ") + driver::kUdevRuleFile + ":\n" + usb + "\n" +
           hidraw + "\nthen: udevadm control --reload, and plug the rig in again";
}

std::vector<Finding> examineComputer(const Patient& patient) {
    return {usb(patient),
            udevRule(patient),
            hotplug(patient),
            usbfsMemory(patient),
            hidraw(patient),
            store(patient),
            daemonReached(patient)};
}

}  // namespace gonio::daemon
