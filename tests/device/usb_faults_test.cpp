// The real USB code when the rig, the cable or the system does what it should not.

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "driver/usb_ledger.h"
#include "driver/usb_wake.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/device/without_rights.h"
#include "tests/support/wait_until.h"

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;
using driver::Rig;
using driver::Transport;

constexpr auto kDeadline = 1500ms;  // one second, and what a busy machine adds

/// How long `call` takes.
template <class Call>
std::chrono::milliseconds timed(Call call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() -
                                                                 begin);
}

class UsbFaults : public UsbRigTest {
protected:
    void SetUp() override {
        mock.live().warmUp(kSmallWindow);
        transport = opened();
        ASSERT_TRUE(transport);
        auto claimed = Rig::open(*transport, kSession);
        ASSERT_TRUE(claimed) << claimed.error().message;
        rig.emplace(std::move(*claimed));
        ASSERT_TRUE(rig->configure(kSmallWindow));
    }
    /// The frames of a rig that nothing disturbs.
    std::vector<Frame> undisturbed(const driver::CaptureRequest& request) {
        sim::InProcessDoor door(rigConfig());
        door.device().place(mattGrey());
        auto twin = Rig::open(door, kSession);
        EXPECT_TRUE(twin);
        EXPECT_TRUE(twin->configure(kSmallWindow));
        auto capture = twin->capture(request);
        EXPECT_TRUE(capture);
        return std::move(capture->frames);
    }
    /// Captures, with what was set wrong before, and compares.
    driver::Capture repaired(const driver::CaptureRequest& request) {
        auto capture = rig->capture(request);
        EXPECT_TRUE(capture) << capture.error().message;
        if (!capture) return {};
        const auto wanted = undisturbed(request);
        EXPECT_EQ(capture->size(), wanted.size());
        for (std::size_t i = 0; i < capture->size(); ++i)
            EXPECT_EQ((*capture)[i].pixels, wanted[i].pixels) << "frame " << i;
        return std::move(*capture);
    }

    std::unique_ptr<Transport> transport;
    std::optional<Rig> rig;  // after its transport: ends before it
};

TEST_F(UsbFaults, AStallCostsAChunkAndNoFrame) {
    mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::StallBulk); });
    repaired(litFrames(1, 3));
}

TEST_F(UsbFaults, TheThirdStallInTenSecondsIsAFailure) {
    for (std::uint64_t step = 1; step <= 2; ++step) {
        mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::StallBulk); });
        repaired(litFrames(step));
    }
    mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::StallBulk); });
    const auto capture = rig->capture(litFrames(3));
    ASSERT_FALSE(capture);
    EXPECT_EQ(capture.error().kind, ErrorKind::Device);
    EXPECT_NE(capture.error().message.find("three times"), std::string::npos)
        << capture.error().message;
}

TEST_F(UsbFaults, AShortTransferIsSentAgain) {
    mock.faults().shorten = 2;
    const auto capture = repaired(litFrames(1, 3));
    EXPECT_EQ(capture.anomalies.badLengths, 2U);
    EXPECT_GE(capture.resends, 1);
}

TEST_F(UsbFaults, AnOverlongTransferIsDroppedAndSentAgain) {
    repaired(litFrames(1));
    mock.faults().overflow = 1;
    const auto capture = repaired(litFrames(2, 3));
    EXPECT_EQ(capture.anomalies.lostChunks, 1U);
    EXPECT_GE(capture.resends, 1);
}

TEST_F(UsbFaults, AnErrorOfTheBusIsSurvivedWhileTheRigAnswers) {
    mock.faults().protocolErrors = 1;
    repaired(litFrames(1, 3));
}

