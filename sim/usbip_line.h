#pragma once
// One rig on one USB/IP connection, as an emulated cable: submitted transfers wait as long as the
// rig has nothing for them, end as it answers, or are taken back. A client that breaks the rules,
// reads nothing for seconds or is gone has pulled the cable; so has who asks this end to stop. When
// the rig's own cable is pulled, the connection ends.

#include <array>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>

#include "sim/live_rig.h"
#include "sim/stream_socket.h"
#include "sim/usbip_codec.h"

namespace gonio::sim {

class UsbipLine {
public:
    /// Both are borrowed. `early`: what was read before, behind the request to attach.
    /// `pulls`: of the rig's cable when it was plugged in here; empty: now.
    UsbipLine(LiveRig& rig,
              StreamSocket& socket,
              usbip::Bytes early = {},
              std::optional<int> pulls = {});
    ~UsbipLine();
    UsbipLine(const UsbipLine&) = delete;
    UsbipLine& operator=(const UsbipLine&) = delete;

    /// Until the client is gone or `stop` is asked for. An error is what the client did wrong.
    Result<void> serve(const std::stop_token& stop);

private:
    struct Outcome {
        int status = 0;
        usbip::Bytes data{};
    };
    enum Queue {
        kControl,
        kInterruptIn,
        kInterruptOut,
        kBulkIn,
        kQueues
    };
    [[nodiscard]] static std::optional<Queue> queueOf(const usbip::Submit& submit);
    Result<void> takeCommands();
    Result<void> take(usbip::Submit submit);
    void reopenReports();
    Result<void> take(const usbip::Unlink& unlink);
    /// True: a transfer has ended.
    Result<bool> advance();
    /// Empty: the rig has nothing yet.
    [[nodiscard]] std::optional<Outcome> outcome(Queue queue, const usbip::Submit& submit);
    [[nodiscard]] std::optional<Outcome> nextReport();
    Result<void> end(const usbip::Submit& submit, Outcome outcome);
    Result<void> send(std::span<const std::uint8_t> bytes);
    [[nodiscard]] bool idle() const;
    /// The cable, by a fault script or by hand.
    [[nodiscard]] bool pulled();
    void breakTransfers();

    LiveRig& rig_;
    StreamSocket& socket_;
    usbip::Bytes inbox_;
    int pulls_;
    bool reportsClosed_ = false;  ///< the client has taken back all that waited for reports
    std::stop_token stop_;
    std::array<std::deque<usbip::Submit>, kQueues> waiting_;
    std::mutex mutex_;  ///< of the reports, which the rig hands on in a thread of its own
    std::deque<usbip::Bytes> reports_;
};

}  // namespace gonio::sim
