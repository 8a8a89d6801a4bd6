#include "driver/capture_progress.h"

#include <algorithm>
#include <utility>

namespace gonio::driver {
namespace {

constexpr int kReasonsKept = 8;

}  // namespace

void CaptureProgress::start(int frames, int held) {
    frames_.clear();
    frames_.resize(static_cast<std::size_t>(frames));
    most_ = held > 0 ? held : frames;
    held_ = 0;
    delivered_ = 0;
    asked_.clear();
    hopeless_.clear();
    failed_ = interrupted_ = false;
    reasons_ = 0;
    evidence_.clear();
    discarded = resends = recaptures = 0;
}

void CaptureProgress::makeRoom(int frames) {
    const auto count = static_cast<std::size_t>(frames);
    frames_.reserve(count);
    asked_.reserve(count);
    hopeless_.reserve(count);
}

bool CaptureProgress::hasRoom(int frames) const {
    const std::size_t least =
        std::min({frames_.capacity(), asked_.capacity(), hopeless_.capacity()});
    return least >= static_cast<std::size_t>(frames);
}

void CaptureProgress::begin() {
    asked_.assign(frames_.size(), 0);
    hopeless_.assign(frames_.size(), false);
    failed_ = interrupted_ = false;
}

void CaptureProgress::interrupt() {
    asked_.assign(frames_.size(), 0);
    interrupted_ = true;
}

bool CaptureProgress::waitsFor(int frame) const {
    const auto i = static_cast<std::size_t>(frame);
    return !frames_[i].there && !hopeless_[i];
}

bool CaptureProgress::waits() const {
    for (int i = 0; i < static_cast<int>(frames_.size()); ++i) {
        if (waitsFor(i)) return true;
    }
    return false;
}

bool CaptureProgress::soundUpTo(int frame) const {
    if (std::find(hopeless_.begin(), hopeless_.end(), true) != hopeless_.end()) return false;
    return std::all_of(
        frames_.begin(), frames_.begin() + frame, [](const Place& place) { return place.there; });
}

int CaptureProgress::toArm() const {
    const auto last = std::find_if(
        frames_.rbegin(), frames_.rend(), [](const Place& place) { return !place.there; });
    return static_cast<int>(frames_.rend() - last);
}

bool CaptureProgress::hasRoomFor(int frame) const {
    return held_ < most_ || static_cast<std::size_t>(frame) == delivered_;
}

void CaptureProgress::keep(Frame frame) {
    ++held_;
    const auto i = static_cast<std::size_t>(frame.index);
    frames_[i] = {.there = true, .frame = std::move(frame)};
}

void CaptureProgress::discard(int frame) {
    hopeless_[static_cast<std::size_t>(frame)] = true;
    ++discarded;
}

void CaptureProgress::giveUp(int frame, const std::string& why) {
    hopeless_[static_cast<std::size_t>(frame)] = true;
    failed_ = true;
    if (++reasons_ > kReasonsKept) return;
    if (!evidence_.empty()) evidence_ += "; ";
    evidence_ += "frame " + std::to_string(frame) + ": " + why;
}

bool CaptureProgress::mayAskAgain(int frame, int most) {
    int& asked = asked_[static_cast<std::size_t>(frame)];
    if (asked == most) return false;
    ++asked;
    ++resends;
    return true;
}

Result<void> CaptureProgress::deliver(const FrameSink& sink, PixelMemory& memory) {
    while (delivered_ < frames_.size() && frames_[delivered_].there) {
        Frame frame = std::move(*frames_[delivered_].frame);
        frames_[delivered_++].frame.reset();
        --held_;
        if (Result<void> taken = sink(std::move(frame)); !taken) return taken;
        memory.giveBack(std::move(frame.pixels));  // empty where the sink has kept it
    }
    return {};
}

std::vector<Frame> CaptureProgress::takeFrames() {
    std::vector<Frame> taken;
    taken.reserve(frames_.size() - delivered_);
    for (std::size_t i = delivered_; i < frames_.size(); ++i)
        taken.push_back(std::move(*frames_[i].frame));
    return taken;
}

}  // namespace gonio::driver
