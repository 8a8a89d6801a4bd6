// Rigs over TCP as a plain client sees them, and as a hostile one tries to hurt them.

#include "sim/usbip_server.h"

#include <gtest/gtest.h>

#include <netinet/tcp.h>

#include <filesystem>
#include <random>
#include <stop_token>
#include <thread>

#include "driver/protocol/chunk.h"
#include "sim/stream_socket.h"
#include "sim/usbip_line.h"
#include "tests/support/usbip_frame.h"
#include "tests/support/wait_until.h"

namespace gonio::sim {
namespace {

using test::UsbipClient;
using Bytes = UsbipClient::Bytes;
using namespace std::chrono_literals;

constexpr int kPipe = -32, kReset = -104, kOverflow = -75, kProtocol = -71;
constexpr std::uint32_t kBuffer = 257 * 1024;  // whole packets of either speed

/// Threads and open files of this process.
std::size_t countOf(const char* folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
    return count;
}

class UsbipServerTest : public testing::Test {
protected:
    UsbipServerTest() {
        auto opened = UsbipServer::open({&second, &first}, {.port = 0});
        EXPECT_TRUE(opened) << opened.error().message;
        server = std::move(*opened);
    }
    [[nodiscard]] int port() const { return server->port(); }

    LiveRig first{{.serial = "SIM-0001", .errors = {}}};
    LiveRig second{{.serial = "SIM-0002", .errors = {}, .camera = CameraKind::Usb3}};
    std::unique_ptr<UsbipServer> server;
};

TEST_F(UsbipServerTest, ListsRigsInTheOrderOfTheirSerialNumbers) {
    const UsbipClient client(port());
    client.list();
    const Bytes reply = client.receive(12 + 2 * 320);
    ASSERT_EQ(reply.size(), 12U + 2 * 320);
    EXPECT_EQ(UsbipClient::word(reply, 8), 2U);
    EXPECT_STREQ(reinterpret_cast<const char*>(&reply[12 + 256]), "1-1");
    EXPECT_EQ(UsbipClient::word(reply, 12 + 296), 3U) << "high speed";
    EXPECT_STREQ(reinterpret_cast<const char*>(&reply[12 + 320 + 256]), "1-2");
    EXPECT_EQ(UsbipClient::word(reply, 12 + 320 + 296), 5U) << "SuperSpeed";
    EXPECT_TRUE(client.ended());
}

TEST_F(UsbipServerTest, AnAttachedRigTellsItsDescriptors) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    const auto device = client.get(0x80, 6, 0x0100, 0, 18);
    ASSERT_EQ(device.data.size(), 18U);
    EXPECT_EQ(device.data[8] | device.data[9] << 8, 0x1209);
    const auto serial =
        client.get(0x80, 6, static_cast<std::uint16_t>(0x0300 | device.data[16]), 0x0409, 255);
    std::string text;
    for (std::size_t i = 2; i < serial.data.size(); i += 2)
        text += static_cast<char>(serial.data[i]);
    EXPECT_EQ(text, "SIM-0001");
    EXPECT_EQ(client.get(0x80, 6, 0x2200, 0, 77).status, kPipe) << "not of the device";
    EXPECT_EQ(client.get(0x81, 6, 0x2200, 0, 77).data.size(), 77U);
}

TEST_F(UsbipServerTest, AFrameComesChunkByChunk) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    test::beginDarkFrame(client, {16, 8});
    std::vector<driver::ChunkType> types;
    for (int i = 0; i < 3; ++i) {
        client.submit(true, 2, kBuffer);
        const auto ended = client.next(true);
        ASSERT_EQ(ended.status, 0);
        const auto chunk = driver::decodeChunk(ended.data);
        ASSERT_TRUE(chunk);
        types.push_back(chunk->header.type);
        if (i == 1) {
            EXPECT_EQ(ended.data.size(), driver::kChunkHeaderBytes + 2 * 16 * 8);
        }
    }
    EXPECT_EQ(types,
              (std::vector{
                  driver::ChunkType::Leader, driver::ChunkType::Data, driver::ChunkType::Trailer}));
}

