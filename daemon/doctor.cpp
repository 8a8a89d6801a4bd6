#include "daemon/doctor.h"

namespace gonio::daemon {

std::string nameOf(const driver::UsbRig& rig) {
    return rig.serial.empty() ? rig.place : rig.serial;
}

bool usedByDaemon(const Patient& patient, const driver::UsbRig& rig) {
    return patient.daemon && patient.daemon->rigKind == "usb" &&
           patient.daemon->rigSerial == rig.serial;
}

}  // namespace gonio::daemon
