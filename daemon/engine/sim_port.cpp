#include "daemon/engine/sim_port.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/optics/cell_grid.h"
#include "sim/light.h"
#include "sim/pose.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

constexpr double kSteepestDegrees = 30;
constexpr std::size_t kLongestSerial = 32;

Error refused(const std::string& what) { return {ErrorKind::Usage, "sim place: " + what}; }

sim::SampleErrors sampleErrorsOf(const PlaceRequest& request) {
    return {.waviness = Radians::fromDegrees(request.wavinessDegrees),
            .translucency = request.translucency,
            .backing = request.backing == "white" ? sim::Backing::White : sim::Backing::Black,
            .softness = request.softness,
            .ambient = request.ambient};
}

/// What can be wrong with this sample, or what can be done to this reference.
Result<void> checkErrors(const PlaceRequest& request) {
    for (const double tilt : {request.tiltXDegrees, request.tiltYDegrees}) {
        if (!(std::abs(tilt) <= kSteepestDegrees)) {
            return refused("a tilt of " + shortest(tilt) + ", wanted -30 to 30 degrees");
        }
        if (tilt != 0 && request.what != "mirror" && isReference(request.what)) {
            return refused("only the mirror or a sample can be tilted");
        }
    }
    if (!(std::abs(request.turnedDegrees) <= 180)) {
        return refused("turned by " + shortest(request.turnedDegrees) +
                       ", wanted -180 to 180 degrees");
    }
    if (request.turnedDegrees != 0 && request.what != "white" && isReference(request.what)) {
        return refused("only the white or a sample can be turned");
    }
    if (request.backing != "black" && request.backing != "white") {
        return refused("backing '" + request.backing + "': wanted black or white");
    }
    if (Result<void> good = sim::check(sampleErrorsOf(request)); !good) {
        return good.error().in("sim place");
    }
    const bool flawed =
        request.wavinessDegrees != 0 || request.translucency != 0 || request.softness != 0;
    if (flawed && isReference(request.what)) {
        return refused("only a sample can be wavy, translucent or soft");
    }
    if (!request.rigErrors) return {};
    const auto rig = sim::parseRigErrors(*request.rigErrors, {});
    return rig ? Result<void>() : rig.error().in("sim place");
}

/// Light on a surface that does not lie flat comes from other directions than the LEDs': a table
/// must know something of each, unless it comes from below its horizon.
Result<void> checkLit(const sim::Placement& placement, std::uint64_t seed) {
    const auto spots = sim::waves(seed, placement.errors.waviness);
    for (int led = 0; led < sim::kLeds; ++led) {
        const sim::Pose pose(
            placement.wedge, spots[static_cast<std::size_t>(led)], placement.turned);
        const Direction in = pose.seenFromSurface(sim::ledDirection(led));
        if (!in.aboveHorizon()) continue;  // it does not light it, whatever it is
        const auto answers = [&](std::size_t cell) {
            const Direction out = proc::CellGrid::centre(cell);
            return placement.surface->answer({.in = in, .out = out}).present();
        };
        std::size_t cell = 0;
        while (cell < proc::CellGrid::count() && !answers(cell)) ++cell;
        if (cell < proc::CellGrid::count()) continue;
        return refused(
            "tilted, wavy or turned, LED " + std::to_string(led) + " is " +
            fixed(in.theta().degrees(), 2) + " degrees from its normal, at azimuth " +
            fixed(in.phi().degrees(), 2) +
            ", of which the file says nothing; place a model: or a table that answers there");
    }
    return {};
}

/// What will name the same thing after the store has changed.
Result<std::string> lastingName(const std::string& what, Store& store) {
    constexpr std::string_view kSample = "sample:";
    if (!what.starts_with(kSample)) return what;
    const auto record = store.sample(what.substr(kSample.size()));
    if (!record) return record.error();
    return fs::absolute(record->file).string();
}

}  // namespace

Result<void> check(const PlaceRequest& request) {
    if (Result<void> good = checkErrors(request); !good) return good;
    const bool named = isReference(request.what) || request.what.starts_with("model:") ||
                       request.what.starts_with("sample:") || fs::path(request.what).is_absolute();
    if (!named) {
        return refused(
            "'" + request.what +
            "': wanted black, white, zero, mirror, nothing, model:SPEC, sample:NAME or an "
            "absolute path");
    }
    const auto called = request.serial ? checkSerial(*request.serial) : Result<void>();
    return called ? called : called.error().in("sim place");
}

