#include <hidapi.h>
#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "driver/hid_channel.h"
#include "driver/usb_find.h"
#include "driver/usb_ledger.h"
#include "proc/core/log.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;

constexpr auto kRequestLimit = 1s;
constexpr int kListenMs = 2;  // a request waits for at most so long
constexpr std::size_t kInputsKept = 256;
constexpr int kReportSize = static_cast<int>(kReportBytes);

std::string narrow(const wchar_t* text) {
    std::string result;
    for (; text && *text; ++text) result += *text < 0x80 ? static_cast<char>(*text) : '?';
    return result;
}

/// hidapi's look-ups share state between threads.
std::mutex& lookUp() {
    static std::mutex mutex;
    return mutex;
}

}  // namespace

std::optional<HidNode> findHid(const DeviceStrings& rig, int interfaceNumber) {
    const std::scoped_lock lock(lookUp());
    hid_device_info* list = hid_enumerate(rig.vendor, rig.product);
    std::optional<HidNode> found;
    for (const hid_device_info* info = list; info && !found; info = info->next) {
        if (info->interface_number != interfaceNumber || narrow(info->serial_number) != rig.serial)
            continue;
        found = HidNode{
            .path = info->path, .vendor = rig.vendor, .product = rig.product, .serial = rig.serial};
    }
    hid_free_enumeration(list);
    return found;
}

std::string hidObstacle(const HidNode& node) {
    if (access(node.path.c_str(), R_OK | W_OK) == 0) return {};
    if (errno != EACCES) return node.path + ": " + std::generic_category().message(errno);
    return "no permission for " + node.path + ": " + permissionCure(node.vendor, node.product);
}

/// The device, used and closed by one thread alone.
class HidChannel::Owner {
public:
    Owner() = default;
    Owner(const Owner&) = delete;
    Owner& operator=(const Owner&) = delete;
    ~Owner() {
        if (device_) hid_close(device_);
    }
    bool open(const std::string& path) {
        const std::scoped_lock lock(lookUp());
        device_ = hid_open_path(path.c_str());
        return device_ != nullptr;
    }
    [[nodiscard]] hid_device* get() const { return device_; }
    [[nodiscard]] std::string problem() const { return narrow(hid_error(device_)); }

private:
    hid_device* device_ = nullptr;
};

HidChannel::HidChannel(HidNode node) : node_(std::move(node)) { inputs_.reserve(kInputsKept); }

Result<std::shared_ptr<HidChannel>> HidChannel::open(const HidNode& node) {
    const std::string what = "open the reports of rig " + node.serial;
    if (const std::string obstacle = hidObstacle(node); !obstacle.empty())
        return Error{ErrorKind::Busy, what + ": " + obstacle};
    std::shared_ptr<HidChannel> channel(new HidChannel(node));
    channel->thread_ = std::thread([channel] {
        ++usbLedger().hidThreads;
        channel->serve();
        --usbLedger().hidThreads;
    });
    const auto opened = channel->ask(Kind::Open, {});
    if (opened) return channel;
    channel->askToStop();
    channel->awaitStop(std::chrono::steady_clock::now() + kRequestLimit);
    return opened.error().in(what);
}

// ---- what the caller's thread does

Result<Report> HidChannel::ask(Kind kind, const Report& report) {
    std::unique_lock lock(mutex_);
    if (failure_) return *failure_;
    job_ = {.kind = kind, .report = report, .asked = true};
    changed_.notify_all();
    changed_.wait_until(lock, std::chrono::steady_clock::now() + kRequestLimit, [&] {
        return job_.done || failure_;
    });
    if (!job_.done) {
        if (!failure_) fail("does not answer");
        return *failure_;
    }
    if (job_.problem.empty()) return job_.report;
    return Error{ErrorKind::Device, "rig " + node_.serial + ": " + job_.problem};
}

