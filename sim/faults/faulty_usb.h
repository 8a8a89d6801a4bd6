#pragma once
// A simulated rig on a bus and a cable that go wrong as a fault script says. Every door to the rig
// goes through it: it answers as the rig would, or as the bus does when the rig is hung, gone, or
// was never understood. Without a script nothing is wrong. Not for several threads at once.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "sim/faults/chunk_faults.h"
#include "sim/faults/fault_player.h"
#include "sim/faults/report_faults.h"
#include "sim/faults/spoiled_answers.h"
#include "sim/usb_device.h"

namespace gonio::sim {

class FaultyUsb {
public:
    explicit FaultyUsb(DeviceConfig config, UsbIds ids = {});
    FaultyUsb(const FaultyUsb&) = delete;
    FaultyUsb& operator=(const FaultyUsb&) = delete;

    /// The script's time begins now. What an earlier one has begun goes on, and ends when it would.
    void play(FaultScript script);
    /// Now, whatever the script says.
    void cause(const DueFault& fault);
    void cause(FaultKind kind) { cause(DueFault{.kind = kind}); }

    // Time is the rig's own.
    void advanceTo(Nanoseconds to);
    [[nodiscard]] Nanoseconds nextEvent() const;
    [[nodiscard]] Nanoseconds now() const { return usb_.device().now(); }

    // The doors.
    UsbReply control(const UsbSetup& setup, std::span<const std::uint8_t> out = {});
    UsbReply interruptIn();
    UsbReply interruptOut(std::span<const std::uint8_t> report);
    UsbReply bulkIn(std::size_t length);
    /// The report side was opened anew: what was silent speaks again.
    void reportsOpened() { reports_.opened(now()); }
    [[nodiscard]] const ReportFaults& reports() const { return reports_; }
    /// A bus reset, by which the rig loses its link.
    void resetPort();

    // The cable.
    void unplug(bool quietly = false);
    /// One that is plugged in stays as it is.
    void plug() {
        if (!plugged_ || stranger_) plugIn({});
    }
    [[nodiscard]] bool plugged() const { return plugged_; }
    /// The last time it was pulled, no transfer in flight ended in an error.
    [[nodiscard]] bool quietlyPulled() const { return quietly_; }
    /// How often it was pulled: whoever opened it before has lost it.
    [[nodiscard]] int pulls() const { return pulls_; }
    [[nodiscard]] Nanoseconds pulledAt() const { return pulledAt_; }
    /// The longest time from the plug to the claim, of a rig that was pulled.
    [[nodiscard]] Nanoseconds reclaimed() const { return reclaimed_; }
    /// How often its port was reset while it was plugged in.
    [[nodiscard]] int portResets() const { return portResets_; }
    [[nodiscard]] bool hung() const { return hung_; }
    /// The system lets so many transfers be in flight.
    [[nodiscard]] int mostTransfers() const { return mostTransfers_; }

    [[nodiscard]] Device& device() { return usb_.device(); }
    /// The rig that is at the plug: another one after "plug as".
    [[nodiscard]] UsbDevice& usb() { return stranger_ ? *stranger_ : usb_; }
    [[nodiscard]] const UsbIds& ids() const { return usb_.ids(); }
    [[nodiscard]] std::vector<std::uint8_t> deviceDescriptor();
    [[nodiscard]] std::vector<std::uint8_t> configDescriptor();
    /// What was malformed of it, by the names that a script has for it.
    [[nodiscard]] const std::vector<std::string>& malformed() const { return answers_.malformed(); }
    [[nodiscard]] CameraKind kind() const { return usb_.kind(); }
    [[nodiscard]] std::size_t bulkPacket() const { return usb_.bulkPacket(); }

    /// What has gone wrong so far.
    [[nodiscard]] const FaultTally& tally() const { return tally_; }

private:
    void apply(const DueFault& fault);
    [[nodiscard]] bool applyToRig(const DueFault& fault);
    void applyAll(const std::vector<DueFault>& faults);
    void putOff(const std::vector<DueFault>& faults);
    void endLater(const DueFault& fault);
    [[nodiscard]] bool isNoEnd(const DueFault& end) const;
    [[nodiscard]] Nanoseconds& endOfCondition(FaultKind end);
    void plugIn(const std::string& otherSerial);
    [[nodiscard]] std::optional<ChunkBytes> nextChunk();
    [[nodiscard]] std::optional<ChunkBytes> fetchChunk();
    [[nodiscard]] FrameFlaw flawOfExposure();

    DeviceConfig config_;
    FaultTally tally_;
    FaultPlayer player_;
    ChunkFaults chunks_{tally_};
    ReportFaults reports_{tally_};
    SpoiledAnswers answers_;
    UsbDevice usb_;
    std::unique_ptr<UsbDevice> stranger_;

    /// When what lasts for a while is over, by the fault that ends it.
    std::map<FaultKind, Nanoseconds> endsAt_;
    bool plugged_ = true, quietly_ = false, errorDue_ = false, powerLost_ = false;
    bool hung_ = false, hungUntilReset_ = false;
    int pulls_ = 0;
    Nanoseconds pulledAt_{0};
    std::optional<Nanoseconds> backSince_;  ///< plugged in again, not yet claimed
    Nanoseconds reclaimed_{0};
    int portResets_ = 0;
    int mostTransfers_;
    int commandsToLose_ = 0;
    int unknownChunksDue_ = 0;
    int framesSent_ = 0, chunkOfFrame_ = -1;
    std::deque<FaultKind> flaws_;  ///< of exposures to come
};

}  // namespace gonio::sim