TEST_F(UsbFaults, WithTheNextCaptureArmedFaultsChangeNoFrame) {
    for (std::uint64_t step = 1; step <= 12; ++step) {
        if (step % 4 == 1) mock.faults().shorten = 1;
        if (step % 4 == 2) mock.faults().overflow = 1;
        if (step == 7)
            mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::StallBulk); });
        const auto capture = rig->capture(litFrames(step, 2), {litFrames(step + 1, 2)});
        ASSERT_TRUE(capture) << capture.error().message;
        const auto wanted = undisturbed(litFrames(step, 2));
        ASSERT_EQ(capture->size(), wanted.size());
        for (std::size_t i = 0; i < capture->size(); ++i) {
            EXPECT_EQ((*capture)[i].captureId >> 16, step);
            EXPECT_EQ((*capture)[i].pixels, wanted[i].pixels) << "step " << step;
        }
    }
    EXPECT_GE(rig->anomalies().badLengths, 3U);
    EXPECT_GE(rig->anomalies().lostChunks, 3U);
}

TEST_F(UsbFaults, WaitingForNothingEndsAtItsDeadline) {
    const auto took = timed([&] {
        const auto chunk = transport->readBulk(150ms);
        ASSERT_TRUE(chunk);
        EXPECT_FALSE(*chunk);
    });
    EXPECT_GE(took, 150ms);
    EXPECT_LT(took, 400ms);
}

TEST_F(UsbFaults, ASilentRigMakesEveryCallEndByItsDeadline) {
    mock.faults().hung = true;
    EXPECT_LT(timed([&] { EXPECT_TRUE(transport->readInput(100ms)); }), 400ms);
    EXPECT_LT(timed([&] { EXPECT_TRUE(transport->readBulk(100ms)); }), 400ms);
    EXPECT_LT(timed([&] {
                  const auto report = transport->getFeature(1);
                  ASSERT_FALSE(report);
                  EXPECT_EQ(report.error().kind, ErrorKind::Device);
              }),
              kDeadline);
    EXPECT_LT(timed([&] { EXPECT_FALSE(transport->setFeature({2})); }), 100ms);
    EXPECT_LT(timed([&] { EXPECT_FALSE(transport->write({0x20})); }), 100ms);
    rig.reset();
    EXPECT_LT(timed([&] { transport.reset(); }), kDeadline);
}

TEST_F(UsbRigTest, ClosingEndsInASecondWhenTheRigHangs) {
    auto transport = opened();
    ASSERT_TRUE(transport);
    mock.faults().hung = true;
    EXPECT_LT(timed([&] { transport.reset(); }), kDeadline);
}

TEST_F(UsbFaults, UnpluggingIsADeviceErrorAtOnce) {
    std::jthread puller([&] {
        std::this_thread::sleep_for(300ms);
        mock.unplug();
    });
    std::optional<Error> error;
    const auto took = timed([&] {
        for (std::uint64_t step = 1; !error && step < 200; ++step) {
            const auto capture = rig->capture(litFrames(step));
            if (!capture) error = capture.error();
        }
    });
    puller.join();
    ASSERT_TRUE(error);
    EXPECT_EQ(error->kind, ErrorKind::Device);
    EXPECT_LT(took, 300ms + kDeadline);
    rig.reset();
    EXPECT_LT(timed([&] { transport.reset(); }), kDeadline);
    const auto gone = driver::openUsb();
    ASSERT_FALSE(gone);
    EXPECT_EQ(gone.error().kind, ErrorKind::NoRig);
}

TEST_F(UsbFaults, ThePortOfARigThatWasUnpluggedIsNotResetThoughItsTransfersSayNothingYet) {
    mock.unplug([&] {
        const auto reset = transport->resetPort();
        ASSERT_FALSE(reset);
        EXPECT_EQ(reset.error().kind, ErrorKind::Device);
        EXPECT_NE(reset.error().message.find("it is gone"), std::string::npos)
            << reset.error().message;
    });
    EXPECT_EQ(mock.faults().portResets, 0);
}

