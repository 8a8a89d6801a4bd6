#include "tests/device/usbfs_node.h"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <thread>

namespace gonio::device_test {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kSetup = 8;  // bytes before the data of a control transfer
// What usbfs does by itself waits longer than the driver for a rig that answers nothing. (A kernel
// waits for five seconds.)
constexpr auto kKernelPatience = 3s;

usbdevfs_urb& urbOf(UMockdevIoctlData* data) {
    return *reinterpret_cast<usbdevfs_urb*>(data->data);
}

template <class T>
T* resolved(UMockdevIoctlData* arg) {
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, sizeof(T), nullptr);
    T* pointer = data ? reinterpret_cast<T*>(data->data) : nullptr;
    if (data) umockdev_ioctl_data_unref(data);  // its parent keeps it
    return pointer;
}

/// The client's bytes at the urb's buffer.
std::span<std::uint8_t> buffer(UMockdevIoctlData* urb, std::size_t length) {
    UMockdevIoctlData* data =
        umockdev_ioctl_data_resolve(urb, offsetof(usbdevfs_urb, buffer), length, nullptr);
    if (!data) return {};
    const std::span bytes(data->data, static_cast<std::size_t>(data->data_len));
    umockdev_ioctl_data_unref(data);
    return bytes;
}

int statusOf(sim::UsbAnswer answer) {
    switch (answer) {
        case sim::UsbAnswer::Stall: return -EPIPE;
        case sim::UsbAnswer::Overflow: return -EOVERFLOW;
        case sim::UsbAnswer::Gone: return -ENODEV;
        default: return -EPROTO;
    }
}

const sim::UsbReply kNothing{.answer = sim::UsbAnswer::Nak, .data = {}};

bool takeOne(std::atomic<int>& counter) {
    if (counter <= 0) return false;
    --counter;
    return true;
}

}  // namespace

UsbfsNode::UsbfsNode(sim::LiveRig& live, UMockdevTestbed* testbed, std::string path)
    : MockNode(live, testbed, std::move(path)) {
    g_signal_connect(handler(), "handle-ioctl", G_CALLBACK(onIoctl), this);
}

UsbfsNode::~UsbfsNode() {
    retire();
    const std::scoped_lock lock(mutex_);
    for (std::deque<Urb>* urbs : {&controls_, &waiting_, &done_}) forget(*urbs);
    for (auto& [interface, owner] : claims_) g_object_unref(owner);
}

void UsbfsNode::forget(std::deque<Urb>& urbs) {
    for (Urb& urb : urbs) {
        umockdev_ioctl_data_unref(urb.data);
        g_object_unref(urb.client);
    }
    urbs.clear();
}

void UsbfsNode::pull(bool quietly) {
    MockNode::pull(quietly);
    const std::scoped_lock lock(mutex_);
    if (quietly) return;  // then reaping says that the device is gone
    for (std::deque<Urb>* urbs : {&controls_, &waiting_}) {
        for (Urb& urb : *urbs) {
            urb.status = -EPROTO;  // as most unplugs on a real kernel show
            done_.push_back(urb);
        }
        urbs->clear();
    }
}

/// The transfers and claims of a file that was closed are gone with it, as the memory of a killed
/// process is.
void UsbfsNode::forgetTheDead() {
    for (std::deque<Urb>* urbs : {&controls_, &waiting_, &done_}) {
        std::erase_if(*urbs, [](const Urb& urb) {
            if (umockdev_ioctl_client_get_connected(urb.client)) return false;
            umockdev_ioctl_data_unref(urb.data);
            g_object_unref(urb.client);
            return true;
        });
    }
    std::erase_if(claims_, [](const auto& claim) {
        if (umockdev_ioctl_client_get_connected(claim.second)) return false;
        g_object_unref(claim.second);
        return true;
    });
}

gboolean UsbfsNode::onIoctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, UsbfsNode* self) {
    const int error = self->answer(client);
    umockdev_ioctl_client_complete(client, error == 0 ? 0 : -1, error);
    return TRUE;
}

