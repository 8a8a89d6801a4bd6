// Traffic of real devices of other kinds through the real USB code: whole, in order, behind what a
// bus does to any device, and taken back in its midst and at its end, where the recorded host
// cancelled it; and their descriptors, none of which are a rig's.

#include <umockdev.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <deque>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>

#include "driver/assembler.h"
#include "driver/hid_channel.h"
#include "driver/usb_find.h"
#include "driver/usb_ledger.h"
#include "driver/usb_stream.h"
#include "tests/device/foreign_traffic.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/support/data_file.h"
#include "tests/support/wait_until.h"

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kPayload = 64 * 1024;

std::size_t total(const ForeignTraffic& traffic) {
    return std::accumulate(
        traffic.bulkIn.begin(), traffic.bulkIn.end(), std::size_t{0}, [](std::size_t sum, auto& t) {
            return sum + t.bytes.size();
        });
}

class ForeignStream : public UsbRigTest {
protected:
    [[nodiscard]] std::shared_ptr<driver::UsbStream> stream() {
        auto context = driver::makeUsbContext();
        auto rigs = driver::findRigs(*context, {});
        if (!rigs || rigs->size() != 1) return nullptr;
        auto opened = driver::openRig(rigs->front());
        if (!opened || !driver::claimStream(*opened)) return nullptr;
        return std::make_shared<driver::UsbStream>(std::move(*opened));
    }

    /// What the recorded host did not take back, as a rig would send it.
    [[nodiscard]] static std::deque<sim::UsbReply> ended(const ForeignTraffic& traffic) {
        std::deque<sim::UsbReply> transfers;
        for (const ForeignTransfer& transfer : traffic.bulkIn) {
            if (transfer.status == -ENOENT) continue;
            EXPECT_EQ(transfer.status, 0);
            transfers.push_back({.answer = sim::UsbAnswer::Done, .data = transfer.bytes});
        }
        return transfers;
    }

    /// The transfers arrive as they were; then nothing does, and what is still in flight is taken
    /// back, as the recorded host did with its last ones.
    void expectWhole(const ForeignTraffic& traffic) {
        const auto wanted = ended(traffic);
        mock.sendInstead(wanted);
        const auto reading = stream();
        ASSERT_TRUE(reading);
        ASSERT_TRUE(reading->start(kPayload));
        driver::Assembler assembler;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const auto came = reading->read(10s);
            ASSERT_TRUE(came && *came) << "transfer " << i;
            EXPECT_TRUE(std::ranges::equal(**came, wanted[i].data)) << "transfer " << i;
            EXPECT_FALSE(assembler.feed(**came));
        }
        EXPECT_EQ(assembler.anomalies().total(), wanted.size()) << "none is a chunk";
        const auto more = reading->read(50ms);
        ASSERT_TRUE(more);
        EXPECT_FALSE(*more);
        const auto counters = reading->counters();
        EXPECT_EQ(counters.stalls + counters.overflows + counters.errors, 0);
        expectStopped(reading);
    }

    static void expectStopped(const std::shared_ptr<driver::UsbStream>& reading) {
        const auto begin = std::chrono::steady_clock::now();
        reading->askToStop();
        reading->awaitStop(begin + 5s);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s) << "all in flight came back";
        EXPECT_EQ(reading.use_count(), 1);
    }
};

TEST_F(ForeignStream, OfAFingerprintSensorIsWhole) {
    const auto file = test::dataFile("usb_traces/upektc_img.capture.pcapng");
    if (!file) return;
    const ForeignTraffic traffic = readForeign(*file);
    EXPECT_EQ(traffic.packets, 336);
    EXPECT_EQ(total(traffic), 56'230U);
    expectWhole(traffic);
}

TEST_F(ForeignStream, OfANextBiometricsSensorIsWhole) {
    const auto file = test::dataFile("usb_traces/nb1010.capture.ioctl");
    if (!file) return;
    const ForeignTraffic traffic = readForeign(*file);
    EXPECT_EQ(traffic.bulkIn.size(), 93U);
    expectWhole(traffic);
}

TEST_F(ForeignStream, OfAnElanSensorWithACancelledTransferIsWhole) {
    const auto file = test::dataFile("usb_traces/elan.capture.ioctl");
    if (!file) return;
    const ForeignTraffic traffic = readForeign(*file);
    EXPECT_EQ(traffic.bulkIn.size(), 37U);
    expectWhole(traffic);
}

TEST_F(ForeignStream, OfACameraIsWhole) {
    const auto file = test::dataFile("usb_traces/canon-powershot-sx200.ioctl");
    if (!file) return;
    const ForeignTraffic traffic = readForeign(*file);
    EXPECT_EQ(traffic.bulkIn.size(), 430U);
    expectWhole(traffic);
}

/// Not in the recording: what a bus does to any device.
TEST_F(ForeignStream, GoesOnBehindAStallAnOverflowAndAnError) {
    const auto file = test::dataFile("usb_traces/nb1010.capture.ioctl");
    if (!file) return;
    const auto wanted = ended(readForeign(*file));
    ASSERT_GT(wanted.size(), 80U);
    auto sent = wanted;
    using enum sim::UsbAnswer;
    for (const auto& [before, answer] : {std::pair(80, Error), {50, Overflow}, {20, Stall}})
        sent.insert(sent.begin() + before, {.answer = answer, .data = {}});
    mock.sendInstead(std::move(sent));
    const auto reading = stream();
    ASSERT_TRUE(reading);
    ASSERT_TRUE(reading->start(kPayload));
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto came = reading->read(10s);
        ASSERT_TRUE(came && *came) << "transfer " << i;
        EXPECT_TRUE(std::ranges::equal(**came, wanted[i].data)) << "transfer " << i;
    }
    // What came with the error may be read before the error is counted.
    EXPECT_TRUE(test::waitUntil([&] { return reading->counters().errors == 1; }));
    EXPECT_EQ(reading->counters().stalls, 1);
    EXPECT_EQ(reading->counters().overflows, 1);
    EXPECT_FALSE(reading->failure());
    expectStopped(reading);
}

