#pragma once
// A simulated rig on a cable that a test pulls, holds and watches, and the port it hangs on: what
// an engine meets in a laboratory, without the laboratory.

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <vector>

#include "daemon/engine/rig_port.h"
#include "driver/protocol/reports.h"
#include "sim/in_process.h"
#include "tests/support/wait_until.h"

namespace gonio::test {

/// The transport of a simulated rig. What a test asks of it happens in the thread that owns the
/// rig, at its next call.
class Cable : public driver::Transport {
public:
    [[nodiscard]] driver::DeviceStrings strings() const override { return door_.strings(); }
    [[nodiscard]] const Clock& clock() const override { return door_.clock(); }
    Result<void> write(const driver::Report& report) override {
        const driver::Report sent = watchFor(report);
        if (Result<void> there = pass(); !there) return there;
        return door_.write(sent);
    }
    Result<void> setFeature(const driver::Report& report) override {
        if (Result<void> there = pass(); !there) return there;
        if (const auto set = driver::decodeSessionSet(report); set && !set->release) {
            const std::scoped_lock lock(mutex_);
            claims_.push_back(set->sessionId);
        }
        return door_.setFeature(report);
    }
    [[nodiscard]] Result<driver::Report> getFeature(std::uint8_t id) override {
        if (Result<void> there = pass(); !there) return there.error();
        if (mute_) return Error{ErrorKind::Device, "the rig does not answer"};
        return door_.getFeature(id);
    }
    [[nodiscard]] Result<std::optional<driver::Report>> readInput(Nanoseconds wait) override {
        if (Result<void> there = pass(); !there) return there.error();
        auto report = door_.readInput(wait);
        if (report && *report) look(**report);
        return report;
    }
    [[nodiscard]] Result<std::optional<driver::BulkBytes>> readBulk(Nanoseconds wait) override {
        if (Result<void> there = pass(); !there) return there.error();
        return door_.readBulk(wait);
    }
    Result<void> reopenReports() override {
        if (Result<void> there = pass(); !there) return there;
        return door_.reopenReports();
    }
    Result<void> resetPort() override {
        if (Result<void> there = pass(); !there) return there;
        return door_.resetPort();
    }

    // For any thread.
    void pull() { pulled_ = true; }
    void plug() { pulled_ = false; }
    [[nodiscard]] bool pulled() const { return pulled_; }
    /// Is pulled when the LEDs are to go dark, after so many ARMs in all.
    void pullAtDarkeningAfter(int arms) { pullAfter_ = arms; }
    /// Refuses to go dark, once, after so many ARMs in all.
    void refuseDarkeningAfter(int arms) { refuseAfter_ = arms; }
    [[nodiscard]] bool hasRefused() const { return hasRefused_; }
    /// A rig that is there and cannot be claimed: no Feature report is answered.
    void mute(bool on) { mute_ = on; }
    void setInterlock(std::uint8_t bits) { interlock_ = bits; }
    /// Nothing moves from the next call on, until letGo().
    void hold() {
        const std::scoped_lock lock(mutex_);
        held_ = true;
    }
    void letGo() {
        {
            const std::scoped_lock lock(mutex_);
            held_ = false;
        }
        changed_.notify_all();
    }
    /// By the newest STATUS that was read.
    [[nodiscard]] bool lit() const { return lit_; }
    [[nodiscard]] bool wasLit() const { return wasLit_; }
    /// Ids that claimed the rig, in order.
    [[nodiscard]] std::vector<std::uint64_t> claims() const {
        const std::scoped_lock lock(mutex_);
        return claims_;
    }

