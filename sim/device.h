#pragma once
// The rig's firmware: GRP/1, device side, in virtual time. It knows nothing of transports: a door
// hands it reports and takes reports and chunks from it, and tells it what time it is. Everything
// that goes in or out is bytes.

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "driver/protocol/chunk.h"
#include "driver/protocol/reports.h"
#include "proc/core/units.h"
#include "sim/optics.h"
#include "sim/reference_errors.h"
#include "sim/sensor.h"
#include "sim/stage.h"

namespace gonio::sim {

struct DeviceConfig {
    std::string serial = "SIM-0001";
    std::uint64_t seed = 1;
    std::uint32_t bootCount = 1;
    ReferenceErrors errors;
    double sensorCelsius = 25;  ///< dark current doubles each 7 K
};

class Device {
public:
    explicit Device(DeviceConfig config);

    // What a door needs. Times are since boot.
    [[nodiscard]] const std::string& serial() const { return config_.serial; }
    /// Empty: the request stalls.
    [[nodiscard]] std::optional<driver::Report> getFeature(std::uint8_t id);
    /// False: the request stalls.
    bool setFeature(const driver::Report& report);
    void output(const driver::Report& report);
    [[nodiscard]] std::optional<driver::Report> takeInput();
    [[nodiscard]] std::optional<std::vector<std::uint8_t>> takeBulk();
    void resetStream();
    /// Bus reset, configuration or VBUS loss: dark, aborted, flushed, and the session lapses.
    void linkLost();

    /// Lets time pass to `now`: exposures, status reports, the heartbeat's watch.
    void advanceTo(Nanoseconds now);
    /// When something will happen by itself next.
    [[nodiscard]] Nanoseconds nextEvent() const;
    [[nodiscard]] Nanoseconds now() const { return now_; }

    // The simulator's own door.
    void place(Placement placement);
    void setInterlock(std::uint8_t bits);
    [[nodiscard]] const driver::Stats& stats() const { return stats_; }

private:
    struct Settings {
        int led = -1;
        std::array<std::uint16_t, 3> levels{};
        std::uint32_t exposureUs = 1000;
        std::uint16_t gain = 0;
        bool operator==(const Settings&) const = default;
    };
    struct Format {
        driver::PixelFormat format = driver::PixelFormat::Mono12Packed;
        View view;
        int binning = 1;
    };
    struct Session {
        std::uint64_t id = 0;
        Nanoseconds heartbeat{0};
        std::uint8_t hostMinor = 0;
        driver::Owner owner = driver::Owner::None;
        Nanoseconds lastCommandAt{0};
        std::uint16_t lastCommand = 0;
        std::deque<std::pair<driver::Command, driver::Ack>> stored;  // the last 8
    };
    struct Capture {
        std::uint64_t id = 0;
        int frames = 0;
        int next = 0;  // index of the frame exposing or to come
        bool software = false;
        int triggersWaiting = 0;
    };
    struct Exposing {
        std::uint32_t number = 0;
        Settings settings;
        Nanoseconds start{0}, end{0};
    };
    struct StoredFrame {
        std::uint64_t capture = 0;
        int index = 0;
        std::vector<std::vector<std::uint8_t>> chunks;
    };

    // Commands: each returns its status and result.
    driver::Ack execute(const driver::Command& command);
    std::uint16_t setLed(const driver::SetLed& args, driver::Arguments& result);
    std::uint16_t setExposure(const driver::SetExposure& args, driver::Arguments& result);
    std::uint16_t setFormat(const driver::SetFormat& args, driver::Arguments& result);
    std::uint16_t arm(const driver::Arm& args, driver::Arguments& result);
    std::uint16_t trigger(std::uint64_t captureId, driver::Arguments& result);
    std::uint16_t resend(const driver::Resend& args);
    void abort(std::uint16_t reason);
    void flush();
    void goDark();
    void startClean();

    void claimOrRelease(const driver::SessionSet& set);
    void checkHeartbeat();
    void lapse(std::uint16_t reason);
    void beginExposureIfDue();
    void finishExposure();
    void queueFrame(const Exposing& exposing, int index);
    [[nodiscard]] Image<std::uint16_t> exposed(const Settings& settings, const NoiseKey& key);
    [[nodiscard]] driver::Leader leaderOf(const Exposing& done, Size sent) const;
    /// All but the bytes' count and CRC.
    [[nodiscard]] driver::Trailer trailerOf(const Exposing& done,
                                            const Image<std::uint16_t>& image) const;
    void queueChunk(std::vector<std::uint8_t> chunk, bool resent);
    void raise(std::uint16_t code, std::uint32_t arg0, std::uint32_t arg1);
    void pushStatus();
    [[nodiscard]] driver::Status status() const;
    [[nodiscard]] driver::Ident ident() const;
    [[nodiscard]] driver::Limits limits() const;
    [[nodiscard]] std::uint32_t applySettings(const Settings& wanted);
    [[nodiscard]] const RateImages& rates(int led);
    [[nodiscard]] bool freeRunning() const { return capture_ && !capture_->software; }
    [[nodiscard]] driver::RigState state() const;
    /// LED board, sensor, body, ambient: 0.01 degC.
    [[nodiscard]] std::array<std::int16_t, 4> temperatures() const;

    DeviceConfig config_;
    Optics optics_;
    Sensor sensor_;
    Placement placement_;
    std::optional<FieldOfView> field_;  // of the view that was last looked at
    std::map<int, RateImages> rates_;   // per LED, of the placement and of field_

    Nanoseconds now_{0};
    std::uint32_t bootId_;
    std::uint8_t interlock_ = driver::interlock::kMayLight;
    std::uint16_t fault_ = 0;
    Session session_;
    std::uint16_t statusOfLastSet_ = 0;
    driver::Stats stats_;

    Settings current_;                                    // of the next exposure
    std::deque<std::pair<std::uint32_t, Settings>> due_;  // from frame_number on
    Format format_;
    std::optional<Capture> capture_;
    std::optional<Exposing> exposing_;
    std::uint32_t nextFrame_ = 1;
    Nanoseconds settledAt_{0};
    Nanoseconds earliestStart_{0};

    std::deque<StoredFrame> frameRam_;
    std::deque<std::vector<std::uint8_t>> stream_;
    std::uint32_t nextStreamSequence_ = 1;

    std::deque<driver::Report> inputs_;
    std::deque<driver::Event> events_;  // the last 64
    std::uint32_t nextEventSequence_ = 1;
    std::uint32_t eventsFrom_ = 0;
    std::uint16_t nextStatusSequence_ = 0;
    Nanoseconds nextStatusAt_{0};
};

}  // namespace gonio::sim