int UsbfsNode::answer(UMockdevIoctlClient* client) {
    const unsigned long request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    std::unique_lock lock(mutex_);
    forgetTheDead();
    if (request == USBDEVFS_REAPURBNDELAY) {
        if (done_.empty() && !advanceControl() && !advanceBulk() && !gone()) {
            lock.unlock();
            std::this_thread::sleep_for(500us);
            lock.lock();
        }
        return reap(client, arg);
    }
    if (request == USBDEVFS_RESET) ++live().faults.portResets;
    if (gone()) return ENODEV;
    switch (request) {
        case USBDEVFS_GET_CAPABILITIES:
            *resolved<std::uint32_t>(arg) =
                USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
            return 0;
        case USBDEVFS_GETDRIVER: return ENODATA;  // no kernel driver is bound
        case USBDEVFS_CLAIMINTERFACE: return claim(client, *resolved<int>(arg));
        case USBDEVFS_DISCONNECT_CLAIM:
            return claim(client,
                         static_cast<int>(resolved<usbdevfs_disconnect_claim>(arg)->interface));
        case USBDEVFS_RELEASEINTERFACE: return release(client, *resolved<int>(arg));
        case USBDEVFS_SUBMITURB: return submit(client, arg);
        case USBDEVFS_DISCARDURB: return discard(arg);
        case USBDEVFS_SETINTERFACE: return setInterface(arg, lock);
        case USBDEVFS_RESET: {
            live().with([](sim::FaultyUsb& usb) { usb.resetPort(); });
            const auto patience = resetPatience_;
            lock.unlock();
            return waitWhileHung(patience);
        }
        case USBDEVFS_CLEAR_HALT: {
            constexpr sim::UsbSetup kClear{
                .requestType = 2, .request = 1, .index = sim::UsbDevice::kBulkIn};
            return this->request(kClear, lock);
        }
        default: return ENOTTY;
    }
}

int UsbfsNode::claim(UMockdevIoctlClient* client, int interface) {
    if (live().faults.claimed) return EBUSY;
    const auto owner = claims_.find(interface);
    if (owner != claims_.end()) {
        if (owner->second == client) return 0;
        if (!isOpenedAlone()) return EBUSY;
        g_object_unref(owner->second);  // of a process that was killed
        claims_.erase(owner);
    }
    claims_.emplace(interface, UMOCKDEV_IOCTL_CLIENT(g_object_ref(client)));
    return 0;
}

int UsbfsNode::release(UMockdevIoctlClient* client, int interface) {
    const auto owner = claims_.find(interface);
    if (owner == claims_.end() || owner->second != client) return EINVAL;
    g_object_unref(owner->second);
    claims_.erase(owner);
    return 0;
}

/// One that the caller waits for. Other requests, and the cable, need not.
int UsbfsNode::request(const sim::UsbSetup& setup, std::unique_lock<std::mutex>& lock) {
    lock.unlock();
    if (const int error = waitWhileHung(kKernelPatience); error != 0) return error;
    const auto reply = live().with([&](sim::FaultyUsb& usb) {
        return isAnothers(usb) ? sim::UsbReply{.answer = sim::UsbAnswer::Gone, .data = {}}
                               : usb.control(setup);
    });
    switch (reply.answer) {
        case sim::UsbAnswer::Done: return 0;
        case sim::UsbAnswer::Nak: return ETIMEDOUT;  // it hangs since this moment
        case sim::UsbAnswer::Gone: return ENODEV;
        default: return EPIPE;
    }
}

int UsbfsNode::setInterface(UMockdevIoctlData* arg, std::unique_lock<std::mutex>& lock) {
    const auto& wanted = *resolved<usbdevfs_setinterface>(arg);
    const sim::UsbSetup set{.requestType = 1,
                            .request = 11,
                            .value = static_cast<std::uint16_t>(wanted.altsetting),
                            .index = static_cast<std::uint16_t>(wanted.interface)};
    return request(set, lock);
}

int UsbfsNode::submit(UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
    UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, sizeof(usbdevfs_urb), nullptr);
    if (!data) return EFAULT;
    const bool control = urbOf(data).type == USBDEVFS_URB_TYPE_CONTROL;
    const bool full = !control && static_cast<int>(waiting_.size()) >= mostTransfers();
    if (full || (control && urbOf(data).buffer_length < static_cast<int>(kSetup))) {
        umockdev_ioctl_data_unref(data);
        return full ? ENOMEM : EINVAL;
    }
    Urb urb{.client = UMOCKDEV_IOCTL_CLIENT(g_object_ref(client)),
            .data = data,
            .reply = {},
            .status = 0};
    (control ? controls_ : waiting_).push_back(urb);
    if (control) (void)advanceControl();
    return 0;
}

int UsbfsNode::mostTransfers() {
    const int most = live().with([](sim::FaultyUsb& usb) { return usb.mostTransfers(); });
    return std::min(most, live().faults.mostTransfers.load());
}

