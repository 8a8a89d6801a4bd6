#include "daemon/doctor_usb.h"

#include <unistd.h>

#include <algorithm>
#include <set>

#include "daemon/device_holders.h"
#include "daemon/doctor_system.h"
#include "driver/protocol/constants.h"
#include "driver/udev_rule.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

constexpr int kHighSpeed = 480, kSuperSpeed = 5000;  // Mbit/s

/// The rig in the kernel's eyes.
struct Sysfs {
    fs::path device;                   ///< /sys/bus/usb/devices/1-2
    std::vector<fs::path> interfaces;  ///< 1-2:1.0, 1-2:1.1, in this order
};

std::vector<fs::path> listed(const fs::path& folder) {
    std::error_code failed;
    std::vector<fs::path> entries;
    for (fs::directory_iterator entry(folder, failed); !failed && entry != fs::directory_iterator();
         entry.increment(failed)) {
        entries.push_back(entry->path());
    }
    std::sort(entries.begin(), entries.end());
    return entries;
}

Sysfs sysfsOf(const Patient& patient, const driver::UsbRig& rig) {
    Sysfs sysfs{.device = under(patient.root, "/sys/bus/usb/devices/" + rig.place),
                .interfaces = {}};
    for (const fs::path& entry : listed(sysfs.device)) {
        if (entry.filename().string().starts_with(rig.place + ":"))
            sysfs.interfaces.push_back(entry);
    }
    return sysfs;
}

bool isHid(const fs::path& interface) { return firstLine(interface / "bInterfaceClass") == "03"; }

std::string driverOf(const fs::path& interface) {
    std::error_code none;
    return fs::read_symlink(interface / "driver", none).filename().string();
}

/// "/dev/hidraw3", below the HID interface.
std::vector<std::string> hidrawNodes(const Sysfs& sysfs) {
    std::vector<std::string> nodes;
    for (const fs::path& interface : sysfs.interfaces) {
        if (!isHid(interface)) continue;
        for (const fs::path& device : listed(interface)) {
            for (const fs::path& node : listed(device / "hidraw"))
                nodes.push_back("/dev/" + node.filename().string());
        }
    }
    return nodes;
}

std::vector<std::string> nodesOf(const Sysfs& sysfs) {
    std::vector<std::string> nodes = hidrawNodes(sysfs);
    const auto bus = parseInteger(firstLine(sysfs.device / "busnum"));
    const auto number = parseInteger(firstLine(sysfs.device / "devnum"));
    if (!bus || !number) return nodes;
    const auto three = [](std::int64_t n) {
        const std::string digits = std::to_string(n);
        return std::string(digits.size() < 3 ? 3 - digits.size() : 0, '0') + digits;
    };
    nodes.push_back("/dev/bus/usb/" + three(*bus) + "/" + three(*number));
    return nodes;
}

Finding permission(const driver::UsbRig& rig) {
    if (rig.obstacle.empty()) return {"permission", Verdict::Ok, "may be opened", ""};
    const std::string rule = driver::permissionCure(rig.vendor, rig.product);
    const std::size_t at = rig.obstacle.find(": " + rule);
    if (at == std::string::npos)
        return {"permission",
                Verdict::Fail,
                rig.obstacle,
                "see hidraw-node and holder; then plug it in again"};
    return {"permission",
            Verdict::Fail,
            rig.obstacle.substr(0, at),
            ruleInFull({.vendor = rig.vendor, .product = rig.product})};
}

Finding kernelDriver(const Sysfs& sysfs) {
    std::string seen;
    std::string other;  // a kernel driver on the stream
    for (const fs::path& interface : sysfs.interfaces) {
        const std::string driver = driverOf(interface);
        const bool hid = isHid(interface);
        if (!driver.empty() && !hid && driver != "usbfs") other = driver;
        seen += (seen.empty() ? "" : ", ") + std::string(hid ? "reports: " : "stream: ") +
                (driver.empty() ? "none" : driver);
    }
    if (seen.empty()) return {"kernel-driver", Verdict::Note, "sysfs does not show the rig", ""};
    if (other.empty()) return {"kernel-driver", Verdict::Ok, seen, ""};
    return {"kernel-driver",
            Verdict::Warn,
            seen,
            "it is detached each time the rig is opened; for good: echo 'blacklist " + other +
                "' > /etc/modprobe.d/gonio.conf"};
}