TEST_F(UsbipServerTest, ATransferWaitsUntilItIsTakenBack) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    const auto waiting = client.submit(true, 2, kBuffer);
    const auto taken = client.unlink(waiting);
    const auto answer = client.next(false);
    EXPECT_EQ(answer.command, 4U);
    EXPECT_EQ(answer.sequence, taken);
    EXPECT_EQ(answer.status, kReset);
    client.unlink(waiting);
    EXPECT_EQ(client.next(false).status, 0) << "there is nothing left to take back";
}

TEST_F(UsbipServerTest, AStallEndsATransferUntilTheHaltIsCleared) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    first.with([](FaultyUsb& usb) { usb.cause(FaultKind::StallBulk); });
    test::beginDarkFrame(client, {16, 8});
    client.submit(true, 2, kBuffer);
    EXPECT_EQ(client.next(true).status, kPipe);
    client.submit(false, 0, 0, UsbipClient::setup(0x02, 1, 0, 0x82, 0));
    EXPECT_EQ(client.next(false).status, 0);
    client.submit(true, 2, kBuffer);
    EXPECT_EQ(client.next(true).status, 0);
}

TEST_F(UsbipServerTest, ABufferThatEndsInsideAPacketOverflows) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    test::beginDarkFrame(client, {16, 8});
    client.submit(true, 2, 100);
    EXPECT_EQ(client.next(true).status, kOverflow);
}

TEST_F(UsbipServerTest, ReportsComeByThemselves) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    client.submit(true, 1, 64);
    const auto report = client.next(true);
    ASSERT_EQ(report.data.size(), 64U);
    EXPECT_EQ(report.data[0], 0x10) << "STATUS";
}

TEST_F(UsbipServerTest, ARigIsOnesUntilThatOneLeaves) {
    UsbipClient one(port());
    ASSERT_EQ(one.import("1-1"), 0U);
    EXPECT_EQ(UsbipClient(port()).import("1-1"), 2U) << "busy";
    EXPECT_EQ(UsbipClient(port()).import("1-3"), 4U) << "no such rig";
    EXPECT_EQ(UsbipClient(port()).import("1-2"), 0U) << "the other one is free";
    one.leave();
    EXPECT_TRUE(test::waitUntil([&] { return UsbipClient(port()).import("1-1") == 0U; }));
}

TEST_F(UsbipServerTest, AClientThatLeavesHasPulledTheCable) {
    {
        UsbipClient client(port());
        ASSERT_EQ(client.import("1-1"), 0U);
        test::beginDarkFrame(client, {16, 8});
    }
    EXPECT_TRUE(test::waitUntil([&] {
        return first.with([](FaultyUsb& usb) {
            constexpr std::uint8_t kSession = 2, kLapsed = 2;
            const auto report = usb.device().getFeature(kSession);
            return report && (*report)[16] == kLapsed;
        });
    }));
}

TEST_F(UsbipServerTest, APulledRigEndsTheConnectionAndIsNotListed) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    client.submit(true, 2, kBuffer);
    EXPECT_EQ(client.get(0x80, 6, 0x0100, 0, 18).status, 0) << "the transfer before is there";
    first.with([](FaultyUsb& usb) { usb.unplug(); });
    EXPECT_EQ(client.next(true).status, kProtocol);
    EXPECT_TRUE(client.ended());
    EXPECT_EQ(UsbipClient(port()).import("1-1"), 4U);
    EXPECT_EQ(server->rigs().size(), 1U);
    first.with([](FaultyUsb& usb) { usb.plug(); });
    EXPECT_TRUE(test::waitUntil([&] { return UsbipClient(port()).import("1-1") == 0U; }));
}

TEST_F(UsbipServerTest, GarbageEndsOnlyItsOwnConnection) {
    UsbipClient attached(port());
    ASSERT_EQ(attached.import("1-2"), 0U);
    std::mt19937 random(20260);
    for (int i = 0; i < 20; ++i) {
        const UsbipClient hostile(port());
        Bytes bytes(64);
        for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() & 0xFF);
        hostile.send(bytes);
        EXPECT_TRUE(hostile.ended());
    }
    UsbipClient huge(port());
    ASSERT_EQ(huge.import("1-1"), 0U);
    huge.submit(false, 1, 0xFFFFFFFF);
    EXPECT_TRUE(huge.ended());
    ASSERT_TRUE(test::waitUntil([&] { return UsbipClient(port()).import("1-1") == 0U; }));
    EXPECT_EQ(attached.get(0x80, 6, 0x0100, 0, 18).data.size(), 18U);
}

