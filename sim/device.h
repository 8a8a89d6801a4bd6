#pragma once
// The rig's firmware: GRP/1, device side, in virtual time. It knows nothing of transports: a door
// hands it reports and takes reports and chunks from it, and tells it what time it is. Everything
// that goes in or out is bytes.

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "driver/protocol/reports.h"
#include "proc/core/units.h"
#include "sim/camera.h"
#include "sim/camera_kind.h"
#include "sim/claim.h"
#include "sim/exposing.h"
#include "sim/frame_chunks.h"
#include "sim/frame_flaw.h"
#include "sim/frame_queue.h"
#include "sim/led_drift.h"
#include "sim/notices.h"
#include "sim/reference_errors.h"
#include "sim/rig_errors.h"
#include "sim/stage.h"

namespace gonio::sim {

inline constexpr std::uint8_t kAllBinnings = 0b111, kCoarsestBinning = 0b100;  // 1, 2, 4; 4

struct DeviceConfig {
    std::string serial = "SIM-0001";
    std::uint64_t seed = 1;
    std::uint32_t bootCount = 1;
    ReferenceErrors errors;
    CameraKind camera = CameraKind::Usb2;
    std::uint32_t maxChunkPayload = kMaxChunkPayload;
    RigErrors rig{};
    std::uint8_t binnings = kAllBinnings;  ///< as LIMITS has them
    int leds = kLeds;                      ///< attached: the first ones
};

class Device {
public:
    explicit Device(DeviceConfig config);

    // What a door needs. Times are since boot.
    [[nodiscard]] const std::string& serial() const { return config_.serial; }
    [[nodiscard]] std::uint32_t maxChunkPayload() const { return config_.maxChunkPayload; }
    [[nodiscard]] int leds() const { return config_.leds; }
    [[nodiscard]] CameraLink link() const { return cameraLink(config_.camera); }
    /// Empty: the request stalls.
    [[nodiscard]] std::optional<driver::Report> getFeature(std::uint8_t id);
    /// False: the request stalls.
    bool setFeature(const driver::Report& report);
    void output(const driver::Report& report);
    [[nodiscard]] std::optional<driver::Report> takeInput();
    [[nodiscard]] std::optional<std::vector<std::uint8_t>> takeBulk();
    void resetStream() { flush(); }
    /// Told when the stream was flushed: a chunk that is half sent is dropped then, too.
    void onFlush(std::function<void()> flushed) { flushed_ = std::move(flushed); }
    /// Bus reset, configuration or VBUS loss: dark, aborted, flushed, and the session lapses.
    /// `cause`: the argument of the event.
    void linkLost(std::uint32_t cause = 1);

    /// Lets time pass to `now`: exposures, status reports, the heartbeat's watch.
    void advanceTo(Nanoseconds now);
    /// When something will happen by itself next.
    [[nodiscard]] Nanoseconds nextEvent() const;
    [[nodiscard]] Nanoseconds now() const { return now_; }

    // The simulator's own door.
    void place(Placement placement);
    void setInterlock(std::uint8_t bits);
    [[nodiscard]] const driver::Stats& stats() const { return stats_; }
    /// What is wrong with the exposure that begins; empty: nothing ever is.
    void flawFrames(std::function<FrameFlaw()> flaw) { flaw_ = std::move(flaw); }
    /// The sensor leaves its range of temperature, or comes back.
    void overheat(bool hot);
    /// Its clock runs on from `ahead` microseconds past where it was, modulo 2^64.
    void jumpClock(std::uint64_t aheadUs) { clockUs_ += aheadUs; }
    [[nodiscard]] std::uint64_t clockUs() const;
    /// Power was lost and is back: another boot, with nothing left of the one before.
    void powerCycle();
    /// It was told to reboot, and has to leave the bus within 100 ms and lose its power. Once.
    [[nodiscard]] bool takeReboot() { return std::exchange(rebootWanted_, false); }
    /// Sends a chunk of a type, or tells an event of a code, that no host knows.
    void sendUnknownChunk();
    void tellUnknownEvent();
    /// So many reports at one moment, an event of such a code and a STATUS by turns.
    void pileUpReports(int count);
    [[nodiscard]] const Notices::Overflow& overflow() const { return notices_.overflow(); }
    /// Somebody has claimed it, and his heart beats.
    [[nodiscard]] bool claimed() const { return claim_.alive(); }
    [[nodiscard]] bool capturing() const { return capture_.has_value(); }
    /// An LED shines at this moment.
    [[nodiscard]] bool lit() const { return current_.led >= 0; }

private:
    struct Capture {
        std::uint64_t id = 0;
        int frames = 0;
        int next = 0;  // index of the frame exposing or to come
        bool software = false;
        int triggersWaiting = 0;
    };
    // Commands (device_commands.cpp): each returns its status and result.
    driver::Ack execute(const driver::Command& command);
    driver::Ack carryOut(const driver::Command& command);
    std::uint16_t setLed(const driver::SetLed& args, driver::Arguments& result);
    std::uint16_t setExposure(const driver::SetExposure& args, driver::Arguments& result);
    std::uint16_t setFormat(const driver::SetFormat& args, driver::Arguments& result);
    std::uint16_t arm(const driver::Arm& args, driver::Arguments& result);
    std::uint16_t trigger(std::uint64_t captureId, driver::Arguments& result);
    std::uint16_t resend(const driver::Resend& args);
    std::uint16_t clearFault();
    [[nodiscard]] std::uint32_t applySettings(const Settings& wanted);
    void takeEffect(const Settings& wanted);
    [[nodiscard]] Settings settingsToCome() const;

