#include "sim/usb_device.h"

#include <gtest/gtest.h>

#include <string>

namespace gonio::sim {
namespace {

using driver::ReportId;

constexpr std::uint8_t kIn = 0x80, kToInterface = 0x01, kClassIn = 0xA1, kClassOut = 0x21;
constexpr std::uint8_t kGetDescriptor = 6, kSetConfiguration = 9, kSetInterface = 11;
constexpr std::uint8_t kGetReport = 1, kSetReport = 9, kClearFeature = 1, kToEndpoint = 0x02;
constexpr std::uint8_t kEndpoint = 5, kQualifier = 6, kBos = 0x0F, kCompanion = 0x30;
constexpr std::uint8_t kSetExitLatencies = 48;
constexpr std::size_t kPacket = cameraLink(CameraKind::Usb2).bulkPacket;
constexpr std::size_t kBuffer = (64 + 256 * 1024) / kPacket * kPacket + 2 * kPacket;

std::uint16_t pair(std::uint8_t high, std::uint8_t low) {
    return static_cast<std::uint16_t>(high << 8 | low);
}

std::string text(const std::vector<std::uint8_t>& string) {
    std::string result;
    for (std::size_t i = 2; i < string.size(); i += 2) result += static_cast<char>(string[i]);
    return result;
}

class UsbDeviceTest : public testing::Test {
protected:
    UsbReply get(std::uint8_t kind, std::uint8_t type, std::uint8_t index, std::uint16_t length) {
        return usb.control({.requestType = kind,
                            .request = kGetDescriptor,
                            .value = pair(type, index),
                            .length = length});
    }
    UsbReply report(bool set, std::uint8_t kind, const driver::Report& bytes) {
        const UsbSetup setup{.requestType = set ? kClassOut : kClassIn,
                             .request = set ? kSetReport : kGetReport,
                             .value = pair(kind, bytes[0]),
                             .length = driver::kReportBytes};
        return set ? usb.control(setup, bytes) : usb.control(setup);
    }
    void command(driver::Op op, const driver::Arguments& arguments = {}) {
        usb.interruptOut(driver::encode(driver::Command{
            .sessionLow = 7, .sequence = ++sequence, .op = op, .arguments = arguments}));
    }
    /// Claims, and takes one dark frame of 16 x 8 pixels.
    void takeFrame() {
        report(true, 3, driver::encode(driver::SessionSet{.sessionId = 7, .heartbeatMs = 2000}));
        command(
            driver::Op::SetFormat,
            driver::encode(driver::SetFormat{
                .format = driver::PixelFormat::Mono16, .width = 16, .height = 8, .binning = 1}));
        command(driver::Op::Arm, driver::encode(driver::Arm{.captureId = 1, .frames = 1}));
        usb.device().advanceTo(usb.device().now() + std::chrono::milliseconds(100));
    }

