#pragma once
// A frame asked of a rig over USB/IP: claimed, given its window, armed.

#include "driver/protocol/reports.h"
#include "proc/core/image.h"
#include "tests/support/usbip_client.h"

namespace gonio::test {

/// A dark frame of `size`, in two bytes a pixel, is on its way to `client`.
inline void beginDarkFrame(UsbipClient& client, Size size) {
    using Bytes = UsbipClient::Bytes;
    const auto claim = driver::encode(driver::SessionSet{.sessionId = 7, .heartbeatMs = 10000});
    client.submit(false,
                  0,
                  64,
                  UsbipClient::setup(0x21, 9, 0x0302, 0, 64),
                  Bytes(claim.begin(), claim.end()));
    EXPECT_EQ(client.next(false).status, 0);
    std::uint16_t sequence = 0;
    const auto command = [&](driver::Op op, const driver::Arguments& arguments) {
        const auto report = driver::encode(driver::Command{
            .sessionLow = 7, .sequence = ++sequence, .op = op, .arguments = arguments});
        client.submit(false, 1, 64, {}, Bytes(report.begin(), report.end()));
        EXPECT_EQ(client.next(false).status, 0);
    };
    command(driver::Op::SetFormat,
            driver::encode(driver::SetFormat{.format = driver::PixelFormat::Mono16,
                                             .width = static_cast<std::uint16_t>(size.width),
                                             .height = static_cast<std::uint16_t>(size.height),
                                             .binning = 1}));
    command(driver::Op::Arm, driver::encode(driver::Arm{.captureId = 1, .frames = 1}));
}

}  // namespace gonio::test
