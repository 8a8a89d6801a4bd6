// What only a real kernel shows: run by run_guest.sh, in its guest, once without and once with
// udevd. Nothing is mocked above the cable.

#include <fcntl.h>
#include <libusb.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "tests/device/without_rights.h"
#include "tests/guest/guest_rig.h"

namespace gonio::guest_test {
namespace {

namespace fs = std::filesystem;

// The guest is an emulated machine: ten times what these take on a real one.
constexpr auto kSeen = 3s;      // an unplug
constexpr auto kBack = 20s;     // a replug
constexpr gid_t kPlugdev = 46;  // in the guest's /etc/group

template <class Call>
std::chrono::milliseconds timed(Call call) {
    const auto begin = std::chrono::steady_clock::now();
    call();
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() -
                                                                 begin);
}

/// The rig's folder in sysfs.
fs::path sysfsOfRig() {
    for (const auto& entry : fs::directory_iterator("/sys/bus/usb/devices")) {
        std::string product;
        std::ifstream(entry.path() / "idProduct") >> product;
        std::string vendor;
        std::ifstream(entry.path() / "idVendor") >> vendor;
        std::string serial;
        std::ifstream(entry.path() / "serial") >> serial;
        if (vendor == "1209" && product == "0001" && serial == kSerial) return entry.path();
    }
    ADD_FAILURE() << "no rig in /sys/bus/usb/devices";
    return {};
}

std::string textOf(const fs::path& file) {
    std::string text;
    std::ifstream(file) >> text;
    return text;
}

/// The nodes through which a rig is opened.
std::vector<fs::path> nodesOfRig() {
    const auto padded = [](const std::string& number) {
        return std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number;
    };
    const fs::path rig = sysfsOfRig();
    std::vector<fs::path> nodes{fs::path("/dev/bus/usb") / padded(textOf(rig / "busnum")) /
                                padded(textOf(rig / "devnum"))};
    const std::string below = fs::canonical(rig).string() + "/";
    for (const auto& entry : fs::directory_iterator("/sys/class/hidraw"))
        if (fs::canonical(entry.path()).string().starts_with(below))
            nodes.push_back("/dev" / entry.path().filename());
    return nodes;
}

/// Another process that has the rig open until this ends.
class Holder {
public:
    Holder() {
        int ready[2], end[2];
        if (pipe(ready) != 0 || pipe(end) != 0) return;
        child_ = fork();
        if (child_ == 0) {
            ::close(end[1]);
            const auto transport = openRig();
            char word = transport ? 'y' : 'n';
            (void)!write(ready[1], &word, 1);
            (void)!read(end[0], &word, 1);  // until the parent closes it
            _exit(0);
        }
        ::close(ready[1]);
        ::close(end[0]);
        end_ = end[1];
        char word = 'n';
        (void)!read(ready[0], &word, 1);
        ::close(ready[0]);
        EXPECT_EQ(word, 'y') << "the other process could not open the rig";
    }
    ~Holder() {
        ::close(end_);
        waitpid(child_, nullptr, 0);
    }
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;

private:
    int end_ = -1;
    pid_t child_ = 0;
};

/// Past the driver: its device on the bus where sysfs has it.
libusb_device_handle* openedBySerial(libusb_context* context) {
    const int bus = std::stoi(textOf(sysfsOfRig() / "busnum"));
    const int number = std::stoi(textOf(sysfsOfRig() / "devnum"));
    libusb_device** list = nullptr;
    const auto count = libusb_get_device_list(context, &list);
    libusb_device_handle* handle = nullptr;
    for (auto i = decltype(count){0}; i < count; ++i) {
        if (libusb_get_bus_number(list[i]) == bus && libusb_get_device_address(list[i]) == number) {
            EXPECT_EQ(libusb_open(list[i], &handle), 0);
        }
    }
    if (count >= 0) libusb_free_device_list(list, 1);
    return handle;
}

TEST_F(GuestRig, IsEnumeratedWithAllThatIdentifiesIt) {
    const auto rigs = ownRigs();
    ASSERT_EQ(rigs.size(), 1U);
    EXPECT_EQ(rigs.front().serial, kSerial);
    EXPECT_EQ(rigs.front().protocol, "GRP/1.0");
    EXPECT_EQ(textOf(sysfsOfRig() / "speed"), "480");
    EXPECT_EQ(textOf(sysfsOfRig() / "serial"), kSerial);
    EXPECT_EQ(nodesOfRig().size(), 2U);
}

TEST_F(GuestRig, FramesAreThoseOfTheInProcessDoor) {
    open();
    for (int i = 0; i < 3; ++i) same(litFrames(4));
    EXPECT_EQ(driven->anomalies(), driver::Anomalies{});
}

TEST_F(GuestRig, AStallCostsAChunkAndNoFrame) {
    open();
    rig->live.with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::StallBulk); });
    same(litFrames(3));
    same(litFrames(3));
}

