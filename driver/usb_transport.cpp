#include "driver/usb_transport.h"

#include <utility>

#include "driver/hid_channel.h"
#include "driver/identity.h"
#include "driver/protocol/reports.h"
#include "driver/steady_clock.h"
#include "driver/usb_find.h"
#include "driver/usb_power.h"
#include "driver/usb_stream.h"
#include "driver/usb_wake.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr auto kCloseLimit = 900ms;   // of the second that closing may take
constexpr auto kReopenLimit = 200ms;  // for the old reports to end
// Where IDENT does not say it, asked twice: the rig is of another major version, or damaged, and
// the link will refuse it by name.
constexpr std::size_t kAnyPayload = 64 * 1024;
constexpr std::size_t kLargestPayload = std::size_t{16} << 20;

Result<std::shared_ptr<HidChannel>> openReports(const DeviceStrings& rig,
                                                const RigInterfaces& interfaces) {
    const auto node = findHid(rig, interfaces.hid);
    if (node) return HidChannel::open(*node);
    return Error{ErrorKind::Device,
                 "rig " + rig.serial +
                     ": its HID interface has no hidraw node; is the module hidraw loaded, and "
                     "/dev of this container complete?"};
}

class UsbTransport : public Transport {
public:
    UsbTransport(std::shared_ptr<UsbStream> stream, std::shared_ptr<HidChannel> hid)
        : stream_(std::move(stream)), hid_(std::move(hid)) {}
    ~UsbTransport() override {
        const auto deadline = std::chrono::steady_clock::now() + kCloseLimit;
        hid_->askToStop();
        stream_->askToStop();
        stream_->awaitStop(deadline);
        hid_->awaitStop(deadline);
    }
    UsbTransport(const UsbTransport&) = delete;
    UsbTransport& operator=(const UsbTransport&) = delete;

    [[nodiscard]] DeviceStrings strings() const override { return stream_->strings(); }
    [[nodiscard]] const Clock& clock() const override { return clock_; }

    Result<void> write(const Report& report) override {
        if (auto lost = stream_->failure()) return *lost;
        return hid_->write(report);
    }
    Result<void> setFeature(const Report& report) override {
        if (auto lost = stream_->failure()) return *lost;
        return hid_->setFeature(report);
    }
    [[nodiscard]] Result<Report> getFeature(std::uint8_t id) override {
        if (auto lost = stream_->failure()) return *lost;
        return hid_->getFeature(id);
    }
    [[nodiscard]] Result<std::optional<Report>> readInput(Nanoseconds wait) override {
        auto report = hid_->readInput(wait);
        if (report && !*report) {
            if (auto lost = stream_->failure()) return *lost;
        }
        return report;
    }
    [[nodiscard]] Result<std::optional<BulkBytes>> readBulk(Nanoseconds wait) override {
        auto chunk = stream_->read(wait);
        if (chunk && !*chunk) {
            if (auto lost = hid_->failure()) return *lost;
        }
        return chunk;
    }
    Result<void> reopenReports() override {
        hid_->askToStop();
        hid_->awaitStop(std::chrono::steady_clock::now() + kReopenLimit);
        auto fresh = openReports(stream_->strings(), stream_->interfaces());
        if (!fresh) return fresh.error();
        hid_ = std::move(*fresh);
        return {};
    }
    Result<void> resetPort() override { return stream_->resetPort(); }

private:
    SteadyClock clock_;
    std::shared_ptr<UsbStream> stream_;
    std::shared_ptr<HidChannel> hid_;
};

Result<OpenedRig> choose(const FoundRig& found) {
    auto opened = openRig(found);
    if (!opened) return opened;
    if (opened->strings.serial.empty() && isSilent(*opened)) {
        if (auto woken = wake(std::move(*opened)); !woken) return woken.error();
        return Error{
            ErrorKind::Device,
            "rig at " + found.rig.place + " does not answer; its port was reset, open it again"};
    }
    noteAnswer(*opened);
    return opened;
}

/// A rig whose number the system does not tell is opened to read it.
Result<OpenedRig> bySerial(const std::vector<FoundRig>& rigs, const std::string& serial) {
    std::optional<Error> obstacle;
    std::string others;
    for (const FoundRig& found : rigs) {
        auto chosen = choose(found);
        if (!chosen) {
            if (!obstacle || found.rig.serial == serial) obstacle = chosen.error();
            continue;
        }
        const std::string& its = chosen->strings.serial;
        if (its == serial) return chosen;
        if (its.empty()) {
            obstacle = Error{
                ErrorKind::Device,
                nameOf(*chosen) + ": its serial number cannot be read; check its cable and power"};
            continue;
        }
        others += (others.empty() ? "" : ", ") + its;
    }
    if (obstacle) return *obstacle;
    return Error{ErrorKind::NoRig, "rig " + serial + " is not there, rig " + others + " is"};
}