Finding hidrawNode(const Sysfs& sysfs) {
    const auto nodes = hidrawNodes(sysfs);
    if (!nodes.empty()) return {"hidraw-node", Verdict::Ok, nodes.front(), ""};
    return {"hidraw-node",
            Verdict::Fail,
            "a rig is there, but no hidraw node",
            "load the module: modprobe usbhid; in a container: hand /dev/hidraw* and /sys in"};
}

Finding speed(const driver::UsbRig& rig) {
    const std::string seen = std::to_string(rig.speed) + " Mbit/s";
    if (rig.speed == 0) return {"speed", Verdict::Note, "the kernel does not say", ""};
    if (rig.speed < kHighSpeed) {
        return {"speed",
                Verdict::Fail,
                seen + ", a rig needs 480",
                "another cable or port: this one does not carry High Speed"};
    }
    if (rig.superSpeed && rig.speed < kSuperSpeed) {
        return {"speed",
                Verdict::Warn,
                seen + ", the rig could do 5000",
                "a SuperSpeed port and a SuperSpeed cable (blue, or marked SS), without a hub or "
                "extension of USB 2 between; frames come slower until then"};
    }
    return {"speed", Verdict::Ok, seen, ""};
}

Finding autosuspend(const Sysfs& sysfs) {
    const fs::path file = sysfs.device / "power/control";
    const std::string control = firstLine(file);
    if (control.empty()) return {"autosuspend", Verdict::Note, "the kernel does not say", ""};
    if (control == "on") return {"autosuspend", Verdict::Ok, "off: power/control is on", ""};
    const auto delay = parseInteger(firstLine(sysfs.device / "power/autosuspend_delay_ms"));
    if (delay && *delay < 0)
        return {"autosuspend", Verdict::Ok, "never: its delay is " + std::to_string(*delay), ""};
    return {"autosuspend",
            Verdict::Warn,
            "power/control is " + control +
                (delay ? ", after " + std::to_string(*delay) + " ms" : "") +
                ": a suspended rig goes dark",
            "as root: echo on > " + file.string() + "; the udev rule does it at each plug"};
}

std::string joined(const std::set<std::string>& names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return all;
}

/// "goniod (pid 55)" of each program that has the rig's nodes open.
struct Users {
    std::set<std::string> daemons;  ///< the one that was asked
    std::set<std::string> others;   ///< have the device
    std::set<std::string> readers;  ///< have its reports only
    bool claimed = false;
    int unseen = 0;  ///< processes that could not be looked into

    [[nodiscard]] bool hidden() const { return claimed && others.empty() && daemons.empty(); }
    [[nodiscard]] std::string unseenText() const {
        return std::to_string(unseen) + " processes of other users";
    }
};

Users usersOf(const Patient& patient, const Sysfs& sysfs) {
    const DeviceHolders found = holdersOf(nodesOf(sysfs), patient.root, ::getpid());
    Users users;
    users.unseen = found.unseen;
    users.claimed = std::any_of(sysfs.interfaces.begin(),
                                sysfs.interfaces.end(),
                                [](const fs::path& i) { return driverOf(i) == "usbfs"; });
    for (const DeviceHolder& one : found.holders) {
        const std::string who = one.program + " (pid " + std::to_string(one.pid) + ")";
        const bool daemons = patient.daemon && one.pid == patient.daemon->pid;
        const bool reports = one.node.starts_with("/dev/hidraw");
        (daemons ? users.daemons : reports ? users.readers : users.others).insert(who);
    }
    return users;
}

