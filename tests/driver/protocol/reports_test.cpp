#include "driver/protocol/reports.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/hex.h"

namespace gonio::driver {
namespace {

/// A report from the page's notation: leading bytes, zeros, a late field, and the CRC.
Report golden(const std::string& head,
              const std::string& crc,
              std::size_t at = 0,
              const std::string& late = "") {
    Report report{};
    const auto first = test::hex(head);
    std::copy(first.begin(), first.end(), report.begin());
    const auto more = test::hex(late);
    std::copy(more.begin(), more.end(), report.begin() + static_cast<std::ptrdiff_t>(at));
    const auto tail = test::hex(crc);
    std::copy(tail.begin(), tail.end(), report.begin() + 62);
    return report;
}

TEST(Golden, SessionSet) {
    const Report bytes = golden("02 88 77 66 55 44 33 22 11 D0 07 00 00", "66 2C");
    const SessionSet set{
        .sessionId = 0x1122334455667788, .heartbeatMs = 2000, .hostMinor = 0, .release = false};
    EXPECT_EQ(encode(set), bytes);
    const auto back = decodeSessionSet(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, set);
}

TEST(Golden, CommandSetLed) {
    const Report bytes = golden("20 88 77 66 55 01 00 02 00 02 FF FF 00 00 00 00", "5F 5C");
    const Command command{.sessionLow = 0x55667788,
                          .sequence = 1,
                          .op = Op::SetLed,
                          .arguments = encode(SetLed{.led = 2, .levels = {65535, 0, 0}})};
    EXPECT_EQ(encode(command), bytes);
    const auto back = decodeCommand(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, command);
    EXPECT_EQ(decodeSetLed(back->arguments).led, 2);
}

TEST(Golden, AckOfIt) {
    const Report bytes = golden("21 01 00 02 00 00 00 00 07 00", "5F F4", 52, "88 77 66 55");
    const Ack ack{.sequence = 1,
                  .op = Op::SetLed,
                  .status = 0,
                  .retryMs = 0,
                  .result = encodeU32(7),
                  .sessionLow = 0x55667788};
    EXPECT_EQ(encode(ack), bytes);
    const auto back = decodeAck(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, ack);
    EXPECT_EQ(decodeU32(back->result), 7U);
}

TEST(Golden, Event) {
    const Report bytes =
        golden("11 05 00 00 00 87 D6 12 00 00 00 00 00 02 00 01 00 00 00 07 00 00 00", "B2 03");
    const Event event{.sequence = 5, .timeUs = 1234567, .code = 2, .arg0 = 1, .arg1 = 7};
    EXPECT_EQ(encode(event), bytes);
    const auto back = decodeEvent(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, event);
}

/// Fills a struct's bytes so that every field differs, via its own decoder, and encodes it again.
template <class T, class Decode>
void expectRoundTrip(ReportId id, const T& seed, Decode decode) {
    const Report bytes = encode(seed);
    EXPECT_EQ(bytes[0], static_cast<std::uint8_t>(id));
    EXPECT_TRUE(crcAgrees(bytes));
    const auto back = decode(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, seed);
    for (std::size_t bit = 0; bit < 8 * kReportBytes; ++bit) {
        Report flipped = bytes;
        flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << (bit % 8)));
        EXPECT_FALSE(decode(flipped)) << "bit " << bit;
    }
}

TEST(Reports, RoundTripAndRejectEveryFlippedBit) {
    Ident ident{.major = 1,
                .minor = 2,
                .hardwareRevision = 3,
                .firmware = 0x10203,
                .capabilities = 7,
                .bootId = 0xB0071D01,
                .sensorWidth = 1280,
                .sensorHeight = 1024,
                .bitDepth = 12,
                .ledCount = 4,
                .ledAngle = {0, 2000, 4000, 6000, -1, 9100, 0, 0},
                .wavelengthNm = {630, 525, 465},
                .maxChunkPayload = 262144,
                .frameRam = 4,
                .exposureMinUs = 20,
                .exposureMaxUs = 1000000,
                .exposureStep = 548,
                .controlLatency = 2,
                .ledSettleMs = 5};
    expectRoundTrip(ReportId::Ident, ident, decodeIdent);
    expectRoundTrip(ReportId::Session,
                    SessionState{.sessionId = 0x0102030405060708,
                                 .heartbeatMs = 500,
                                 .hostMinor = 1,
                                 .statusOfLastSet = 106,
                                 .lastCommand = 65535,
                                 .owner = Owner::Lapsed},
                    decodeSessionState);
    expectRoundTrip(ReportId::Stats, Stats{1, 2, 3, 4, 5, 6, 7, 8, 9}, decodeStats);
    expectRoundTrip(ReportId::Limits,
                    Limits{.formats = 3,
                           .binnings = 7,
                           .roiStep = 8,
                           .maxFrames = 64,
                           .framePeriodUs = 40000,
                           .gainMax = 2400,
                           .blackLevel = 60,
                           .fullScale = 4095,
                           .ledFull = {3500, 3501, 3502},
                           .ledWhite = {1, 2, 3},
                           .ledTolerance = 100,
                           .ledTemperature = {-500, 8000},
                           .sensorTemperature = {-1, 1}},
                    decodeLimits);
    expectRoundTrip(ReportId::Status,
                    Status{.sequence = 9,
                           .bootId = 8,
                           .timeUs = 7,
                           .state = RigState::Exposing,
                           .interlock = 3,
                           .ledOn = 0x800,
                           .ledCurrent = {1, 2, 3},
                           .temperature = {2600, -32768, 2, 1},
                           .lastCommand = 5,
                           .captureId = 0x1122334455667788,
                           .framesMade = 3,
                           .fifoFrames = 2,
                           .newestEvent = 4,
                           .fault = 201,
                           .owner = Owner::Alive},
                    decodeStatus);
    const Event event{.sequence = 6, .timeUs = 5, .code = 4, .arg0 = 3, .arg1 = 2};
    expectRoundTrip(ReportId::Events,
                    EventsPage{.oldest = 1, .newest = 6, .events = {event, event}},
                    decodeEventsPage);
    expectRoundTrip(
        ReportId::Events, EventsPage{.oldest = 1, .newest = 6, .events = {}}, decodeEventsPage);
}