Result<void> HidChannel::write(const Report& report) {
    const auto done = ask(Kind::Write, report);
    if (!done) return done.error();
    return {};
}

Result<void> HidChannel::setFeature(const Report& report) {
    const auto done = ask(Kind::SetFeature, report);
    if (!done) return done.error().in("set feature report " + std::to_string(report[0]));
    return {};
}

Result<Report> HidChannel::getFeature(std::uint8_t id) {
    auto report = ask(Kind::GetFeature, Report{id});
    if (!report) return report.error().in("feature report " + std::to_string(id));
    return report;
}

Result<std::optional<Report>> HidChannel::readInput(Nanoseconds wait) {
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, std::chrono::steady_clock::now() + wait, [&] {
        return !inputs_.empty() || failure_;
    });
    if (inputs_.empty()) {
        if (failure_) return *failure_;
        return std::optional<Report>{};
    }
    const Report report = inputs_.front();
    inputs_.erase(inputs_.begin());
    return std::optional(report);
}

void HidChannel::askToStop() {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
}

void HidChannel::awaitStop(std::chrono::steady_clock::time_point deadline) {
    if (!thread_.joinable()) return;
    std::unique_lock lock(mutex_);
    const bool ended = changed_.wait_until(lock, deadline, [&] { return finished_; });
    lock.unlock();
    if (ended) {
        thread_.join();
    } else {
        log::warning("rig " + node_.serial + ": its reports do not end; they are left behind");
        ++usbLedger().quarantinedThreads;
        thread_.detach();
    }
}

std::optional<Error> HidChannel::failure() const {
    const std::scoped_lock lock(mutex_);
    return failure_;
}

/// With the mutex held.
void HidChannel::fail(const std::string& what) {
    if (!failure_) {
        failure_ = Error{ErrorKind::Device,
                         "rig " + node_.serial + " " + what + "; check its cable and power"};
    }
    changed_.notify_all();
}

// ---- what the owner thread does

void HidChannel::perform(Owner& owner, Job& job) const {
    unsigned char* bytes = job.report.data();
    int moved = kReportSize;
    switch (job.kind) {
        case Kind::Open:
            if (!owner.open(node_.path)) job.problem = "cannot open " + node_.path;
            return;
        case Kind::Write: moved = hid_write(owner.get(), bytes, kReportBytes); break;
        case Kind::SetFeature:
            moved = hid_send_feature_report(owner.get(), bytes, kReportBytes);
            break;
        case Kind::GetFeature:
            moved = hid_get_feature_report(owner.get(), bytes, kReportBytes);
            break;
    }
    if (moved < 0) {
        job.problem = "the device refused it (" + owner.problem() + ")";
    } else if (moved != kReportSize) {
        job.problem = std::to_string(moved) + " bytes, wanted " + std::to_string(kReportSize);
    }
}

void HidChannel::serve() {
    (void)pthread_setname_np(pthread_self(), kReportThread);
    {
        Owner owner;
        Report report{};
        std::unique_lock lock(mutex_);
        while (!stopping_) {
            if (std::exchange(job_.asked, false)) {
                Job work = job_;
                lock.unlock();
                perform(owner, work);
                lock.lock();
                work.done = true;
                job_ = std::move(work);
                changed_.notify_all();
            }
            if (!owner.get() || failure_) {
                changed_.wait_for(lock, 100ms, [&] { return job_.asked || stopping_; });
                continue;
            }
            lock.unlock();
            const int n = hid_read_timeout(owner.get(), report.data(), kReportBytes, kListenMs);
            lock.lock();
            if (n < 0) fail("is gone");
            if (n != kReportSize) continue;  // nothing, or no report of ours
            if (inputs_.size() == kInputsKept) inputs_.erase(inputs_.begin());
            inputs_.push_back(report);
            changed_.notify_all();
        }
    }
    const std::scoped_lock lock(mutex_);
    finished_ = true;
    changed_.notify_all();
}

}  // namespace gonio::driver