TEST_F(UsbFaults, ARigThatHangsBehindAnErrorIsSaidNotToAnswer) {
    mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::Hang); });
    mock.sendInstead({{.answer = sim::UsbAnswer::Error, .data = {}}});
    const auto chunk = transport->readBulk(5s);
    ASSERT_FALSE(chunk);
    EXPECT_EQ(chunk.error().kind, ErrorKind::Device);
    EXPECT_NE(chunk.error().message.find("SIM-0042 does not answer"), std::string::npos)
        << chunk.error().message;
}

TEST_F(UsbFaults, PluggedInAgainItMeasuresTheSame) {
    repaired(litFrames(1, 2));
    const auto boot = rig->identify().ident.bootId;
    mock.unplug();
    EXPECT_FALSE(rig->capture(litFrames(2)));
    rig.reset();
    transport.reset();
    mock.plug();
    transport = opened();
    ASSERT_TRUE(transport);
    auto again = Rig::open(*transport, kSession);
    ASSERT_TRUE(again) << again.error().message;
    rig.emplace(std::move(*again));
    EXPECT_EQ(rig->identify().ident.bootId, boot);
    ASSERT_TRUE(rig->configure(kSmallWindow));
    repaired(litFrames(2, 2));
}

TEST_F(UsbRigTest, AFullSystemHalvesTheRingAndStillMeasures) {
    mock.live().warmUp(kSmallWindow);
    mock.faults().mostTransfers = 2;
    testing::internal::CaptureStderr();
    const auto transport = opened();
    ASSERT_TRUE(transport);
    auto rig = Rig::open(*transport, kSession);
    ASSERT_TRUE(rig) << rig.error().message;
    ASSERT_TRUE(rig->configure(kSmallWindow));
    const auto capture = rig->capture(litFrames(1, 4));
    const std::string log = testing::internal::GetCapturedStderr();
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(capture->anomalies, driver::Anomalies{});
    EXPECT_NE(log.find("usbfs_memory_mb"), std::string::npos) << log;
}

TEST_F(UsbRigTest, WithoutMemoryForAnyTransferItSaysHowToGetSome) {
    mock.faults().mostTransfers = 0;
    const auto transport = driver::openUsb();
    ASSERT_FALSE(transport);
    EXPECT_EQ(transport.error().kind, ErrorKind::Device);
    EXPECT_NE(transport.error().message.find("usbfs_memory_mb"), std::string::npos);
}

TEST_F(UsbRigTest, ARigThatAnotherProgramHasIsBusy) {
    mock.faults().claimed = true;
    const auto transport = driver::openUsb();
    ASSERT_FALSE(transport);
    EXPECT_EQ(transport.error().kind, ErrorKind::Busy);
    EXPECT_NE(transport.error().message.find("another program"), std::string::npos);
}

TEST_F(UsbRigTest, WithoutPermissionItNamesTheUdevRule) {
    ASSERT_EQ(chmod(bus.real("").c_str(), 0777), 0);
    // umockdev's own socket must stay within reach, whatever becomes of the node.
    ASSERT_EQ(chmod(bus.real("/ioctl" + mock.usbNode()).c_str(), 0777), 0);
    ASSERT_EQ(chmod(bus.real(mock.usbNode()).c_str(), 0), 0);
    const WithoutRights unprivileged;
    const auto transport = driver::openUsb();
    ASSERT_FALSE(transport);
    EXPECT_EQ(transport.error().kind, ErrorKind::Busy);
    EXPECT_NE(transport.error().message.find("ATTRS{idVendor}==\"1209\""), std::string::npos)
        << transport.error().message;
    const auto rigs = driver::listUsb();
    ASSERT_TRUE(rigs);
    ASSERT_EQ(rigs->size(), 1U);
    EXPECT_EQ(rigs->front().serial, "SIM-0042");
    EXPECT_NE(rigs->front().obstacle.find("udev"), std::string::npos);
}