TEST(Reports, ArgumentsRoundTrip) {
    const SetExposure exposure{.exposureUs = 1000, .gain = 600};
    EXPECT_EQ(decodeSetExposure(encode(exposure)), exposure);
    const Granted granted{.exposureNs = 1004260, .gain = 600, .effectiveFrame = 9};
    EXPECT_EQ(decodeGranted(encode(granted)), granted);
    const SetFormat format{.format = PixelFormat::Mono16,
                           .x = 128,
                           .y = 8,
                           .width = 1024,
                           .height = 1000,
                           .binning = 2};
    EXPECT_EQ(decodeSetFormat(encode(format)), format);
    const Arm arm{.captureId = 0x10001, .frames = 16, .trigger = 1};
    EXPECT_EQ(decodeArm(encode(arm)), arm);
    const Resend resend{.captureId = 0x10001, .frame = 1, .firstChunk = 2, .lastChunk = 65535};
    EXPECT_EQ(decodeResend(encode(resend)), resend);
    EXPECT_EQ(decodeU64(encodeU64(0x1122334455667788)), 0x1122334455667788U);
}

TEST(Reports, EventsSetCarriesItsStart) {
    const auto from = decodeEventsFrom(encodeEventsFrom(17));
    ASSERT_TRUE(from);
    EXPECT_EQ(*from, 17U);
}

TEST(Reports, LastAckHasTheLayoutOfAck) {
    const Ack ack{
        .sequence = 4, .op = Op::Arm, .status = 102, .retryMs = 50, .result = {}, .sessionLow = 3};
    const auto back = decodeAck(encode(ack, ReportId::LastAck), ReportId::LastAck);
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, ack);
    EXPECT_FALSE(decodeAck(encode(ack, ReportId::LastAck)));
}

TEST(Reports, StatusesHaveTheNamesOfThePage) {
    EXPECT_EQ(statusName(status::kFrameGone), "FRAME_GONE");
    EXPECT_EQ(statusName(12345), "status 12345");
}

TEST(Reports, OperationsHaveTheNamesOfThePage) {
    EXPECT_EQ(opName(Op::SetExposure), "SET_EXPOSURE");
    EXPECT_EQ(opName(static_cast<Op>(77)), "op 77");
}

TEST(Reports, CommandsAcksEventsAndClaimsRejectEveryFlippedBit) {
    Arguments arguments{};
    for (std::size_t i = 0; i < arguments.size(); ++i)
        arguments[i] = static_cast<std::uint8_t>(i + 1);
    expectRoundTrip(
        ReportId::Command,
        Command{.sessionLow = 7, .sequence = 65535, .op = Op::Reboot, .arguments = arguments},
        decodeCommand);
    expectRoundTrip(ReportId::Ack,
                    Ack{.sequence = 1,
                        .op = Op::Resend,
                        .status = 900,
                        .retryMs = 65535,
                        .result = arguments,
                        .sessionLow = 0xFFFFFFFF},
                    [](const Report& report) { return decodeAck(report); });
    expectRoundTrip(
        ReportId::Event,
        Event{.sequence = 0xFFFFFFFF, .timeUs = ~0ULL, .code = 14, .arg0 = 1, .arg1 = 2},
        decodeEvent);
    expectRoundTrip(
        ReportId::Session,
        SessionSet{.sessionId = ~0ULL, .heartbeatMs = 10000, .hostMinor = 255, .release = true},
        decodeSessionSet);
}

TEST(Reports, ADecoderNamesTheReportThatItRefuses) {
    const auto refused = decodeLimits(encode(Stats{}));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Device);
    EXPECT_FALSE(refused.error().message.empty());
    EXPECT_FALSE(crcAgrees(Report{}));  // all zeros is no report: CCITT-FALSE starts at FFFF
}

}  // namespace
}  // namespace gonio::driver
