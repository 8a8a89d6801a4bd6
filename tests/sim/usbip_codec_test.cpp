#include "sim/usbip_codec.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace gonio::sim::usbip {
namespace {

Bytes words(std::initializer_list<std::uint32_t> values) {
    Bytes bytes;
    for (const std::uint32_t value : values)
        for (int shift = 24; shift >= 0; shift -= 8)
            bytes.push_back(static_cast<std::uint8_t>(value >> shift & 0xFF));
    return bytes;
}

std::string shown(std::span<const std::uint8_t> bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += kDigits[byte >> 4];
        text += kDigits[byte & 15];
    }
    return text;
}

Bytes submitOf(bool in, std::uint32_t endpoint, std::uint32_t length, std::uint32_t packets = 0) {
    return words(
        {1, 7, 0x10002, in ? 1U : 0U, endpoint, 0x200, length, 0, packets, 0, 0x80060001, 0x1200});
}

TEST(UsbipCodec, ReadsTheTwoRequests) {
    const auto list = readRequest(words({0x01118005, 0}));
    ASSERT_TRUE(list && *list);
    EXPECT_EQ((*list)->request.kind, Request::Kind::List);
    EXPECT_EQ((*list)->bytes, 8U);
    Bytes import = words({0x01118003, 0});
    for (const char c : std::string("1-2")) import.push_back(static_cast<std::uint8_t>(c));
    import.resize(8 + kBusIdBytes);
    const auto wanted = readRequest(import);
    ASSERT_TRUE(wanted && *wanted);
    EXPECT_EQ((*wanted)->request.kind, Request::Kind::Import);
    EXPECT_EQ((*wanted)->request.busId, "1-2");
    EXPECT_EQ((*wanted)->bytes, import.size());
}

TEST(UsbipCodec, WaitsForTheRestOfWhatIsHalfThere) {
    const Bytes list = words({0x01118005, 0});
    for (std::size_t n = 0; n < list.size(); ++n) {
        const auto part = readRequest(std::span(list).first(n));
        ASSERT_TRUE(part);
        EXPECT_FALSE(*part) << n;
    }
    Bytes out = submitOf(false, 1, 64);
    out.resize(kCommandBytes + 63);
    const auto part = readCommand(out);
    ASSERT_TRUE(part);
    EXPECT_FALSE(*part);
    out.push_back(9);
    const auto whole = readCommand(out);
    ASSERT_TRUE(whole && *whole);
    EXPECT_EQ((*whole)->bytes, kCommandBytes + 64);
    EXPECT_EQ((*whole)->command.submit->data.size(), 64U);
    EXPECT_EQ((*whole)->command.submit->data.back(), 9);
}

TEST(UsbipCodec, ReadsASubmittedTransfer) {
    const auto read = readCommand(submitOf(true, 2, 16384, 0xFFFFFFFF));
    ASSERT_TRUE(read && *read);
    const Submit& submit = *(*read)->command.submit;
    EXPECT_EQ(submit.sequence, 7U);
    EXPECT_TRUE(submit.in);
    EXPECT_EQ(submit.endpoint, 2);
    EXPECT_EQ(submit.length, 16384U);
    EXPECT_FALSE(submit.shortNotOk);
    EXPECT_EQ(submit.setup[1], 6);
    EXPECT_EQ((*read)->bytes, kCommandBytes) << "what comes from the rig brings no data";
}

TEST(UsbipCodec, ReadsATransferTakenBack) {
    Bytes bytes = words({2, 8, 0x10002, 0, 0, 7});
    bytes.resize(kCommandBytes);
    const auto read = readCommand(bytes);
    ASSERT_TRUE(read && *read);
    EXPECT_EQ((*read)->command.unlink->sequence, 8U);
    EXPECT_EQ((*read)->command.unlink->victim, 7U);
}

TEST(UsbipCodec, RefusesWhatNoRigCouldAnswer) {
    EXPECT_FALSE(readRequest(words({0x01008005, 0}))) << "another version";
    EXPECT_FALSE(readRequest(words({0x01118009, 0}))) << "another request";
    EXPECT_FALSE(readCommand(submitOf(true, 2, kMostIn + 1)));
    EXPECT_FALSE(readCommand(submitOf(false, 1, kMostOut + 1)));
    EXPECT_FALSE(readCommand(submitOf(true, 2, 0xFFFFFFFF)));
    EXPECT_FALSE(readCommand(submitOf(true, 16, 8)));
    EXPECT_FALSE(readCommand(submitOf(true, 2, 8, 4))) << "isochronous";
    Bytes direction = submitOf(true, 2, 8);
    direction[15] = 2;
    EXPECT_FALSE(readCommand(direction));
    EXPECT_FALSE(readCommand(Bytes(kCommandBytes)));
}

TEST(UsbipCodec, TheListNamesEachRigAndItsInterfaces) {
    const Exported rig{
        .busId = "1-1",
        .number = 1,
        .speed = Speed::Super,
        .vendor = 0x1209,
        .product = 1,
        .release = 0x100,
        .interfaces = {{.ofClass = 3}, {.ofClass = 0xFF, .subclass = 0x47, .protocol = 1}}};
    const Bytes reply = listReply(std::array{rig});
    ASSERT_EQ(reply.size(), 12U + 312 + 2 * 4);
    EXPECT_EQ(shown(std::span(reply).first(12)), "011100050000000000000001");
    EXPECT_EQ(shown(std::span(reply).subspan(12 + 256, 4)), "312d3100");
    EXPECT_EQ(shown(std::span(reply).subspan(12 + 288)),
              "00000001"
              "00000001"
              "00000005"
              "1209"
              "0001"
              "0100"
              "000000"
              "01"
              "01"
              "02"
              "03000000"
              "ff470100");
    EXPECT_EQ(importReply(ImportStatus::Ok, rig).size(), 8U + 312);
    EXPECT_EQ(shown(importReply(ImportStatus::Busy, rig)), "0111000300000002");
}

TEST(UsbipCodec, RepliesCarryStatusAndLength) {
    EXPECT_EQ(shown(submitReply({.sequence = 7, .status = -32, .actual = 0})),
              "00000003"
              "00000007"
              "000000000000000000000000"
              "ffffffe0"
              "00000000"
              "0000000000000000000000000000000000000000");
    EXPECT_EQ(shown(submitReply({.sequence = 7, .actual = 64})),
              "00000003"
              "00000007"
              "000000000000000000000000"
              "00000000"
              "00000040"
              "0000000000000000000000000000000000000000");
    EXPECT_EQ(shown(unlinkReply(8, -104)),
              "00000004"
              "00000008"
              "000000000000000000000000"
              "ffffff98"
              "00000000"
              "0000000000000000000000000000000000000000");
}

}  // namespace
}  // namespace gonio::sim::usbip