    /// Once no engine runs: whether an LED is lit now.
    [[nodiscard]] bool litInTheEnd() {
        constexpr Nanoseconds kTwoPeriods = std::chrono::milliseconds(200);  // of STATUS
        door_.device().advanceTo(door_.device().now() + kTwoPeriods);
        while (const auto report = door_.device().takeInput()) look(*report);
        return lit_;
    }
    /// For the thread that owns the rig, or before there is one.
    [[nodiscard]] sim::Device& device() { return door_.device(); }

private:
    /// What is sent in its place.
    driver::Report watchFor(const driver::Report& report) {
        auto command = driver::decodeCommand(report);
        if (!command) return report;
        if (command->op == driver::Op::Arm) ++armed_;
        const bool darkens =
            command->op == driver::Op::SetLed && command->arguments == driver::Arguments{};
        if (!darkens) return report;
        if (isDue(pullAfter_)) pull();
        if (!isDue(refuseAfter_)) return report;
        hasRefused_ = true;
        command->arguments = driver::encode(driver::SetLed{.led = 99});  // which is not there
        return driver::encode(*command);
    }
    /// Once.
    bool isDue(std::atomic<int>& after) const {
        if (after < 0 || armed_ < after) return false;
        after = -1;
        return true;
    }
    Result<void> pass() {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, kPatience, [&] { return !held_; });  // else a failed test hangs
        if (pulled_) {
            if (!wasPulled_) door_.device().linkLost();
            wasPulled_ = true;
            return Error{ErrorKind::Device, "the cable was pulled"};
        }
        wasPulled_ = false;
        if (const int bits = interlock_.exchange(-1); bits >= 0) {
            door_.device().setInterlock(static_cast<std::uint8_t>(bits));
            door_.device().advanceTo(door_.device().now() + kChangeTold);
        }
        return {};
    }
    void look(const driver::Report& report) {
        const auto status = driver::decodeStatus(report);
        if (!status) return;
        lit_ = status->ledOn != 0;
        wasLit_ = wasLit_ || lit_;
    }

    static constexpr Nanoseconds kChangeTold = std::chrono::milliseconds(10);  // by STATUS

    sim::InProcessDoor door_{{}};
    std::atomic<bool> pulled_{false}, mute_{false}, lit_{false}, wasLit_{false};
    std::atomic<bool> hasRefused_{false};
    std::atomic<int> interlock_{-1}, armed_{0}, pullAfter_{-1}, refuseAfter_{-1};
    bool wasPulled_ = false;
    mutable std::mutex mutex_;  // of what follows
    std::condition_variable changed_;
    bool held_ = false;
    std::vector<std::uint64_t> claims_;
};

/// A port without a door to the simulator: as the engine sees it, a real rig.
class TestPort : public daemon::RigPort {
public:
    [[nodiscard]] std::string_view kind() const override { return "usb"; }
    [[nodiscard]] Result<std::vector<daemon::RigListing>> list() override {
        return std::vector<daemon::RigListing>{{.kind = "usb",
                                                .serial = "SIM-0001",
                                                .place = "1-2.3",
                                                .protocol = "GRP/1.0",
                                                .obstacle = {}}};
    }
    [[nodiscard]] Result<driver::Transport*> open() override {
        ++opens_;
        const std::scoped_lock lock(mutex_);
        if (refusal_) return *refusal_;
        if (cable.pulled()) return Error{ErrorKind::NoRig, "no rig is there"};
        return &cable;
    }
    void close() override {}
    [[nodiscard]] std::string placed() const override { return {}; }
    Result<bool> placeMirror(const proc::Wedge& wedge) override {
        if (failsToPlace) throw std::runtime_error("no place for the mirror");
        cable.device().place(
            {.role = sim::Role::Mirror, .surface = nullptr, .wedge = {wedge.aboutX, wedge.aboutY}});
        return mirrorPlacesItself.load();
    }
    void describe(proc::SampleInfo& /*info*/) const override {}

    // For any thread.
    void refuse(std::optional<Error> why) {
        const std::scoped_lock lock(mutex_);
        refusal_ = std::move(why);
    }
    [[nodiscard]] int opens() const { return opens_; }

    Cable cable;
    std::atomic<bool> mirrorPlacesItself{true};  ///< else a person is asked
    std::atomic<bool> failsToPlace{false};       ///< placeMirror() throws

private:
    std::atomic<int> opens_{0};
    std::mutex mutex_;
    std::optional<Error> refusal_;
};

}  // namespace gonio::test