Result<void> checkSerial(const std::string& serial) {
    const bool printable =
        std::all_of(serial.begin(), serial.end(), [](char c) { return c > ' ' && c <= '~'; });
    if (printable && !serial.empty() && serial.size() <= kLongestSerial) return {};
    return Error{ErrorKind::Usage,
                 "a serial number has 1 to 32 printable ASCII characters and no blanks"};
}

Result<std::unique_ptr<SimPort>> SimPort::open(const fs::path& root, int cameraUsb) {
    Result<Store> store = Store::open(root);
    if (!store) return store.error();
    Result<SimState> state = readSimState(*store);
    if (!state) return state.error();
    return std::unique_ptr<SimPort>(new SimPort(std::move(*store), std::move(*state), cameraUsb));
}

Result<std::vector<RigListing>> SimPort::list() {
    const std::scoped_lock lock(mutex_);
    return std::vector<RigListing>{{.kind = "sim",
                                    .serial = state_.serial,
                                    .place = {},
                                    .protocol = "GRP/1.0",
                                    .obstacle = {}}};
}

/// At the cable, where time has passed since the last look.
Result<std::unique_ptr<sim::InProcessDoor>> SimPort::lookAgain() {
    sim::FaultyUsb& usb = door_->usb();
    usb.advanceTo(usb.now() + kRescanning);
    auto door = door_->openAgain();
    if (!door) return door;
    const std::string found = (*door)->strings().serial;
    if (found == state_.serial) return door;
    return Error{ErrorKind::NoRig,
                 "rig " + state_.serial + " is not there; refused is " +
                     (found.empty() ? "one without a serial number" : found) +
                     ": plug the first in again"};
}

Result<driver::Transport*> SimPort::open() {
    const bool again = door_ != nullptr && !another_;
    auto door = again ? lookAgain() : openSim(state_, store_, cameraUsb_);
    if (!door) return door.error();
    door_ = std::move(*door);
    another_ = false;
    open_ = true;
    if (faults_) door_->usb().play(*std::exchange(faults_, std::nullopt));
    return door_.get();
}

Result<bool> SimPort::placeMirror(const proc::Wedge& wedge) {
    if (!open_) return Error{ErrorKind::NoRig, "the simulated rig is not open"};
    door_->device().place(
        {.role = sim::Role::Mirror, .surface = nullptr, .wedge = {wedge.aboutX, wedge.aboutY}});
    return true;
}

void SimPort::describe(proc::SampleInfo& info) const { daemon::describe(state_, info); }

void SimPort::adopt(SimState state) {
    const std::scoped_lock lock(mutex_);
    state_ = std::move(state);
}

Result<bool> SimPort::place(const PlaceRequest& request) {
    if (Result<void> good = check(request); !good) return good.error();
    SimState next = state_;
    if (request.seed) next.seed = *request.seed;
    if (request.serial) next.serial = *request.serial;
    if (request.systematic) next.systematic = *request.systematic;
    if (request.rigErrors) next.rigErrors = *request.rigErrors;
    Result<std::string> placed = lastingName(request.what, store_);
    if (!placed) return placed.error();
    next.placed = std::move(*placed);
    next.wedge = {.aboutX = Radians::fromDegrees(request.tiltXDegrees),
                  .aboutY = Radians::fromDegrees(request.tiltYDegrees)};
    next.turned = Radians::fromDegrees(request.turnedDegrees);
    next.sampleErrors = sampleErrorsOf(request);
    const bool another = next.seed != state_.seed || next.serial != state_.serial ||
                         next.systematic != state_.systematic || next.rigErrors != state_.rigErrors;
    if (another) {  // opening it now tells at once what is wrong with it
        if (const auto door = openSim(next, store_, cameraUsb_); !door) return door.error();
    }
    Result<sim::Placement> placement = makePlacement(next, store_);
    if (!placement) return placement.error();
    const bool flat =
        next.wedge.flat() && next.sampleErrors.waviness == Radians() && next.turned == Radians();
    if (!flat && placement->role == sim::Role::Sample) {
        if (Result<void> lit = checkLit(*placement, next.seed); !lit) return lit.error();
    }
    if (Result<void> kept = writeSimState(store_, next); !kept) return kept.error();
    adopt(std::move(next));
    another_ = another_ || another;
    if (door_ != nullptr && !another_) door_->device().place(std::move(*placement));
    return another;
}

}  // namespace gonio::daemon