/// Each stream is stopped while the device goes on sending: what is in flight is taken back, what
/// has come is still read, and the next stream begins with what was not sent yet.
TEST_F(ForeignStream, TakenBackInItsMidstLosesAndDoublesNothing) {
    const auto file = test::dataFile("usb_traces/canon-powershot-sx200.ioctl");
    if (!file) return;
    const auto wanted = ended(readForeign(*file));
    mock.sendInstead(wanted);
    constexpr std::size_t kStreams = 8;
    std::size_t next = 0;
    const auto take = [&](driver::UsbStream& reading, Nanoseconds wait) {
        const auto came = reading.read(wait);
        if (!came || !*came) return false;
        if (next == wanted.size()) {
            ADD_FAILURE() << "more than was sent";
            return false;
        }
        EXPECT_TRUE(std::ranges::equal(**came, wanted[next].data)) << "transfer " << next;
        ++next;
        return true;
    };
    for (std::size_t i = 1; i <= kStreams; ++i) {
        const auto reading = stream();
        ASSERT_TRUE(reading);
        ASSERT_TRUE(reading->start(kPayload));
        while (next < i * wanted.size() / kStreams) ASSERT_TRUE(take(*reading, 10s)) << next;
        expectStopped(reading);
        while (take(*reading, 0s)) continue;
        EXPECT_EQ(driver::usbLedger().transfersInFlight, 0);
    }
    EXPECT_EQ(next, wanted.size());
}

/// Vendor and product by the PRODUCT=V/P/R lines of a umockdev description.
std::vector<driver::UsbSelection> idsIn(const std::string& description) {
    std::vector<driver::UsbSelection> ids;
    const std::regex line("PRODUCT=([0-9a-f]+)/([0-9a-f]+)/");
    for (auto at = std::sregex_iterator(description.begin(), description.end(), line);
         at != std::sregex_iterator();
         ++at) {
        const auto number = [&](std::size_t group) {
            return static_cast<std::uint16_t>(std::stoul((*at)[group].str(), nullptr, 16));
        };
        ids.push_back({.vendor = number(1), .product = number(2)});
    }
    return ids;
}

TEST(ForeignDevice, IsNotTakenForARig) {
    int devices = 0;
    for (const char* name : {"upektc_img.device",
                             "nb1010.device",
                             "elan.device",
                             "canon-powershot-sx200.umockdev",
                             "fido2.umockdev"}) {
        const auto file = test::dataFile(std::string("usb_traces/") + name);
        if (!file) return;
        const MockBus bus;
        std::ifstream in(*file);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        ASSERT_TRUE(umockdev_testbed_add_from_string(bus.testbed(), text.c_str(), nullptr)) << name;
        for (const driver::UsbSelection& ids : idsIn(text)) {
            const auto rigs = driver::listUsb(ids);
            ASSERT_TRUE(rigs) << rigs.error().message;
            for (const auto& rig : *rigs) EXPECT_NE(rig.obstacle, "") << name;
            EXPECT_FALSE(driver::openUsb(ids)) << name;
            EXPECT_FALSE(driver::findHid(
                {.vendor = ids.vendor, .product = ids.product, .serial = "SIM-0042"}, 0))
                << name;
            ++devices;
        }
    }
    EXPECT_GE(devices, 5);
}

/// Found by fuzzing: libusb counts endpoints that it has not read.
TEST(ForeignDevice, WhoseDescriptorsEndTooSoonIsNoRig) {
    auto descriptors = sim::usb::deviceDescriptor({}, sim::CameraKind::Usb2);
    const auto config = sim::usb::configDescriptor(sim::CameraKind::Usb2);
    descriptors.insert(descriptors.end(), config.begin(), config.end());
    std::string text;
    for (std::size_t length = 1; length <= descriptors.size(); ++length) {
        const std::string number = std::to_string(length);
        const std::string node = "bus/usb/001/" + std::string(3 - number.size(), '0') + number;
        text += "P: /devices/usb1/1-" + number + "\nN: " + node +
                "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/" + node + "\n" +
                "E: BUSNUM=001\nE: DEVNUM=" + number + "\nA: busnum=1\\n\nA: devnum=" + number +
                "\\n\nA: speed=480\\n\nA: bConfigurationValue=1\\n\nA: serial=" + number +
                "\\n\nH: descriptors=" + hex(std::span(descriptors).first(length)) + "\n\n";
    }
    const MockBus bus;
    ASSERT_TRUE(umockdev_testbed_add_from_string(bus.testbed(), text.c_str(), nullptr));
    const auto context = driver::makeUsbContext();
    ASSERT_TRUE(context);
    const auto rigs = driver::findRigs(*context, {});
    ASSERT_TRUE(rigs) << rigs.error().message;
    int sound = 0;
    for (const driver::FoundRig& found : *rigs) {
        if (!found.interfaces.complete()) {
            EXPECT_NE(found.rig.obstacle, "") << found.rig.serial;
            continue;
        }
        ++sound;
        EXPECT_EQ(found.rig.serial, std::to_string(descriptors.size())) << "the whole one";
    }
    EXPECT_EQ(sound, 1);
}

}  // namespace
}  // namespace gonio::device_test