TEST_F(UsbipServerTest, TransfersWithoutEndAreNotKept) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    for (int i = 0; i < 1100; ++i) client.submit(true, 2, kBuffer);
    EXPECT_TRUE(client.ended());
}

TEST_F(UsbipServerTest, ManyWhoSayNothingKeepNobodyOut) {
    std::vector<std::unique_ptr<UsbipClient>> silent;
    for (int i = 0; i < 64; ++i) silent.push_back(std::make_unique<UsbipClient>(port()));
    silent.front()->send({0x01, 0x11, 0x80});  // a half request
    // They are dropped in time.
    EXPECT_TRUE(test::waitUntil([&] { return UsbipClient(port()).import("1-1") == 0U; }));
}

TEST_F(UsbipServerTest, EndedItLeavesNeitherThreadNorFile) {
    const std::size_t threads = countOf("/proc/self/task"), files = countOf("/proc/self/fd");
    for (int i = 0; i < 20; ++i) {
        auto other = UsbipServer::open({&first}, {.port = 0});
        ASSERT_TRUE(other);
        UsbipClient client((*other)->port());
        ASSERT_EQ(client.import("1-1"), 0U);
        client.submit(true, 2, kBuffer);
        const UsbipClient half((*other)->port());
        half.send({0x01});
    }
    EXPECT_EQ(countOf("/proc/self/task"), threads);
    EXPECT_EQ(countOf("/proc/self/fd"), files);
}

TEST_F(UsbipServerTest, SaysWhyItCannotServeThere) {
    const auto kindOf = [&](const UsbipAddress& address, const std::string& word) {
        const auto other = UsbipServer::open({&first}, address);
        EXPECT_FALSE(other);
        if (other) return ErrorKind::Internal;
        EXPECT_NE(other.error().message.find(word), std::string::npos) << other.error().message;
        return other.error().kind;
    };
    EXPECT_EQ(kindOf({.port = port()}, "--port"), ErrorKind::Busy);
    EXPECT_EQ(kindOf({.port = 70000}, "65535"), ErrorKind::Usage);
    EXPECT_EQ(kindOf({.host = "localhost"}, "--bind"), ErrorKind::Usage);
    EXPECT_EQ(kindOf({.host = "192.0.2.1"}, "--bind"), ErrorKind::Usage);
}

TEST_F(UsbipServerTest, ReportsTakenBackAndAskedForAgainAreOpenedAnew) {
    constexpr int kMore = 20;  // than were told before
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    first.with([](FaultyUsb& usb) { usb.cause(FaultKind::SilenceReports); });
    std::vector<std::uint32_t> waiting;
    for (int i = 0; i < kMore; ++i) waiting.push_back(client.submit(true, 1, 64));
    for (const auto one : waiting) client.unlink(one);
    for (int back = 0; back < kMore;) back += client.next(true).command == 4U ? 1 : 0;
    client.submit(true, 1, 64);
    EXPECT_EQ(client.next(true).data.size(), 64U);
}

TEST_F(UsbipServerTest, AStallOfTheReportsLastsUntilTheirHaltIsCleared) {
    constexpr int kMore = 20;
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    first.with([](FaultyUsb& usb) { usb.cause(FaultKind::StallReports); });
    int status = 0;
    for (int i = 0; i < kMore && status == 0; ++i) {
        client.submit(true, 1, 64);
        status = client.next(true).status;
    }
    EXPECT_EQ(status, kPipe);
    client.submit(false, 0, 0, UsbipClient::setup(0x02, 1, 0, 0x81, 0));
    EXPECT_EQ(client.next(false).status, 0);
    for (int i = 0; i < kMore && status != 0; ++i) {  // a stall of before may still be told
        client.submit(true, 1, 64);
        status = client.next(true).status;
    }
    EXPECT_EQ(status, 0);
}