TEST_F(UsbRigTest, OfTwoRigsTheSerialNumberSaysWhich) {
    MockRig other(bus, rigConfig("SIM-0043"), 2);
    const auto unsure = driver::openUsb();
    ASSERT_FALSE(unsure);
    EXPECT_EQ(unsure.error().kind, ErrorKind::Usage);
    EXPECT_NE(unsure.error().message.find("SIM-0043"), std::string::npos);
    const auto sure = driver::openUsb({.serial = "SIM-0043"});
    ASSERT_TRUE(sure) << sure.error().message;
    EXPECT_EQ((*sure)->strings().serial, "SIM-0043");
    EXPECT_TRUE(Rig::open(**sure, kSession));
    const auto third = driver::openUsb({.serial = "SIM-0044"});
    ASSERT_FALSE(third);
    EXPECT_EQ(third.error().kind, ErrorKind::NoRig);
}

TEST_F(UsbRigTest, ARigThatIsSilentWhenItIsOpenedGetsItsPortReset) {
    mock.live().with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::HangUntilReset); });
    const auto silent = driver::openUsb();
    ASSERT_FALSE(silent);
    EXPECT_EQ(silent.error().kind, ErrorKind::Device);
    EXPECT_NE(silent.error().message.find("its port was reset"), std::string::npos)
        << silent.error().message;
    const auto awake = driver::openUsb();
    EXPECT_TRUE(awake) << awake.error().message;
}

TEST_F(UsbRigTest, ASilentRigThatAnotherProgramHasIsBusy) {
    mock.faults().hung = mock.faults().claimed = true;
    for (int i = 0; i < 2; ++i) {
        const auto transport = driver::openUsb();
        ASSERT_FALSE(transport);
        EXPECT_EQ(transport.error().kind, ErrorKind::Busy) << transport.error().message;
        EXPECT_NE(transport.error().message.find("another program"), std::string::npos);
    }
    EXPECT_EQ(mock.faults().portResets, 0);
}

/// Threads of this process by this name.
int threadsNamed(const std::string& name) {
    int count = 0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::string its;
        std::getline(std::ifstream(task.path() / "comm") >> std::ws, its);
        count += its == name ? 1 : 0;
    }
    return count;
}

TEST_F(UsbRigTest, OpeningEndsInTimeWhileAKernelResetsItsPort) {
    mock.faults().hung = true;
    mock.resetsFor(60s);
    const int leftBefore = driver::usbLedger().quarantinedThreads;
    const auto refused = [](const char* why) {
        const auto transport = driver::openUsb();
        ASSERT_FALSE(transport);
        EXPECT_EQ(transport.error().kind, ErrorKind::Device);
        EXPECT_NE(transport.error().message.find(why), std::string::npos)
            << transport.error().message;
    };
    EXPECT_LT(timed([&] { refused("its port cannot be reset"); }), 3 * kDeadline) << "2.2 s";
    EXPECT_EQ(driver::usbLedger().quarantinedThreads, leftBefore + 1);
    EXPECT_LT(timed([&] { refused("at 1-1 is still being reset"); }), kDeadline);
    EXPECT_LT(timed([&] { EXPECT_FALSE(driver::listUsb()); }), kDeadline);
    mock.faults().hung = false;
    EXPECT_TRUE(test::waitUntil([] { return threadsNamed(driver::kWakeThread) == 0; }));
    EXPECT_TRUE(opened());
    EXPECT_EQ(mock.faults().portResets, 1);
}

/// Whose chunks are larger than the buffers that any rig gets.
TEST_F(UsbRigTest, FillsTheBuffersItAskedForThoughItsFirstIdentWasDamaged) {
    mock.live().warmUp(kSmallWindow);
    mock.spoilFeatures(1);
    const auto transport = opened();
    ASSERT_TRUE(transport);
    auto rig = Rig::open(*transport, kSession);
    ASSERT_TRUE(rig) << rig.error().message;
    ASSERT_TRUE(rig->configure(kSmallWindow));
    const auto capture = rig->capture(litFrames(1, 3));
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(capture->anomalies, driver::Anomalies{});
}

}  // namespace
}  // namespace gonio::device_test
