#include "driver/usb_ledger.h"

#include "proc/core/log.h"

namespace gonio::driver {

UsbLedger& usbLedger() {
    static UsbLedger ledger;
    return ledger;
}

void joinOrLeave(std::thread& thread, bool ended, const std::string& warning) {
    if (ended) {
        thread.join();
        return;
    }
    log::warning(warning);
    ++usbLedger().quarantinedThreads;
    thread.detach();
}

}  // namespace gonio::driver
