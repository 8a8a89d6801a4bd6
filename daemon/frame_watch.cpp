#include "daemon/frame_watch.h"

#include <algorithm>
#include <utility>

#include "proc/optics/cell_grid.h"
#include "proc/quality/frame_check.h"

namespace gonio::daemon {
namespace {

constexpr double kFullLevel = 65535;

std::string_view finding(Setback::Cause kind) {
    switch (kind) {
        case Setback::Cause::Repeated: return "is bit for bit the picture before";
        case Setback::Cause::Blank: return "is no picture: all pixels are alike, without noise";
        case Setback::Cause::Unlit: return "shows not even 1e-4 of the white's light";
        case Setback::Cause::Exposure: return "does not have the light of its exposure";
        case Setback::Cause::Reflex: return "is saturated where the sample is dim: a reflex";
        default: return "is not what was asked for";
    }
}

std::string listed(std::span<const OddFrame> odd, bool dropped) {
    constexpr int kMost = 5;
    std::string list;
    int count = 0;
    for (const OddFrame& one : odd) {
        if (one.dropped != dropped || ++count > kMost) continue;
        list += (list.empty() ? "" : "; ") + bracketName(one.state) + ": " + one.text();
    }
    return count > kMost ? list + "; and " + std::to_string(count - kMost) + " more" : list;
}

double meanOf(const Image<float>& image) {
    double sum = 0;
    for (const float value : image.pixels()) sum += static_cast<double>(value);
    return sum / static_cast<double>(image.size().pixels());
}

/// Of the same frame of the plan, in two attempts (driver/capture_ids.h). A simulated rig draws its
/// noise by the plan, so that a sound frame taken again is the same picture there.
bool isTakenAgain(const Frame& frame, const Frame& before) {
    return frame.captureId != before.captureId && frame.captureId >> 16 == before.captureId >> 16 &&
           frame.index == before.index;
}

}  // namespace

std::string OddFrame::text() const {
    return "frame " + std::to_string(number) + " " + std::string(finding(kind));
}

WhiteRates whiteRates(const PlacementSignals& white, const Window& window) {
    WhiteRates rates;
    const auto pixels = static_cast<double>(window.sent().pixels());
    for (const auto& bands : white) {
        auto& rate = rates.emplace_back();
        for (const Band band : kBands) {
            const proc::CellSignal& cells = bands[index(band)];
            double sum = 0;
            for (std::size_t cell = 0; cell < cells.size(); ++cell)
                if (cells.present(cell))
                    sum += cells.signal[cell] * proc::CellGrid::solidAngle(cell);
            rate[index(band)] = sum / pixels;
        }
    }
    return rates;
}

void FrameWatch::expect(const proc::DarkLibrary& darks,
                        WhiteRates white,
                        const proc::DarkLibrary* ofThisRun) {
    darks_ = &darks;
    ofThisRun_ = ofThisRun;
    blacks_.clear();
    white_ = std::move(white);
}

void FrameWatch::begin(const Frame* earlier) {
    first_ = true;
    earlier_ = earlier;
}

std::optional<OddFrame> FrameWatch::see(std::optional<State> state, const Frame& frame) {
    if (const auto kind = wrong(state, frame))
        return OddFrame{.state = state, .number = frame.number, .kind = *kind};
    last_ = frame;
    first_ = false;
    earlier_ = nullptr;
    return std::nullopt;
}

std::optional<Setback::Cause> FrameWatch::wrong(std::optional<State> state,
                                                const Frame& frame) const {
    if (last_ && !isTakenAgain(frame, *last_) && proc::isRepeated(frame, *last_, noise_))
        return Cause::Repeated;
    if (proc::isBlank(frame, noise_)) return Cause::Blank;
    if (!state) return std::nullopt;
    if (const auto cause = disagrees(*state, frame)) return cause;
    if (frame.index == 0 && lacksLight(*state, frame)) return Cause::Unlit;
    return std::nullopt;
}

std::optional<Setback::Cause> FrameWatch::disagrees(State state, const Frame& frame) const {
    const Frame* const before = first_ ? earlier_ : &*last_;
    if (before == nullptr || before->led != frame.led || before->levels[state.band] == 0)
        return std::nullopt;
    switch (proc::agreement(shown(frame), shown(*before), state.band, noise_)) {
        case proc::Agreement::Agrees: return std::nullopt;
        case proc::Agreement::Reflex: return Cause::Reflex;
        default: return Cause::Exposure;
    }
}

/// By the mean dark frame of its exposure, where there is one.
proc::Shown FrameWatch::shown(const Frame& frame) const {
    constexpr double kOfDarkFrame = 0.1;  // DN: a sensor's black level wanders
    proc::Shown shown{.frame = &frame, .black = {.dn = static_cast<double>(frame.blackLevel)}};
    if (ofThisRun_ == nullptr) return shown;
    const Result<const proc::DarkFrame*> dark = ofThisRun_->find(frame);
    if (!dark) return shown;
    auto& known = blacks_[frame.exposure.granted];
    if (!known) known = meanOf((*dark)->mean);
    shown.black = {.dn = *known, .u = kOfDarkFrame, .holdsLeaks = true};
    return shown;
}

bool FrameWatch::lacksLight(State state, const Frame& frame) const {
    const auto led = static_cast<std::size_t>(state.led);
    if (darks_ == nullptr || led >= white_.size()) return false;
    const Result<const proc::DarkFrame*> dark = darks_->find(frame);
    if (!dark) return false;
    const double level = frame.levels[state.band] / kFullLevel;
    const double electrons = white_[led][index(state.band)] * level * frame.exposure.seconds();
    return proc::showsNoLight(frame, **dark, electrons, noise_);
}

proc::Verdict framesVerdict(std::span<const OddFrame> odd) {
    proc::Verdict verdict{.name = "frames",
                          .grade = proc::Grade::Ok,
                          .figure = {},
                          .evidence = "each picture is what was asked for",
                          .next = {}};
    const std::string again = listed(odd, true), without = listed(odd, false);
    if (again.empty() && without.empty()) return verdict;
    verdict.grade = proc::Grade::Warned;
    verdict.evidence = without;
    if (!again.empty())
        verdict.evidence += (without.empty() ? "taken again: " : "; taken again: ") + again;
    verdict.next =
        without.empty() ? kOddFramesCure : "see that the LEDs light, and that a sample lies there";
    return verdict;
}

}  // namespace gonio::daemon