TEST_F(GuestRig, TheThirdStallInTenSecondsIsAFailure) {
    open();
    const auto stalled = [&] {
        rig->live.with([](sim::FaultyUsb& usb) { usb.cause(sim::FaultKind::StallBulk); });
        return driven->capture(litFrames());
    };
    EXPECT_TRUE(stalled());
    EXPECT_TRUE(stalled());
    const auto third = stalled();
    ASSERT_FALSE(third);
    EXPECT_EQ(third.error().kind, ErrorKind::Device);
}

TEST_F(GuestRig, UnpluggedWhileStreamingEveryCallEndsAndThePluggedRigIsTheSame) {
    open();
    const auto boot = driven->identify().ident.bootId;
    std::jthread puller([&] {
        std::this_thread::sleep_for(300ms);
        rig->unplug();
    });
    std::optional<Error> error;
    const auto took = timed([&] {
        for (int i = 0; !error && i < 1000; ++i) {
            const auto capture = driven->capture(litFrames());
            if (!capture) error = capture.error();
        }
    });
    puller.join();
    ASSERT_TRUE(error);
    EXPECT_EQ(error->kind, ErrorKind::Device) << error->message;
    EXPECT_LT(took, 300ms + kSeen);
    EXPECT_LT(timed([&] { close(); }), kSeen);
    EXPECT_FALSE(rig->live.with([](sim::FaultyUsb& usb) { return usb.device().lit(); }));
    awaitRigs(0);
    EXPECT_LT(timed([&] {
                  plug();
                  open();
              }),
              kBack);
    EXPECT_EQ(driven->identify().ident.bootId, boot);
    same(litFrames(2));
}

TEST_F(GuestRig, AfterALossOfPowerItIsAnotherBoot) {
    open();
    const auto boot = driven->identify().ident.bootId;
    close();
    rig.reset();
    awaitRigs(0);
    rig = std::make_unique<CabledRig>(rigConfig(2));
    awaitRigs(1);
    open();
    EXPECT_NE(driven->identify().ident.bootId, boot);
    same(litFrames(2));
}

TEST_F(GuestRig, AResetPortLosesTheLinkAndTheRigIsOpenedAgain) {
    open();
    same(litFrames());
    const auto boot = driven->identify().ident.bootId;
    (void)transport().resetPort();
    close();
    awaitRigs(1);
    open();
    EXPECT_EQ(driven->identify().ident.bootId, boot);
    same(litFrames(2));
}

TEST_F(GuestRig, TheReportsReopenedAreThoseOfTheSameRig) {
    open();
    ASSERT_TRUE(transport().reopenReports());
    same(litFrames(2));
}

TEST_F(GuestRig, AnInterfaceThatAKernelDriverHasIsBusyUntilDetached) {
    libusb_context* context = nullptr;
    ASSERT_EQ(libusb_init(&context), 0);
    libusb_device_handle* handle = openedBySerial(context);
    ASSERT_NE(handle, nullptr);
    EXPECT_EQ(libusb_kernel_driver_active(handle, 0), 1) << "usbhid";
    EXPECT_EQ(libusb_kernel_driver_active(handle, 1), 0);
    EXPECT_EQ(libusb_claim_interface(handle, 0), LIBUSB_ERROR_BUSY);
    EXPECT_EQ(libusb_set_auto_detach_kernel_driver(handle, 1), 0);
    EXPECT_EQ(libusb_claim_interface(handle, 0), 0);
    // Its node is gone with the kernel's driver: the rig is there and cannot be used.
    const auto without = openRig();
    EXPECT_FALSE(without);
    EXPECT_EQ(libusb_release_interface(handle, 0), 0);
    libusb_close(handle);
    libusb_exit(context);
    awaitRigs(1);
    open();
    same(litFrames(1));
}

