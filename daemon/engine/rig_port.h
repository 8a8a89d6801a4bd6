#pragma once
// Where a daemon's rig is: simulated in this process, or on USB. A port opens the rig, finds it
// again, and knows what a person would otherwise have to tell: what lies under it.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "driver/protocol/transport.h"
#include "proc/core/result.h"
#include "proc/optics/mirror.h"
#include "proc/table/sample_set.h"

namespace gonio::driver {
class Replay;
}

namespace gonio::daemon {

class SimPort;

/// How often a rig that is not there is looked for (PROTOCOL.md 4).
inline constexpr Nanoseconds kRescanning = std::chrono::milliseconds(500);

/// A rig that could be used.
struct RigListing {
    std::string kind;  ///< "sim", "usb" or "replay"
    std::string serial;
    std::string place;     ///< bus and ports; empty for a simulated one
    std::string protocol;  ///< "GRP/1.0"; empty where it cannot be read
    std::string obstacle;  ///< why it cannot be opened, and the cure; empty: it can
};

/// Calls come from the thread that owns the rig; list() from any.
class RigPort {
public:
    virtual ~RigPort() = default;

    [[nodiscard]] virtual std::string_view kind() const = 0;
    [[nodiscard]] virtual Result<std::vector<RigListing>> list() = 0;
    /// The port keeps the transport until close(). NoRig, Busy and Device errors may pass: try
    /// again.
    [[nodiscard]] virtual Result<driver::Transport*> open() = 0;
    virtual void close() = 0;
    /// The recording that is played in a rig's place; null: there is a rig, or may be one. For the
    /// thread that owns the rig.
    [[nodiscard]] virtual const driver::Replay* replay() const { return nullptr; }

    /// Why only jobs may ask the rig; empty: anyone may. From any thread.
    [[nodiscard]] virtual std::string onlyForJobs() const { return {}; }

    /// Why the recording of its traffic has ended before its time, once; empty: it has not.
    [[nodiscard]] virtual std::string takeRecordingEnd() { return {}; }

    /// What lies under the rig: "white", "mirror", a file, ...; empty: only a person knows.
    [[nodiscard]] virtual std::string placed() const = 0;
    /// Puts the mirror on a wedge. False: a person has to do it.
    virtual Result<bool> placeMirror(const proc::Wedge& wedge) = 0;
    /// Says in a file's information where its rig came from.
    virtual void describe(proc::SampleInfo& info) const = 0;
    /// The simulated rig's own door; null for a real one.
    [[nodiscard]] virtual SimPort* simulated() { return nullptr; }
};

}  // namespace gonio::daemon
