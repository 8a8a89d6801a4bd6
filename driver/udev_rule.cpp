#include "driver/udev_rule.h"

#include "driver/usb_find.h"

namespace gonio::driver {
namespace {

constexpr const char* kAccess = "GROUP=\"plugdev\", MODE=\"0660\", TAG+=\"uaccess\"";

std::string ids(const std::string& match, std::uint16_t vendor, std::uint16_t product) {
    const std::string both = idText(vendor, product);  // "1209:0001"
    return match + "{idVendor}==\"" + both.substr(0, 4) + "\", " + match + "{idProduct}==\"" +
           both.substr(5) + "\", ";
}

}  // namespace

std::array<std::string, 2> udevRule(std::uint16_t vendor, std::uint16_t product) {
    // A suspended rig goes dark and its session lapses: it is kept awake.
    return {"SUBSYSTEM==\"usb\", ENV{DEVTYPE}==\"usb_device\", " + ids("ATTR", vendor, product) +
                kAccess + ", ATTR{power/control}=\"on\"",
            "SUBSYSTEM==\"hidraw\", " + ids("ATTRS", vendor, product) + kAccess};
}

std::string permissionCure(std::uint16_t vendor, std::uint16_t product) {
    const auto [usb, hidraw] = udevRule(vendor, product);
    return std::string("put two lines into ") + kUdevRuleFile + ": " + usb + " and " + hidraw +
           "; then run udevadm control --reload and plug the rig in again";
}

}  // namespace gonio::driver