/// Nobody has asked for it by its serial number, so that it may have none.
Result<OpenedRig> theOnlyOne(const FoundRig& rig) {
    auto chosen = choose(rig);
    if (!chosen) return chosen;
    if (auto sound = checkSerial(chosen->strings); !sound)
        return sound.error().in("USB device " + chosen->place);
    return chosen;
}

/// Also those that are no rigs.
Result<std::vector<FoundRig>> findAll(const UsbSelection& wanted) {
    if (auto done = awaitPortResets(); !done) return done.error();
    const auto context = makeUsbContext();
    if (!context) return context.error();
    return findRigs(*context, wanted);
}

/// Those that may be rigs; an error that says why there is none.
Result<std::vector<FoundRig>> soundOnes(std::vector<FoundRig> rigs) {
    std::string obstacle;
    for (const FoundRig& found : rigs) {
        if (!found.interfaces.complete())
            obstacle = "USB device " + found.rig.place + " (" +
                       idText(found.rig.vendor, found.rig.product) +
                       ") is no rig: " + found.rig.obstacle + "; install a rig's firmware";
    }
    std::erase_if(rigs, [](const FoundRig& found) { return !found.interfaces.complete(); });
    if (rigs.empty() && !obstacle.empty()) return Error{ErrorKind::NoRig, obstacle};
    return rigs;
}

Result<OpenedRig> theOne(const std::vector<FoundRig>& rigs, const UsbSelection& wanted) {
    const std::string ids = idText(wanted.vendor, wanted.product);
    if (rigs.empty()) {
        return Error{ErrorKind::NoRig,
                     "no rig " + (wanted.serial ? *wanted.serial + " " : std::string()) +
                         "with USB id " + ids + " is there; is it plugged in and powered?"};
    }
    if (wanted.serial) return bySerial(rigs, *wanted.serial);
    if (rigs.size() == 1) return theOnlyOne(rigs.front());
    std::string names;
    for (const FoundRig& found : rigs) names += " " + found.rig.serial;
    return Error{ErrorKind::Usage,
                 std::to_string(rigs.size()) + " rigs with USB id " + ids + " are there:" + names +
                     "; say which one by its serial number: --rig usb:SERIAL"};
}

Result<Ident> identOf(HidChannel& hid) {
    const auto report = hid.getFeature(static_cast<std::uint8_t>(ReportId::Ident));
    if (!report) return report.error();
    return decodeIdent(*report);
}

std::size_t payloadOf(HidChannel& hid) {
    auto ident = identOf(hid);
    if (!ident) ident = identOf(hid);  // a report may be damaged on its way
    if (!ident || ident->maxChunkPayload == 0 || ident->maxChunkPayload > kLargestPayload)
        return kAnyPayload;
    return ident->maxChunkPayload;
}

/// Looks into a rig without taking it from whoever uses it.
void inspect(const FoundRig& found, UsbRig& rig) {
    const auto opened = openRig(found);
    if (!opened) {
        rig.obstacle = opened.error().message;
        return;
    }
    if (!opened->strings.serial.empty()) rig.serial = opened->strings.serial;
    rig.protocol = opened->strings.protocol;
    rig.superSpeed = canSuperSpeed(*opened);
    const auto node = findHid(opened->strings, found.interfaces.hid);
    rig.obstacle = node ? hidObstacle(*node) : "its HID interface has no hidraw node";
}

}  // namespace

Result<std::vector<UsbRig>> listUsb(const UsbSelection& wanted) {
    const auto found = findAll(wanted);
    if (!found) return found.error();
    std::vector<UsbRig> rigs;
    for (const FoundRig& one : *found) {
        rigs.push_back(one.rig);
        if (one.interfaces.complete()) inspect(one, rigs.back());
    }
    return rigs;
}

Result<std::unique_ptr<Transport>> openUsb(const UsbSelection& wanted) {
    auto found = findAll(wanted);
    if (!found) return found.error();
    const auto rigs = soundOnes(std::move(*found));
    if (!rigs) return rigs.error();
    auto opened = theOne(*rigs, wanted);
    if (!opened) return opened.error();
    keepAwake(opened->place);
    if (auto claimed = claimStream(*opened); !claimed) return claimed.error();
    auto hid = openReports(opened->strings, opened->interfaces);
    if (!hid) return hid.error();
    auto stream = std::make_shared<UsbStream>(std::move(*opened));
    std::unique_ptr<Transport> transport = std::make_unique<UsbTransport>(stream, *hid);
    const auto started = stream->start(payloadOf(**hid));
    if (!started) return started.error();
    return transport;
}

}  // namespace gonio::driver
