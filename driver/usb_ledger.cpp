#include "driver/usb_ledger.h"

namespace gonio::driver {

UsbLedger& usbLedger() {
    static UsbLedger ledger;
    return ledger;
}

}  // namespace gonio::driver
