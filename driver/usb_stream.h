#pragma once
// The bulk stream of an opened rig: a ring of transfers in flight and the thread that serves it.
// The ring holds at most 2 MiB; when the system refuses memory it is halved, down to two transfers.
// With memory for none it tries again, and has failed after kMemoryLimit (protocol/fault_limit.h);
// at the start it has failed at once.
// Nothing is allocated after start(). A transfer that nobody has read, or that the reader still
// looks at, is not in flight: a slow reader holds the rig back and loses nothing.
// STALL or ERROR: all transfers are drained, and one control request decides whether the rig is
// still there; then a halt is cleared, and the stream goes on. OVERFLOW: that chunk is dropped. A
// third stall or error in ten seconds is a failure, and a failure is final.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "driver/protocol/fault_limit.h"
#include "driver/usb_find.h"

struct libusb_transfer;

namespace gonio::driver {

/// The name of the thread that serves a stream, as `top -H` and a debugger show it.
inline constexpr const char* kStreamThread = "gonio-stream";

/// What the stream had to cope with since it began.
struct StreamCounters {
    int stalls = 0;
    int overflows = 0;
    int errors = 0;
    int ring = 0;  ///< transfers that may be in flight
};

class UsbStream : public std::enable_shared_from_this<UsbStream> {
public:
    explicit UsbStream(OpenedRig rig);
    ~UsbStream();
    UsbStream(const UsbStream&) = delete;
    UsbStream& operator=(const UsbStream&) = delete;

    /// Fills the ring with transfers that each hold a chunk of `maxChunkPayload` bytes.
    Result<void> start(std::size_t maxChunkPayload);
    /// Borrowed until the next call of read() or resetPort().
    [[nodiscard]] Result<std::optional<BulkBytes>> read(Nanoseconds wait);
    /// Resets the port, on the stream's own thread; the stream has failed then, for the rig has
    /// lost its link. An error when the port is not reset in a second (it is then reset as soon as
    /// that thread can, also after closing). A rig that is gone is an error without a reset: a
    /// kernel may try for seconds to reset a port that nothing is at.
    Result<void> resetPort();
    /// Asks the thread to end, and waits for it until `deadline`; a thread that is not done then
    /// keeps this object alive by itself, and the rig is Busy until its transfers are back.
    void askToStop();
    void awaitStop(std::chrono::steady_clock::time_point deadline);

    [[nodiscard]] const DeviceStrings& strings() const { return rig_.strings; }
    [[nodiscard]] const RigInterfaces& interfaces() const { return rig_.interfaces; }
    [[nodiscard]] std::optional<Error> failure() const;
    [[nodiscard]] StreamCounters counters() const;
    /// A transfer has ended. Called by libusb, on the thread of the stream.
    void ended(libusb_transfer& transfer);

private:
    enum class Place {
        Idle,
        InFlight,
        Ready,
        Lent
    };
    struct Slot {
        libusb_transfer* transfer = nullptr;
        std::vector<std::uint8_t> buffer;
        Place place = Place::Idle;
    };

    void serve();
    void handleEvents(int milliseconds);
    [[nodiscard]] bool drain();
    void recover(bool stalled);
    void doResetPort();
    [[nodiscard]] bool findsItGone();
    // With the mutex held:
    void submitIdle();
    void inFlight(int change);
    void takeBackLent();
    void shrink();
    void setRing(int transfers);
    void fail(Error error);
    [[nodiscard]] int busy() const;

    OpenedRig rig_;
    std::thread thread_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Slot> slots_;
    std::vector<std::size_t> ready_;   ///< slots with a chunk, oldest first
    std::optional<std::size_t> lent_;  ///< the slot whose bytes the reader has
    StreamCounters counters_;
    int inFlight_ = 0;
    std::optional<std::chrono::steady_clock::time_point> starvedSince_;  ///< no memory for any
    bool holding_ = true;  ///< nothing is submitted: before start, while draining, after the end
    bool stalled_ = false, suspect_ = false;
    bool stopping_ = false, finished_ = false, warned_ = false;
    bool gone_ = false, portResetWanted_ = false;
    std::optional<Result<void>> portReset_;
    std::optional<Error> failure_;
    FaultLimit limit_;
};

}  // namespace gonio::driver