    // Reports (device_reports.cpp).
    [[nodiscard]] driver::Status status() const;
    [[nodiscard]] driver::Ident ident() const;
    [[nodiscard]] driver::Limits limits() const;
    [[nodiscard]] driver::RigState state() const;
    [[nodiscard]] Temperatures temperatures() const;
    void pushStatus();
    void tellChange();
    void raise(std::uint16_t code, std::uint32_t arg0, std::uint32_t arg1);

    // Sessions.
    void claimOrRelease(const driver::SessionSet& set);
    [[nodiscard]] std::uint16_t claim(const driver::SessionSet& set);
    [[nodiscard]] std::uint16_t release(const driver::SessionSet& set);
    void startClean();
    void checkHeartbeat();
    void lapse(std::uint16_t reason);

    // Exposures.
    void beginExposureIfDue();
    void applyDueSettings();
    void finishExposure();
    void queueFrame(const Exposing& exposing, int index);
    void runPhotometricClock(const Settings& settings, Nanoseconds time);
    [[nodiscard]] Settings picturedWith(FrameFlaw flaw, const Settings& settings) const;
    [[nodiscard]] Image<std::uint16_t> flawed(FrameFlaw flaw, Image<std::uint16_t> image);
    void tellDrift(const Settings& settings);
    [[nodiscard]] Image<std::uint16_t> exposed(const Exposing& done, const NoiseKey& key);
    void abort(std::uint16_t reason);
    void goDark();
    void flush();
    [[nodiscard]] bool freeRunning() const { return capture_ && !capture_->software; }
    [[nodiscard]] bool mayLight() const;

    DeviceConfig config_;
    Digits digits_;
    Camera camera_;
    LedDrift drift_;
    Nanoseconds sincePlaced_{0};  // on the photometric clock

    Nanoseconds now_{0};
    Nanoseconds bootedAt_{0};
    std::uint64_t clockUs_ = 0;  ///< that its clock has jumped
    std::uint32_t bootId_;
    bool hot_ = false;
    std::uint8_t interlock_ = driver::interlock::kMayLight;
    std::uint16_t fault_ = 0;
    Claim claim_;
    std::uint16_t statusOfLastSet_ = 0;
    driver::Stats stats_;

    Settings current_;                                    // of the next exposure
    std::deque<std::pair<std::uint32_t, Settings>> due_;  // from frame_number on
    Format format_;
    std::optional<Capture> capture_;
    std::optional<Exposing> exposing_;
    std::uint32_t nextFrame_ = 1;
    Nanoseconds settledAt_{0};
    bool unsettled_ = false;  // the lit LED has not settled before an exposure yet
    Nanoseconds earliestStart_{0};

    std::function<void()> flushed_;
    std::function<FrameFlaw()> flaw_;
    Settings before_;               ///< of the exposure before
    Image<std::uint16_t> picture_;  ///< the last one

    FrameQueue frames_;
    Notices notices_;
    std::uint16_t nextStatusSequence_ = 0;
    Nanoseconds nextStatusAt_{0};
    std::optional<Nanoseconds> statusAt_;  ///< of the last one
    bool rebootWanted_ = false;
};

}  // namespace gonio::sim