/// Whose daemon has another rig does not miss this one.
bool hasAnother(const Patient& patient) {
    return patient.daemon && patient.daemon->rigKind == "usb" && !patient.daemon->rigSerial.empty();
}

Finding holder(const Patient& patient, const Users& users) {
    if (!users.daemons.empty()) {
        return {"holder", Verdict::Ok, joined(users.daemons) + ", the daemon that was asked", ""};
    }
    if (!users.others.empty() && hasAnother(patient)) {
        const std::string& its = patient.daemon->rigSerial;
        return {"holder",
                Verdict::Note,
                "open in " + joined(users.others) + "; the daemon that was asked has rig " + its,
                ""};
    }
    if (!users.others.empty()) {
        return {"holder",
                Verdict::Fail,
                "open in " + joined(users.others),
                "end that program, or use its daemon: gonio --socket SOCKET"};
    }
    if (users.hidden()) {
        return {"holder",
                Verdict::Fail,
                "a program that cannot be seen has claimed it, one of " + users.unseenText(),
                "run gonio doctor as root: it then names the program"};
    }
    if (!users.readers.empty()) {
        return {"holder",
                Verdict::Warn,
                "its reports are open in " + joined(users.readers),
                "harmless while that program only reads; end it if commands go astray"};
    }
    if (users.unseen == 0) return {"holder", Verdict::Ok, "nobody", ""};
    return {"holder",
            Verdict::Note,
            "no program of yours; " + users.unseenText() + " cannot be looked into",
            "as root all are seen"};
}

}  // namespace

Finding unshown(const Patient& patient, const std::vector<Finding>& said) {
    const bool all = patient.rigs &&
                     std::none_of(patient.rigs->begin(), patient.rigs->end(), [](const auto& rig) {
                         return rig.serial.empty();
                     });
    const bool claimed = std::none_of(said.begin(), said.end(), [](const Finding& one) {
        return one.subject == "claim" && one.verdict == Verdict::Fail;
    });
    if (all && !claimed) return {"usb", Verdict::Fail, "it is not plugged in", "plug it in"};
    return {"usb",
            Verdict::Note,
            "not shown to this program",
            "in a container: hand /dev/bus/usb in; or ask where goniod runs"};
}

Finding protocolFinding(const std::string& protocol) {
    const std::string ours = "GRP/" + std::to_string(driver::kProtocolMajor) + "." +
                             std::to_string(driver::kProtocolMinor);
    const std::string both =
        "the rig speaks " + (protocol.empty() ? "?" : protocol) + ", this program " + ours;
    if (protocol.empty())
        return {"protocol", Verdict::Note, "cannot be read before the rig may be opened", ""};
    if (protocol.starts_with("GRP/" + std::to_string(driver::kProtocolMajor) + "."))
        return {"protocol", Verdict::Ok, both, ""};
    return {"protocol", Verdict::Fail, both, "bring the rig's firmware or this program up to date"};
}

std::vector<Finding> examineOutside(const Patient& patient, const driver::UsbRig& rig) {
    const Sysfs sysfs = sysfsOf(patient, rig);
    return {permission(rig),
            protocolFinding(rig.protocol),
            kernelDriver(sysfs),
            hidrawNode(sysfs),
            speed(rig),
            autosuspend(sysfs),
            holder(patient, usersOf(patient, sysfs))};
}

std::string inTheWay(const Patient& patient, const driver::UsbRig& rig) {
    if (!rig.obstacle.empty()) return "it may not be opened (see permission)";
    if (usedByDaemon(patient, rig))
        return "goniod (pid " + std::to_string(patient.daemon->pid) + ") uses it";
    const Users users = usersOf(patient, sysfsOf(patient, rig));
    if (!users.others.empty()) return joined(users.others) + " has it open";
    return users.hidden() ? "a program that cannot be seen has claimed it" : std::string();
}

}  // namespace gonio::daemon
