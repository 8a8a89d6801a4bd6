// Traffic of real devices of other kinds through the real USB code: whole, in order, and taken back
// when the recorded host cancelled it; and their descriptors, none of which are a rig's.

#include <umockdev.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>

#include "driver/assembler.h"
#include "driver/hid_channel.h"
#include "driver/usb_find.h"
#include "driver/usb_stream.h"
#include "tests/device/foreign_traffic.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/support/data_file.h"

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
        auto rigs = driver::findRigs(context->get(), {});
        if (!rigs || rigs->size() != 1) return nullptr;
        auto opened = driver::openRig(rigs->front());
        if (!opened || !driver::claimStream(*opened)) return nullptr;
        rigs->clear();
        return std::make_shared<driver::UsbStream>(std::move(*context), std::move(*opened));
    }

    /// The transfers arrive as they were; then nothing does, and what is still in flight is taken
    /// back, as the recorded host did with its last ones.
    void expectWhole(const ForeignTraffic& traffic) {
        std::deque<sim::UsbReply> transfers;
        std::vector<const ForeignTransfer*> wanted;
        for (const ForeignTransfer& transfer : traffic.bulkIn) {
            if (transfer.status == -ENOENT) continue;
            ASSERT_EQ(transfer.status, 0);
            wanted.push_back(&transfer);
            transfers.push_back({.answer = sim::UsbAnswer::Done, .data = transfer.bytes});
        }
        mock.sendInstead(std::move(transfers));
        const auto reading = stream();
        ASSERT_TRUE(reading);
        ASSERT_TRUE(reading->start(kPayload));
        driver::Assembler assembler;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            const auto came = reading->read(10s);
            ASSERT_TRUE(came && *came) << "transfer " << i;
            EXPECT_TRUE(std::equal(
                (*came)->begin(), (*came)->end(), wanted[i]->bytes.begin(), wanted[i]->bytes.end()))
                << "transfer " << i;
            EXPECT_FALSE(assembler.feed(**came));
        }
        EXPECT_EQ(assembler.anomalies().total(), wanted.size()) << "none is a chunk";
        const auto more = reading->read(50ms);
        ASSERT_TRUE(more);
        EXPECT_FALSE(*more);
        const auto counters = reading->counters();
        EXPECT_EQ(counters.stalls + counters.overflows + counters.errors, 0);
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
            EXPECT_TRUE(rigs->empty()) << name;
            EXPECT_FALSE(driver::findHid(
                {.vendor = ids.vendor, .product = ids.product, .serial = "SIM-0042"}, 0))
                << name;
            ++devices;
        }
    }
    EXPECT_GE(devices, 5);
}

}  // namespace
}  // namespace gonio::device_test