    UsbDevice usb{{.serial = "SIM-0042", .errors = {}}};
    std::uint16_t sequence = 0;
};

TEST_F(UsbDeviceTest, DescribesTwoInterfacesAndTheirEndpoints) {
    const auto device = get(kIn, 1, 0, 255);
    ASSERT_EQ(device.data.size(), 18U);
    EXPECT_EQ(device.data, usb.deviceDescriptor());
    const auto config = get(kIn, 2, 0, 255).data;
    ASSERT_EQ(config.size(), 9U + 9 + 9 + 7 + 7 + 9 + 7);
    EXPECT_EQ(pair(config[3], config[2]), config.size());
    EXPECT_EQ(config[4], 2);
    EXPECT_EQ(config[config.size() - 5], UsbDevice::kBulkIn);
}

TEST_F(UsbDeviceTest, AHighSpeedRigHasAQualifierAndNoBos) {
    EXPECT_EQ(pair(usb.deviceDescriptor()[3], usb.deviceDescriptor()[2]), 0x0200);
    EXPECT_EQ(get(kIn, kQualifier, 0, 255).data.size(), 10U);
    EXPECT_EQ(get(kIn, kBos, 0, 255).answer, UsbAnswer::Stall);
    EXPECT_EQ(usb.control({.request = kSetExitLatencies, .length = 6}).answer, UsbAnswer::Stall);
}

TEST(UsbDevice, ASuperSpeedRigDescribesItselfInTheFormsOfUsb3) {
    UsbDevice usb({.serial = "SIM-0042", .errors = {}, .camera = CameraKind::Usb3});
    const auto device = usb.deviceDescriptor();
    EXPECT_EQ(pair(device[3], device[2]), 0x0300);
    EXPECT_EQ(device[7], 9);  // 2^9 bytes
    const auto get = [&](std::uint8_t type) {
        return usb.control(
            {.requestType = kIn, .request = kGetDescriptor, .value = pair(type, 0), .length = 255});
    };
    EXPECT_EQ(get(kQualifier).answer, UsbAnswer::Stall);
    const auto bos = get(kBos).data;
    ASSERT_EQ(bos.size(), 5U + 7 + 10);
    EXPECT_EQ(pair(bos[3], bos[2]), bos.size());
    EXPECT_EQ(bos[4], 2);
    EXPECT_EQ(bos[5 + 2], 2);      // USB 2.0 extension
    EXPECT_EQ(bos[5 + 7 + 2], 3);  // SuperSpeed
    EXPECT_EQ(usb.control({.request = kSetExitLatencies, .length = 6}).answer, UsbAnswer::Done);
}

TEST(UsbDevice, EverySuperSpeedEndpointHasACompanion) {
    const UsbDevice usb({.serial = "SIM-0042", .errors = {}, .camera = CameraKind::Usb3});
    const auto config = usb.configDescriptor();
    ASSERT_EQ(pair(config[3], config[2]), config.size());
    std::size_t bulkPacket = 0;
    int endpoints = 0, companions = 0;
    for (std::size_t at = 0; at < config.size(); at += config[at]) {
        ASSERT_GT(config[at], 1) << at;  // every descriptor says how long it is
        ASSERT_LE(at + config[at], config.size());
        if (config[at + 1] == kEndpoint) {
            ++endpoints;
            const std::size_t behind = at + config[at];
            ASSERT_LT(behind + 5, config.size());
            EXPECT_EQ(config[behind + 1], kCompanion);
            if (config[at + 2] == UsbDevice::kBulkIn)
                bulkPacket = pair(config[at + 5], config[at + 4]);
        }
        companions += config[at + 1] == kCompanion ? 1 : 0;
    }
    EXPECT_EQ(endpoints, 3);
    EXPECT_EQ(companions, 3);
    EXPECT_EQ(bulkPacket, 1024U);
    EXPECT_EQ(usb.bulkPacket(), 1024U);
}

TEST_F(UsbDeviceTest, ADescriptorIsCutToWhatWasAskedFor) {
    EXPECT_EQ(get(kIn, 2, 0, 9).data.size(), 9U);
    EXPECT_EQ(get(kIn, 2, 1, 9).answer, UsbAnswer::Stall);  // there is one configuration
}

TEST_F(UsbDeviceTest, StringsNameTheSerialNumberAndTheProtocol) {
    EXPECT_EQ(text(get(kIn, 3, 3, 255).data), "SIM-0042");
    EXPECT_EQ(text(get(kIn, 3, 240, 255).data), "GRP/1.0");
    EXPECT_EQ(get(kIn, 3, 99, 255).answer, UsbAnswer::Stall);
}

TEST_F(UsbDeviceTest, ReportDescriptorHas77BytesThatEndACollection) {
    const auto reports = get(kIn | kToInterface, 0x22, 0, 255);
    ASSERT_EQ(reports.data.size(), 77U);
    EXPECT_EQ(reports.data.front(), 0x06);
    EXPECT_EQ(reports.data.back(), 0xC0);
}

TEST_F(UsbDeviceTest, FeatureReportsAreReadAndSetWith64Bytes) {
    const auto ident = report(false, 3, {static_cast<std::uint8_t>(ReportId::Ident)});
    ASSERT_EQ(ident.data.size(), driver::kReportBytes);
    EXPECT_EQ(ident.data[0], 1);
    EXPECT_EQ(report(true, 3, driver::encodeEventsFrom(1)).answer, UsbAnswer::Done);
    const auto bytes = driver::encodeEventsFrom(1);
    const UsbSetup set{.requestType = kClassOut, .request = kSetReport, .value = pair(3, 4)};
    EXPECT_EQ(usb.control(set, std::span(bytes).first(63)).answer, UsbAnswer::Stall);
}

TEST_F(UsbDeviceTest, OnlyStatusCanBeReadAsAnInputReport) {
    const auto id = [](ReportId i) { return driver::Report{static_cast<std::uint8_t>(i)}; };
    EXPECT_EQ(report(false, 1, id(ReportId::Status)).data[0], 0x10);
    EXPECT_EQ(report(false, 1, id(ReportId::Event)).answer, UsbAnswer::Stall);
    EXPECT_EQ(report(false, 3, id(ReportId::Status)).answer, UsbAnswer::Stall);
    EXPECT_EQ(report(false, 3, {0x7F}).answer, UsbAnswer::Stall);
}

TEST_F(UsbDeviceTest, ACommandIsTakenAsSetReportToo) {
    report(true, 3, driver::encode(driver::SessionSet{.sessionId = 7, .heartbeatMs = 2000}));
    const auto ping =
        driver::encode(driver::Command{.sessionLow = 7, .sequence = 1, .op = driver::Op::Ping});
    EXPECT_EQ(report(true, 2, ping).answer, UsbAnswer::Done);
    EXPECT_EQ(usb.device().stats().commandsDone, 1U);
}

TEST_F(UsbDeviceTest, WithNothingToSendItNaks) {
    EXPECT_EQ(usb.bulkIn(kBuffer).answer, UsbAnswer::Nak);
    while (usb.interruptIn().answer == UsbAnswer::Done) {
    }
    EXPECT_EQ(usb.interruptIn().answer, UsbAnswer::Nak);
}

TEST_F(UsbDeviceTest, OneTransferCarriesOneChunk) {
    takeFrame();
    EXPECT_EQ(usb.bulkIn(kBuffer).data.size(), 64U + 64);          // leader
    EXPECT_EQ(usb.bulkIn(kBuffer).data.size(), 64U + 2 * 16 * 8);  // pixels
    EXPECT_EQ(usb.bulkIn(kBuffer).data.size(), 64U + 64);          // trailer
    EXPECT_EQ(usb.bulkIn(kBuffer).answer, UsbAnswer::Nak);
}

TEST_F(UsbDeviceTest, AFullTransferIsFollowedByTheRestOfItsChunk) {
    takeFrame();
    EXPECT_EQ(usb.bulkIn(128).data.size(), 128U);  // the leader, and no short packet has ended it
    const auto end = usb.bulkIn(128);
    EXPECT_EQ(end.answer, UsbAnswer::Done);
    EXPECT_TRUE(end.data.empty());
    EXPECT_EQ(usb.bulkIn(256).data.size(), 256U);
    EXPECT_EQ(usb.bulkIn(256).data.size(), 64U);
}

TEST_F(UsbDeviceTest, AHaltLastsUntilItIsCleared) {
    takeFrame();
    EXPECT_EQ(usb.bulkIn(64).data.size(), 64U);  // half a leader
    usb.haltStream();
    EXPECT_EQ(usb.bulkIn(kBuffer).answer, UsbAnswer::Stall);
    EXPECT_EQ(usb.bulkIn(kBuffer).answer, UsbAnswer::Stall);
    usb.control(
        {.requestType = kToEndpoint, .request = kClearFeature, .index = UsbDevice::kBulkIn});
    EXPECT_EQ(usb.bulkIn(kBuffer).data.size(), 64U + 2 * 16 * 8);  // the next whole chunk
}

TEST_F(UsbDeviceTest, SetInterfaceFlushesTheStreamAndClearsAHalt) {
    takeFrame();
    usb.haltStream();
    const UsbSetup flush{.requestType = kToInterface, .request = kSetInterface, .index = 1};
    EXPECT_EQ(usb.control(flush).answer, UsbAnswer::Done);
    EXPECT_EQ(usb.bulkIn(kBuffer).answer, UsbAnswer::Nak);
}

TEST_F(UsbDeviceTest, SetConfigurationDarkensAndLapsesTheSession) {
    takeFrame();
    command(driver::Op::SetLed, driver::encode(driver::SetLed{.led = 1, .levels = {9, 0, 0}}));
    const auto status = [&] {
        return driver::decodeStatus(*usb.device().getFeature(0x10)).value();
    };
    ASSERT_NE(status().ledOn, 0U);
    EXPECT_EQ(usb.control({.request = kSetConfiguration, .value = 1}).answer, UsbAnswer::Done);
    EXPECT_EQ(status().ledOn, 0U);
    EXPECT_EQ(status().owner, driver::Owner::Lapsed);
    EXPECT_EQ(usb.bulkIn(kBuffer).answer, UsbAnswer::Nak);
    EXPECT_EQ(usb.device().stats().lapses, 1U);
}

}  // namespace
}  // namespace gonio::sim
