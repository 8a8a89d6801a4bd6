#include <libusb.h>
#include <pthread.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "driver/protocol/chunk.h"
#include "driver/usb_ledger.h"
#include "driver/usb_stream.h"
#include "driver/usb_wake.h"
#include "proc/core/log.h"

namespace gonio::driver {
namespace {

using namespace std::chrono_literals;
using SteadyTime = std::chrono::steady_clock::time_point;

constexpr std::size_t kMostInFlight = std::size_t{2} << 20;  // PROTOCOL.md 3
constexpr int kFewest = 2;
constexpr std::size_t kMost = 64;  // however small the chunks are that a rig says it sends
constexpr auto kDrainLimit = 500ms;
constexpr auto kLeftBehind = 60s;  // then the kernel will not give back what it has
constexpr auto kPause = 20ms;      // before libusb is asked again after it has failed

SteadyTime steadyNow() { return std::chrono::steady_clock::now(); }

void LIBUSB_CALL transferEnded(libusb_transfer* transfer) {
    static_cast<UsbStream*>(transfer->user_data)->ended(*transfer);
}

/// A chunk rounded up to packets, and one packet: the packet that ends it never stands alone.
std::size_t bufferBytes(std::size_t maxChunkPayload, std::size_t packet) {
    const std::size_t chunk = kChunkHeaderBytes + maxChunkPayload;
    return ((chunk + packet - 1) / packet + 1) * packet;
}

}  // namespace

UsbStream::UsbStream(OpenedRig rig) : rig_(std::move(rig)) { ++usbLedger().streams; }

UsbStream::~UsbStream() {
    --usbLedger().streams;
    usbLedger().transfersAllowed -= counters_.ring;
    if (inFlight_ > 0) {
        usbLedger().transfersInFlight -= inFlight_;
        usbLedger().quarantinedTransfers += inFlight_;
        // The kernel may still write into these buffers: better a leak than that.
        using Left = std::pair<OpenedRig, std::vector<Slot>>;
        (void)std::make_unique<Left>(std::move(rig_), std::move(slots_)).release();
        return;
    }
    for (Slot& slot : slots_) libusb_free_transfer(slot.transfer);
    (void)libusb_release_interface(rig_.handle.get(), rig_.interfaces.stream);
}

Result<void> UsbStream::start(std::size_t maxChunkPayload) {
    const std::size_t bytes = bufferBytes(maxChunkPayload, rig_.interfaces.packet);
    slots_.resize(std::clamp<std::size_t>(kMostInFlight / bytes, kFewest, kMost));
    ready_.reserve(slots_.size());
    for (Slot& slot : slots_) {
        slot.buffer.resize(bytes);
        slot.transfer = libusb_alloc_transfer(0);
        if (!slot.transfer) return usbError(LIBUSB_ERROR_NO_MEM, "start the stream");
        libusb_fill_bulk_transfer(slot.transfer,
                                  rig_.handle.get(),
                                  rig_.interfaces.bulkIn,
                                  slot.buffer.data(),
                                  static_cast<int>(bytes),
                                  transferEnded,
                                  this,
                                  0);
    }
    std::unique_lock lock(mutex_);
    setRing(static_cast<int>(slots_.size()));
    holding_ = false;
    submitIdle();
    if (starvedSince_) fail({ErrorKind::Device, memoryHint("rig " + strings().serial, 0)});
    // Also after a failure: what was submitted must be taken back.
    thread_ = std::thread([self = shared_from_this()] { self->serve(); });
    if (failure_) return *failure_;
    return {};
}

// ---- what the caller's thread does

Result<std::optional<BulkBytes>> UsbStream::read(Nanoseconds wait) {
    std::unique_lock lock(mutex_);
    takeBackLent();
    changed_.wait_until(lock, steadyNow() + wait, [&] { return !ready_.empty() || failure_; });
    if (ready_.empty()) {
        if (failure_) return *failure_;
        submitIdle();  // what the system had no memory for before
        return std::optional<BulkBytes>{};
    }
    lent_ = ready_.front();
    ready_.erase(ready_.begin());
    Slot& slot = slots_[*lent_];
    slot.place = Place::Lent;
    const auto length = static_cast<std::size_t>(slot.transfer->actual_length);
    return std::optional(BulkBytes(slot.buffer).first(length));
}

Result<void> UsbStream::resetPort() {
    std::unique_lock lock(mutex_);
    takeBackLent();
    if (gone_) return *failure_;
    portResetWanted_ = true;
    portReset_.reset();
    lock.unlock();
    libusb_interrupt_event_handler(rig_.context.get());
    lock.lock();
    changed_.wait_until(
        lock, steadyNow() + kPortResetLimit, [&] { return portReset_.has_value(); });
    if (portReset_) return *portReset_;
    fail({ErrorKind::Device, "rig " + strings().serial + ": its port cannot be reset"});
    return *failure_;
}

void UsbStream::askToStop() {
    {
        std::unique_lock lock(mutex_);
        stopping_ = true;
        holding_ = true;
    }
    libusb_interrupt_event_handler(rig_.context.get());
}

void UsbStream::awaitStop(SteadyTime deadline) {
    if (!thread_.joinable()) return;
    std::unique_lock lock(mutex_);
    const bool ended = changed_.wait_until(lock, deadline, [&] { return finished_; });
    lock.unlock();
    joinOrLeave(
        thread_, ended, "rig " + strings().serial + ": its stream does not end; it is left behind");
}

std::optional<Error> UsbStream::failure() const {
    std::unique_lock lock(mutex_);
    return failure_;
}

StreamCounters UsbStream::counters() const {
    std::unique_lock lock(mutex_);
    return counters_;
}

// ---- what the stream's own thread does

void UsbStream::serve() {
    (void)pthread_setname_np(pthread_self(), kStreamThread);
    while (true) {
        handleEvents(100);
        std::unique_lock lock(mutex_);
        // Who asks for it gives up in a second and closes: the rig needs it all the same.
        if (std::exchange(portResetWanted_, false)) {
            lock.unlock();
            doResetPort();
            continue;
        }
        if (stopping_) break;
        const bool stalled = std::exchange(stalled_, false);
        const bool suspect = std::exchange(suspect_, false);
        if (failure_) continue;
        if (starvedSince_) submitIdle();
        lock.unlock();
        if (stalled || suspect) recover(stalled);
    }
    // Whoever closes waits for a second at most. Afterwards, too, all is taken back: as long as
    // this process has the interface, the rig cannot be opened anew.
    const SteadyTime limit = steadyNow() + kLeftBehind;
    while (!drain() && steadyNow() < limit) {
    }
    std::unique_lock lock(mutex_);
    finished_ = true;
    changed_.notify_all();
}

void UsbStream::handleEvents(int milliseconds) {
    timeval wait{.tv_sec = 0, .tv_usec = milliseconds * 1000};
    const int code = libusb_handle_events_timeout_completed(rig_.context.get(), &wait, nullptr);
    if (code == 0 || code == LIBUSB_ERROR_INTERRUPTED) return;
    {
        std::unique_lock lock(mutex_);
        fail(usbError(code, "wait for rig " + strings().serial));
    }
    std::this_thread::sleep_for(std::min(std::chrono::milliseconds(milliseconds), kPause));
}

void UsbStream::ended(libusb_transfer& transfer) {
    std::unique_lock lock(mutex_);
    const auto found = std::find_if(
        slots_.begin(), slots_.end(), [&](const Slot& slot) { return slot.transfer == &transfer; });
    Slot& slot = *found;  // only our own transfers end here
    inFlight(-1);
    slot.place = Place::Idle;
    switch (transfer.status) {
        case LIBUSB_TRANSFER_COMPLETED:
            slot.place = Place::Ready;
            ready_.push_back(static_cast<std::size_t>(found - slots_.begin()));
            changed_.notify_all();
            break;
        case LIBUSB_TRANSFER_STALL: stalled_ = true; break;
        case LIBUSB_TRANSFER_OVERFLOW:
            ++counters_.overflows;
            submitIdle();
            break;
        case LIBUSB_TRANSFER_NO_DEVICE:
            gone_ = true;
            fail(usbError(LIBUSB_ERROR_NO_DEVICE, "read from rig " + strings().serial));
            break;
        case LIBUSB_TRANSFER_CANCELLED: break;
        case LIBUSB_TRANSFER_ERROR:
        case LIBUSB_TRANSFER_TIMED_OUT: suspect_ = true; break;
    }
    if (stalled_ || suspect_) holding_ = true;
}

/// Takes all transfers back. False: the kernel does not give them.
bool UsbStream::drain() {
    {
        std::unique_lock lock(mutex_);
        holding_ = true;
        for (Slot& slot : slots_) {
            if (slot.place == Place::InFlight) (void)libusb_cancel_transfer(slot.transfer);
        }
    }
    const SteadyTime deadline = steadyNow() + kDrainLimit;
    const auto left = [this] {
        std::unique_lock lock(mutex_);
        return inFlight_;
    };
    while (left() > 0 && steadyNow() < deadline) handleEvents(20);
    return left() == 0;
}

/// PROTOCOL.md 4: one control request decides whether it is there; then a stall is cleared. The
/// kernel would wait for seconds to clear the halt of a rig that hangs.
void UsbStream::recover(bool stalled) {
    const bool drained = drain();
    const int probe = askWhetherThere(rig_);
    const int cleared =
        stalled && probe == 0 ? libusb_clear_halt(rig_.handle.get(), rig_.interfaces.bulkIn) : 0;
    const bool again = limit_.third(steadyNow().time_since_epoch());
    std::unique_lock lock(mutex_);
    ++(stalled ? counters_.stalls : counters_.errors);
    // Those that ended while the others were drained tell nothing new.
    stalled_ = suspect_ = false;
    const std::string name = "rig " + strings().serial;
    // A rig that hangs says nothing until the time is up, and a port reset may help it.
    if (probe == LIBUSB_ERROR_TIMEOUT)
        return fail({ErrorKind::Device, name + " does not answer; check its cable and power"});
    if (probe != 0) {
        gone_ = true;
        return fail(usbError(LIBUSB_ERROR_NO_DEVICE, "read from " + name));
    }
    if (!drained) return fail({ErrorKind::Device, name + ": its transfers do not come back"});
    if (cleared != 0) return fail(usbError(cleared, "clear the halt of " + name));
    if (again) return fail(streamFault(name));
    holding_ = stopping_;
    submitIdle();
}

/// The reports of a rig that was unplugged may fail a moment before its transfers do.
bool UsbStream::findsItGone() {
    {
        std::unique_lock lock(mutex_);
        if (gone_) return true;
    }
    return isGone(rig_);
}

/// Whatever became of it, the rig has to be opened anew.
void UsbStream::doResetPort() {
    (void)drain();
    const std::string name = "rig " + strings().serial;
    const bool gone = findsItGone();
    const Result<void> done =
        gone ? usbError(LIBUSB_ERROR_NO_DEVICE, "reset the port of " + name) : resetPortOf(rig_);
    std::unique_lock lock(mutex_);
    gone_ |= gone;
    portReset_ = done;
    fail(done ? Error{ErrorKind::Device, name + ": its port was reset"} : done.error());
}

// ---- with the mutex held

void UsbStream::inFlight(int change) {
    inFlight_ += change;
    usbLedger().transfersInFlight += change;
}

int UsbStream::busy() const { return inFlight_ + static_cast<int>(ready_.size()); }

void UsbStream::takeBackLent() {
    if (!lent_) return;
    slots_[*lent_].place = Place::Idle;
    lent_.reset();
    submitIdle();
}

void UsbStream::submitIdle() {
    for (Slot& slot : slots_) {
        if (holding_ || failure_ || busy() >= counters_.ring) return;
        if (slot.place != Place::Idle) continue;
        const int code = libusb_submit_transfer(slot.transfer);
        if (code == 0) {
            slot.place = Place::InFlight;
            inFlight(1);
            starvedSince_.reset();
        } else if (code == LIBUSB_ERROR_NO_MEM) {
            return shrink();
        } else if (code == LIBUSB_ERROR_NO_DEVICE) {
            gone_ = true;
            return fail(usbError(code, "read from rig " + strings().serial));
        } else {
            suspect_ = holding_ = true;
            return;
        }
    }
}

/// What is in flight stays so: the ring shrinks as transfers end.
void UsbStream::shrink() {
    setRing(std::max(kFewest, counters_.ring / 2));
    const std::string name = "rig " + strings().serial;
    if (!std::exchange(warned_, true)) log::warning(memoryHint(name, counters_.ring));
    if (busy() > 0) return;
    if (!starvedSince_) starvedSince_ = steadyNow();
    if (steadyNow() - *starvedSince_ >= kMemoryLimit)
        fail({ErrorKind::Device, memoryHint(name, 0)});
}

void UsbStream::setRing(int transfers) {
    usbLedger().transfersAllowed += transfers - counters_.ring;
    counters_.ring = transfers;
}

void UsbStream::fail(Error error) {
    if (!failure_) failure_ = std::move(error);
    holding_ = true;
    changed_.notify_all();
}

}  // namespace gonio::driver
