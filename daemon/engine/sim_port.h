#pragma once
// The simulated rig, in this process and in virtual time, and its own door: what lies under it. The
// rig is kept in the store's sim.json over restarts. It is there, with its fault script and what
// lies under it, whether the port is open or not, until another rig is asked for. While it is
// looked for, its time goes on from look to look, as far as the looks are apart. Another rig at its
// cable is refused, and both serial numbers are named.

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "daemon/engine/rig_port.h"
#include "daemon/sim_bench.h"

namespace gonio::daemon {

/// Empty members are kept as they are.
struct PlaceRequest {
    std::string what;  ///< black, white, zero, mirror, nothing, an absolute path, model: or sample:
    double tiltXDegrees = 0;  ///< turns the surface about x
    double tiltYDegrees = 0;
    double wavinessDegrees = 0;  ///< this and the next four: sim/sample_errors.h
    double translucency = 0;
    std::string backing = "black";  ///< or white
    double softness = 0;
    double ambient = 0;
    double turnedDegrees = 0;  ///< white or sample: about its normal
    std::optional<std::uint64_t> seed{};
    std::optional<std::string> serial{};
    std::optional<std::string> systematic{};  ///< none, random, or stratum:K
    std::optional<std::string> rigErrors{};   ///< sim/rig_errors.h
};

/// Usage error for what can never be placed.
[[nodiscard]] Result<void> check(const PlaceRequest& request);
/// Usage error unless a simulated rig may be called this.
[[nodiscard]] Result<void> checkSerial(const std::string& serial);

class SimPort : public RigPort {
public:
    /// `cameraUsb`: 2 or 3, the bus that the rig profile's camera is on.
    [[nodiscard]] static Result<std::unique_ptr<SimPort>> open(const std::filesystem::path& store,
                                                               int cameraUsb = 2);

    [[nodiscard]] std::string_view kind() const override { return "sim"; }
    [[nodiscard]] Result<std::vector<RigListing>> list() override;
    [[nodiscard]] Result<driver::Transport*> open() override;
    void close() override { open_ = false; }
    [[nodiscard]] std::string placed() const override { return state_.placed; }
    Result<bool> placeMirror(const proc::Wedge& wedge) override;
    void describe(proc::SampleInfo& info) const override;
    [[nodiscard]] SimPort* simulated() override { return this; }

    /// What goes wrong from the next opening on.
    void play(sim::FaultScript script) { faults_ = std::move(script); }
    /// True: it is another rig from now on, and has to be opened anew. Whatever is wrong with what
    /// is to be placed is said at once, and the rig stays as it was.
    Result<bool> place(const PlaceRequest& request);

private:
    SimPort(Store store, SimState state, int cameraUsb)
        : store_(std::move(store)), state_(std::move(state)), cameraUsb_(cameraUsb) {}
    void adopt(SimState state);
    [[nodiscard]] Result<std::unique_ptr<sim::InProcessDoor>> lookAgain();

    Store store_;
    SimState state_;
    int cameraUsb_;
    std::mutex mutex_;                          ///< of the serial number, which list() reads
    std::optional<sim::FaultScript> faults_;    ///< not played yet
    std::unique_ptr<sim::InProcessDoor> door_;  ///< the last one to the rig; empty: there was none
    bool open_ = false;
    bool another_ = false;  ///< the next opening is another rig's
};

}  // namespace gonio::daemon
