#pragma once
// Whether pictures are what was asked for, though they came whole and with the right numbers
// (proc/quality/frame_check.h): each frame against the one before it in its bracket, and the first
// of each capture against the light that it must show.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/attendance.h"
#include "daemon/rig_calibration.h"
#include "daemon/state.h"
#include "proc/quality/frame_check.h"
#include "proc/quality/verdict.h"
#include "proc/radiance/dark.h"

namespace gonio::daemon {

/// What a person can do about frames that are not what was asked for.
inline constexpr const char* kOddFramesCure =
    "see to the rig's cable and camera (gonio doctor), and keep lights away";

/// A frame that is not what was asked for.
struct OddFrame {
    std::optional<State> state{};  ///< empty: dark
    std::uint32_t number = 0;      ///< the rig's
    Setback::Cause kind = Setback::Cause::Repeated;
    bool dropped = true;  ///< its bracket was taken again without it

    /// "frame 777 is bit for bit the picture before".
    [[nodiscard]] std::string text() const;
};

/// The mean light of a white reference, electrons per second and pixel of the window at full level;
/// by LED and band.
using WhiteRates = std::vector<std::array<double, 3>>;
[[nodiscard]] WhiteRates whiteRates(const PlacementSignals& white, const Window& window);

class FrameWatch {
public:
    explicit FrameWatch(const proc::SensorNoise& noise) : noise_(noise) {}

    /// From now on a lit frame that is as good as dark is odd. `darks` is borrowed, and so are
    /// those of them that were taken of the same scene just now: they say where no light is.
    void expect(const proc::DarkLibrary& darks,
                WhiteRates white,
                const proc::DarkLibrary* ofThisRun = nullptr);
    /// A bracket begins. `earlier`: a sound frame of it, taken before; borrowed until the next one.
    void begin(const Frame* earlier = nullptr);
    /// What is odd about the next frame of the bracket; one that is not is held against the next.
    [[nodiscard]] std::optional<OddFrame> see(std::optional<State> state, const Frame& frame);

private:
    using Cause = Setback::Cause;
    [[nodiscard]] std::optional<Cause> wrong(std::optional<State> state, const Frame& frame) const;
    [[nodiscard]] std::optional<Cause> disagrees(State state, const Frame& frame) const;
    [[nodiscard]] bool lacksLight(State state, const Frame& frame) const;
    [[nodiscard]] proc::Shown shown(const Frame& frame) const;

    proc::SensorNoise noise_;
    const proc::DarkLibrary* darks_ = nullptr;
    const proc::DarkLibrary* ofThisRun_ = nullptr;
    mutable std::map<Nanoseconds, std::optional<double>> blacks_;  ///< means of those; DN
    WhiteRates white_;
    std::optional<Frame> last_;       ///< that was sound, of whatever bracket
    bool first_ = true;               ///< in its bracket: the last one is of another
    const Frame* earlier_ = nullptr;  ///< what the first one is held against
};

/// `frames`: warned of those that had to be taken again, and of those that show no light.
[[nodiscard]] proc::Verdict framesVerdict(std::span<const OddFrame> odd);

}  // namespace gonio::daemon
