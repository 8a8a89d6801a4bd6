#include "daemon/engine/usb_port.h"

namespace gonio::daemon {
namespace {

/// What is there instead of the rig that is wanted; empty: nothing.
std::string othersThan(const driver::UsbSelection& wanted) {
    const auto rigs = driver::listUsb({.vendor = wanted.vendor, .product = wanted.product});
    if (!rigs) return {};
    std::string others;
    for (const driver::UsbRig& rig : *rigs) {
        if (!rig.serial.empty() && rig.serial != *wanted.serial) {
            others += (others.empty() ? "" : ", ") + rig.serial;
        }
    }
    return others;
}

}  // namespace

Result<std::vector<RigListing>> UsbPort::list() {
    const auto rigs = driver::listUsb({.vendor = selection_.vendor, .product = selection_.product});
    if (!rigs) return rigs.error();
    std::vector<RigListing> listed;
    for (const driver::UsbRig& rig : *rigs) {
        listed.push_back({.kind = "usb",
                          .serial = rig.serial,
                          .place = rig.place,
                          .protocol = rig.protocol,
                          .obstacle = rig.obstacle});
    }
    return listed;
}

Result<driver::Transport*> UsbPort::open() {
    auto opened = driver::openUsb(selection_);
    if (!opened) {
        const std::string others = selection_.serial ? othersThan(selection_) : "";
        if (opened.error().kind != ErrorKind::NoRig || others.empty()) return opened.error();
        return Error{ErrorKind::NoRig,
                     "rig " + *selection_.serial + " is not there; refused is " + others +
                         ": plug " + *selection_.serial +
                         " in, or restart goniod for another: --rig usb:SERIAL"};
    }
    transport_ = std::move(*opened);
    selection_.serial = transport_->strings().serial;
    return transport_.get();
}

}  // namespace gonio::daemon