/// False: the rig does not answer it.
bool UsbfsNode::runControl(Urb& urb) {
    const auto length = static_cast<std::size_t>(urbOf(urb.data).buffer_length);
    const auto bytes = buffer(urb.data, length);
    const auto word = [&](std::size_t i) {
        return static_cast<std::uint16_t>(bytes[i] | bytes[i + 1] << 8);
    };
    const sim::UsbSetup setup{.requestType = bytes[0],
                              .request = bytes[1],
                              .value = word(2),
                              .index = word(4),
                              .length = word(6)};
    urb.reply = live().with([&](sim::FaultyUsb& usb) {
        return isAnothers(usb) ? kNothing : usb.control(setup, bytes.subspan(kSetup));
    });
    if (urb.reply.answer == sim::UsbAnswer::Nak) return false;
    if (urb.reply.answer != sim::UsbAnswer::Done) urb.status = statusOf(urb.reply.answer);
    const std::size_t moved = std::min(urb.reply.data.size(), bytes.size() - kSetup);
    std::copy_n(urb.reply.data.begin(), moved, bytes.begin() + kSetup);
    urbOf(urb.data).actual_length = static_cast<int>(moved);
    return true;
}

/// Ends the oldest control transfer if the rig answers it.
bool UsbfsNode::advanceControl() {
    if (controls_.empty() || live().faults.hung || !runControl(controls_.front())) return false;
    done_.push_back(std::move(controls_.front()));
    controls_.pop_front();
    return true;
}

int UsbfsNode::discard(UMockdevIoctlData* arg) {
    const auto address = *reinterpret_cast<gulong*>(arg->data);
    for (std::deque<Urb>* urbs : {&controls_, &waiting_}) {
        const auto found = std::find_if(urbs->begin(), urbs->end(), [&](const Urb& urb) {
            return urb.data->client_addr == address;
        });
        if (found == urbs->end()) continue;
        found->status = -ENOENT;
        done_.push_back(*found);
        urbs->erase(found);
        return 0;
    }
    return EINVAL;
}

void UsbfsNode::sendInstead(std::deque<sim::UsbReply> transfers) {
    const std::scoped_lock lock(mutex_);
    foreign_ = std::move(transfers);
}

void UsbfsNode::resetsFor(std::chrono::milliseconds patience) {
    const std::scoped_lock lock(mutex_);
    resetPatience_ = patience;
}

sim::UsbReply UsbfsNode::nextForeign() {
    if (foreign_->empty()) return kNothing;
    sim::UsbReply reply = std::move(foreign_->front());
    foreign_->pop_front();
    return reply;
}

/// Ends the oldest bulk transfer if the rig has something for it.
bool UsbfsNode::advanceBulk() {
    if (live().faults.hung || waiting_.empty()) return false;
    Urb& urb = waiting_.front();
    const auto length = static_cast<std::size_t>(urbOf(urb.data).buffer_length);
    bool wholePackets = true;
    urb.reply = live().with([&](sim::FaultyUsb& usb) {
        wholePackets = length % usb.bulkPacket() == 0;
        if (isAnothers(usb)) return kNothing;
        return foreign_ ? nextForeign() : usb.bulkIn(length);
    });
    if (urb.reply.answer == sim::UsbAnswer::Nak) return false;
    if (urb.reply.answer != sim::UsbAnswer::Done) {
        urb.status = statusOf(urb.reply.answer);
    } else if (takeOne(live().faults.overflow) || !wholePackets || urb.reply.data.size() > length) {
        // A buffer that ends inside a packet has no room for a full one.
        urb.status = -EOVERFLOW;
    } else if (takeOne(live().faults.protocolErrors)) {
        urb.status = -EPROTO;
    } else if (takeOne(live().faults.shorten)) {
        urb.reply.data.resize(urb.reply.data.size() / 2);
    }
    if (urb.status != 0) urb.reply.data.clear();
    done_.push_back(std::move(urb));
    waiting_.pop_front();
    return true;
}

int UsbfsNode::reap(UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
    const bool keeps = live().faults.keepsCancelled;
    const auto first = std::find_if(done_.begin(), done_.end(), [&](const Urb& urb) {
        return urb.client == client && !(keeps && urb.status == -ENOENT);
    });
    if (first == done_.end()) return gone() ? ENODEV : EAGAIN;
    Urb urb = std::move(*first);
    done_.erase(first);
    usbdevfs_urb& told = urbOf(urb.data);
    told.status = urb.status;
    if (told.type == USBDEVFS_URB_TYPE_BULK) {
        const auto bytes = buffer(urb.data, urb.reply.data.size());
        std::copy_n(urb.reply.data.begin(), bytes.size(), bytes.begin());
        told.actual_length = static_cast<int>(bytes.size());
    }
    UMockdevIoctlData* pointer = umockdev_ioctl_data_resolve(arg, 0, sizeof(void*), nullptr);
    umockdev_ioctl_data_set_ptr(pointer, 0, urb.data);
    umockdev_ioctl_data_unref(pointer);
    umockdev_ioctl_data_unref(urb.data);
    g_object_unref(urb.client);
    return 0;
}

}  // namespace gonio::device_test
