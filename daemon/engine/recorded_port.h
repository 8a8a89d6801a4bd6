#pragma once
// A port of which all traffic with its rig is recorded (docs/recording.md).

#include <atomic>
#include <memory>
#include <optional>

#include "daemon/engine/rig_port.h"
#include "driver/recorder.h"

namespace gonio::daemon {

class RecordedPort : public RigPort {
public:
    RecordedPort(std::unique_ptr<RigPort> inner, std::unique_ptr<driver::Recorder> recorder)
        : inner_(std::move(inner)), recorder_(std::move(recorder)) {}

    [[nodiscard]] std::string_view kind() const override { return inner_->kind(); }
    [[nodiscard]] Result<std::vector<RigListing>> list() override { return inner_->list(); }
    [[nodiscard]] Result<driver::Transport*> open() override {
        transport_.reset();  // what it goes around may end now
        Result<driver::Transport*> opened = inner_->open();
        if (!opened) {
            driver::recordRefusal(*recorder_, opened.error(), Nanoseconds{0});
            return opened;
        }
        return &transport_.emplace(**opened, *recorder_);
    }
    void close() override {
        transport_.reset();
        inner_->close();
    }
    [[nodiscard]] const driver::Replay* replay() const override { return inner_->replay(); }
    [[nodiscard]] std::string onlyForJobs() const override {
        if (told_) return inner_->onlyForJobs();
        return "its traffic is recorded, and a replay would wait for the same questions";
    }
    /// The recording ends when its disk is full; the rig goes on.
    [[nodiscard]] std::string takeRecordingEnd() override {
        if (told_ || recorder_->ending().empty()) return inner_->takeRecordingEnd();
        told_ = true;
        return recorder_->ending();
    }
    [[nodiscard]] std::string placed() const override { return inner_->placed(); }
    Result<bool> placeMirror(const proc::Wedge& wedge) override {
        return inner_->placeMirror(wedge);
    }
    void describe(proc::SampleInfo& info) const override { inner_->describe(info); }
    [[nodiscard]] SimPort* simulated() override { return inner_->simulated(); }

private:
    std::unique_ptr<RigPort> inner_;
    std::unique_ptr<driver::Recorder> recorder_;
    std::optional<driver::RecordingTransport> transport_;
    std::atomic<bool> told_{false};  ///< that the recording has ended
};

}  // namespace gonio::daemon