TEST_F(UsbipServerTest, ABusResetIsSeenByWhatLinuxAsksForAfterIt) {
    const auto lapsed = [](LiveRig& rig) {
        return rig.with([](FaultyUsb& usb) {
            constexpr std::uint8_t kSession = 2, kLapsed = 2;
            const auto report = usb.device().getFeature(kSession);
            return report && (*report)[16] == kLapsed;
        });
    };
    UsbipClient high(port()), super(port());
    ASSERT_EQ(high.import("1-1"), 0U);
    ASSERT_EQ(super.import("1-2"), 0U);
    test::beginDarkFrame(high, {16, 8});
    test::beginDarkFrame(super, {16, 8});
    EXPECT_EQ(high.get(0x80, 6, 0x0100, 0, 8).data.size(), 8U);
    EXPECT_FALSE(lapsed(first));
    EXPECT_EQ(super.get(0x80, 6, 0x0100, 0, 8).data.size(), 8U);
    EXPECT_TRUE(lapsed(second));
    EXPECT_EQ(high.get(0x80, 6, 0x0100, 0, 64).data.size(), 18U);
    EXPECT_TRUE(lapsed(first));
}

TEST_F(UsbipServerTest, ATransferToTheRigBringsNothingWhateverItsSetupSays) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    client.submit(false, 0, 0, UsbipClient::setup(0x80, 6, 0x0100, 0, 18));
    EXPECT_EQ(client.next(false).command, 3U);
    EXPECT_EQ(client.get(0x80, 6, 0x0100, 0, 18).data.size(), 18U);
}

TEST_F(UsbipServerTest, ResendsWithoutEndAreNotKept) {
    UsbipClient client(port());
    ASSERT_EQ(client.import("1-1"), 0U);
    test::beginDarkFrame(client, {16, 8});
    const auto stats = [&] {
        return first.with([](FaultyUsb& usb) { return usb.device().stats(); });
    };
    ASSERT_TRUE(test::waitUntil([&] { return stats().framesMade == 1U; }));
    for (std::uint16_t sequence = 3; sequence < 60; ++sequence) {
        const auto report = driver::encode(
            driver::Command{.sessionLow = 7,
                            .sequence = sequence,
                            .op = driver::Op::Resend,
                            .arguments = driver::encode(driver::Resend{.captureId = 1})});
        client.submit(false, 1, 64, {}, Bytes(report.begin(), report.end()));
        EXPECT_EQ(client.next(false).status, 0);
    }
    constexpr unsigned kChunks = 3;  // of the frame
    EXPECT_EQ(stats().resends, kChunks * kFrameRam);
}

TEST(UsbipLine, ACableThatWasPulledBeforeItWasLookedAtIsPulled) {
    LiveRig rig({.errors = {}});
    rig.with([](FaultyUsb& usb) {
        usb.unplug();
        usb.plug();
    });
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    StreamSocket ours(ends[0]);
    const StreamSocket theirs(ends[1]);
    constexpr int kPullsBefore = 0;
    EXPECT_TRUE(UsbipLine(rig, ours, {}, kPullsBefore).serve({}));
}

TEST(StreamSocket, WritingToOneWhoDoesNotReadEndsWhenItIsToStop) {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    StreamSocket ours(ends[0]);
    const StreamSocket theirs(ends[1]);
    std::stop_source stop;
    const std::jthread stopper([&] {
        std::this_thread::sleep_for(50ms);
        stop.request_stop();
    });
    EXPECT_FALSE(ours.write(Bytes(std::size_t{16} << 20), 1h, stop.get_token()));
}

TEST(StreamSocket, AnEndThatSaysNothingIsAskedWhetherItIsThere) {
    StreamSocket socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    socket.watchOtherEnd();
    const auto option = [&](int level, int name) {
        int value = 0;
        socklen_t length = sizeof value;
        EXPECT_EQ(getsockopt(socket.descriptor(), level, name, &value, &length), 0);
        return value;
    };
    EXPECT_EQ(option(SOL_SOCKET, SO_KEEPALIVE), 1);
    EXPECT_EQ(option(IPPROTO_TCP, TCP_KEEPIDLE), 5);
    EXPECT_EQ(option(IPPROTO_TCP, TCP_USER_TIMEOUT), 11000);
}

}  // namespace
}  // namespace gonio::sim
