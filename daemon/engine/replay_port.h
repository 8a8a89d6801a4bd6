#pragma once
// A recording in a rig's place (docs/recording.md): each opening is the next of those recorded.

#include <memory>

#include "daemon/engine/rig_port.h"
#include "driver/replay.h"

namespace gonio::daemon {

class ReplayPort : public RigPort {
public:
    explicit ReplayPort(std::unique_ptr<driver::Replay> replay)
        : replay_(std::move(replay)), serial_(replay_->serial()) {}

    [[nodiscard]] std::string_view kind() const override { return "replay"; }
    [[nodiscard]] Result<std::vector<RigListing>> list() override {
        return std::vector<RigListing>{{.kind = "replay",
                                        .serial = serial_,
                                        .place = {},
                                        .protocol = "GRP/1.0",
                                        .obstacle = {}}};
    }
    [[nodiscard]] Result<driver::Transport*> open() override {
        transport_.reset();
        Result<std::unique_ptr<driver::Transport>> opened = replay_->openRig();
        if (!opened) return opened.error();
        transport_ = std::move(*opened);
        return transport_.get();
    }
    void close() override { transport_.reset(); }
    [[nodiscard]] const driver::Replay* replay() const override { return replay_.get(); }
    [[nodiscard]] std::string onlyForJobs() const override {
        return "a recording answers only what was asked then";
    }
    [[nodiscard]] std::string placed() const override { return {}; }
    Result<bool> placeMirror(const proc::Wedge& /*wedge*/) override { return false; }
    void describe(proc::SampleInfo& info) const override { info.extra["rig"] = "replayed"; }

private:
    std::unique_ptr<driver::Replay> replay_;
    const std::string serial_;
    std::unique_ptr<driver::Transport> transport_;
};

}  // namespace gonio::daemon
