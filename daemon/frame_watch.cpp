#include "daemon/frame_watch.h"

#include <algorithm>
#include <utility>

#include "proc/optics/cell_grid.h"
#include "proc/quality/frame_check.h"

namespace gonio::daemon {
namespace {

constexpr double kFullLevel = 65535;

std::string listed(std::span<const OddFrame> odd, OddFrame::Kind kind) {
    constexpr int kMost = 5;
    std::string list;
    int count = 0;
    for (const OddFrame& one : odd) {
        if (one.kind != kind || ++count > kMost) continue;
        list += (list.empty() ? "" : ", ") + std::to_string(one.number) + " (" +
                stateName(one.state) + ")";
    }
    return count > kMost ? list + " and " + std::to_string(count - kMost) + " more" : list;
}

}  // namespace

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

FrameWatch::FrameWatch(const proc::DarkLibrary& darks,
                       const proc::SensorNoise& noise,
                       WhiteRates white)
    : darks_(darks), noise_(noise), white_(std::move(white)) {}

void FrameWatch::see(State state, const Frame& frame) {
    if (before_ && proc::isRepeated(frame, *before_, noise_))
        odd_.push_back({state, frame.number, OddFrame::Kind::Repeated});
    if (frame.index == 0 && lacksLight(state, frame))
        odd_.push_back({state, frame.number, OddFrame::Kind::WithoutLight});
    before_ = frame;
}

bool FrameWatch::lacksLight(State state, const Frame& frame) const {
    const auto led = static_cast<std::size_t>(state.led);
    if (led >= white_.size()) return false;
    const Result<const proc::DarkFrame*> dark = darks_.find(frame);
    if (!dark) return false;
    const double level = frame.levels[state.band] / kFullLevel;
    const double electrons = white_[led][index(state.band)] * level * frame.exposure.seconds();
    return proc::showsNoLight(frame, **dark, electrons, noise_);
}

proc::Verdict framesVerdict(std::span<const OddFrame> odd) {
    proc::Verdict verdict{.name = "frames",
                          .grade = proc::Grade::Ok,
                          .figure = {},
                          .evidence = "no picture came twice or without light",
                          .next = {}};
    const std::string repeated = listed(odd, OddFrame::Kind::Repeated);
    const std::string without = listed(odd, OddFrame::Kind::WithoutLight);
    if (repeated.empty() && without.empty()) return verdict;
    verdict.grade = repeated.empty() ? proc::Grade::Warned : proc::Grade::Refused;
    verdict.evidence.clear();
    if (!repeated.empty()) verdict.evidence = "bit for bit the picture before: frames " + repeated;
    if (!without.empty()) {
        verdict.evidence += (repeated.empty() ? "" : "; ") +
                            ("not even 1e-4 of the white's light: frames " + without);
    }
    verdict.next = repeated.empty() ? "see that the LEDs light, and that a sample lies there"
                                    : "unplug the camera for a moment, and measure again";
    return verdict;
}

}  // namespace gonio::daemon