TEST_F(GuestRig, HeldByAnotherProcessItIsBusyAndFreeAfterwards) {
    {
        const Holder holder;
        const auto transport = openRig();
        ASSERT_FALSE(transport);
        EXPECT_EQ(transport.error().kind, ErrorKind::Busy) << transport.error().message;
    }
    open();
    same(litFrames(1));
}

TEST_F(GuestRig, WithoutPermissionItNamesTheCureAndOpensOnceThereIsOne) {
    for (const fs::path& node : nodesOfRig()) ASSERT_EQ(chmod(node.c_str(), 0600), 0);
    // As udevd does it, a moment after the nodes are there.
    std::atomic<bool> refusedOnce{false};
    std::jthread late([&, nodes = nodesOfRig()] {
        (void)test::waitUntil([&] { return refusedOnce.load(); }, kPatience);
        std::this_thread::sleep_for(500ms);
        for (const fs::path& node : nodes) chmod(node.c_str(), 0666);
    });
    const device_test::WithoutRights unprivileged;  // not the thread that began before
    const auto refused = openRig();
    refusedOnce = true;
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Busy);
    EXPECT_NE(refused.error().message.find("udev"), std::string::npos) << refused.error().message;
    EXPECT_TRUE(test::waitUntil([] { return openRig().has_value(); }, kBack, 100ms));
}

TEST_F(GuestRig, AnAutosuspendedRigIsWokenAndStaysAwakeWhileOpen) {
    const fs::path power = sysfsOfRig() / "power";
    std::ofstream(power / "autosuspend_delay_ms") << 0;
    std::ofstream(power / "control") << "auto";
    const auto suspended = [&] { return textOf(power / "runtime_status") == "suspended"; };
    ASSERT_TRUE(test::waitUntil(suspended, kPatience));
    // One that is just falling asleep may not wake at once.
    EXPECT_TRUE(test::waitUntil([] { return openRig().has_value(); }, kBack, 100ms));
    open();
    EXPECT_FALSE(suspended());
    same(litFrames(2));
    EXPECT_FALSE(suspended());
}

TEST_F(GuestRig, OfTwoRigsTheSerialNumberSaysWhich) {
    sim::DeviceConfig config = rigConfig();
    config.serial = kOtherSerial;
    CabledRig other(config, 2);
    awaitRigs(2);
    const auto unsure = driver::openUsb();
    ASSERT_FALSE(unsure);
    EXPECT_EQ(unsure.error().kind, ErrorKind::Usage);
    const auto sure = driver::openUsb({.serial = kOtherSerial});
    ASSERT_TRUE(sure) << sure.error().message;
    EXPECT_EQ((*sure)->strings().serial, kOtherSerial);
    other.unplug();
    awaitRigs(1);
}

/// Run where udevd runs, with the rule that is installed with the program.
using GuestUdev = GuestRig;

TEST_F(GuestUdev, TheRuleGivesTheNodesToTheGroupAndKeepsTheRigAwake) {
    rig->unplug();
    awaitRigs(0);
    plug();
    const auto ruled = [](const fs::path& node) {
        struct stat seen {};
        return stat(node.c_str(), &seen) == 0 && (seen.st_mode & 0777) == 0660 &&
               seen.st_gid == kPlugdev;
    };
    for (const fs::path& node : nodesOfRig())
        EXPECT_TRUE(test::waitUntil([&] { return ruled(node); }, kBack)) << node;
    EXPECT_EQ(textOf(sysfsOfRig() / "power/control"), "on");
}

}  // namespace
}  // namespace gonio::guest_test
