// The engine's rig: looked for, claimed, tended, lost and found again.

#include "daemon/engine/engine.h"
#include "daemon/engine/fault_text.h"
#include "driver/replay.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kRetryHeld = 2s;  // held by another, or no permission

}  // namespace

void Engine::connect() {
    if (rig_ || world_.clock.now() < nextTry_) return;
    const Result<void> claimed = claim();
    if (claimed) return;
    const Error& why = claimed.error();
    disconnect();
    advance(EngineEvent::Lost, why.message);
    nextTry_ = world_.clock.now() + (why.kind == ErrorKind::Busy ? kRetryHeld : kRescanning);
    hinder(why);
}

/// `whom` stands before what is said, which is once for each obstacle.
void Engine::hinder(const std::optional<Error>& obstacle, const std::string& whom) {
    const std::string text = obstacle ? obstacle->message : "";
    if (!text.empty() && (!obstacle_ || obstacle_->message != text)) log::warning(whom + text);
    obstacle_ = obstacle;
    publish([&](EngineStatus& status) { status.obstacle = text; });
}

/// Why nothing can be asked of the rig now.
Error Engine::noRig() const {
    const EngineState state = status().state;
    const bool held = obstacle_ && obstacle_->kind == ErrorKind::Busy;
    return {
        state == EngineState::Fault ? ErrorKind::Device
        : held                      ? ErrorKind::Busy
                                    : ErrorKind::NoRig,
        "the rig is " + std::string(name(state)) + (obstacle_ ? ": " + obstacle_->message : "")};
}

Result<void> Engine::claim() {
    const Result<driver::Transport*> transport = port_.open();
    if (!transport) return transport.error();
    const std::string serial = (*transport)->strings().serial;
    publish([&](EngineStatus& status) {
        status.serial = serial;
        status.placed = port_.placed();
    });
    advance(EngineEvent::Appeared);
    // The same number again takes up the claim of a daemon that was killed a moment ago.
    const std::string key = "claim/" + serial;
    const Result<std::string> kept = logbook_.setting(key);
    if (!kept) return kept.error();
    std::uint64_t id = static_cast<std::uint64_t>(parseInteger(*kept).value_or(0));
    if (id == 0) {
        id = world_.randomId();
        const auto set = logbook_.set(key, std::to_string(static_cast<std::int64_t>(id)));
        if (!set) return set.error();
    }
    // The one that the recorded host had, in a recording.
    if (const auto* replay = port_.replay()) id = replay->session().value_or(id);
    auto rig = driver::Rig::open(**transport, id);
    if (!rig) return rig.error();
    rig_.emplace(std::move(*rig));
    rig_->onLost([this](const Error& lost) { return comeBack(lost); });
    rig_->onBack([this] { resume(); });
    publish([&](EngineStatus& status) { status.info = rig_->identify(); });
    hinder({});
    publishCalibrations();
    advance(EngineEvent::Claimed);
    log::info("rig " + serial + " is claimed");
    return {};
}

void Engine::disconnect() {
    rig_.reset();
    port_.close();
    publish([](EngineStatus& status) { status.rig.reset(); });
}

void Engine::lost(const Error& why) {
    disconnect();
    advance(EngineEvent::Lost, why.message);
    hinder(why);
    nextTry_ = world_.clock.now() + kRescanning;
}

/// What the rig has said last; of one that is lost nothing is known.
void Engine::publishRig() {
    if (!rig_) return;
    const driver::RigLink& link = rig_->link();
    const auto said = link.lost() ? std::nullopt : link.status();
    publish([&](EngineStatus& status) { status.rig = said; });
}

/// Feeds the heartbeat, and follows what the rig says of itself. Without a job it is dark.
void Engine::tend() {
    if (!rig_) return connect();
    if (Result<void> there = rig_->keepAlive(); !there) return lost(there.error());
    publishRig();
    const std::optional<driver::Status> said = rig_->link().status();
    if (!said) return;
    if (said->ledOn != 0) {
        if (Result<void> dark = rig_->darken(); !dark) return hinder(dark.error());
        (void)rig_->status();  // else the next look would see this STATUS again
    }
    if (said->state == driver::RigState::Fault) {
        hinder(Error{ErrorKind::Device, explained(said->fault)});
        advance(EngineEvent::FaultSeen, driver::statusName(said->fault));
        // Refused while its cause lasts, and dark afterwards all the same.
        if (!rig_->link().command(driver::Op::ClearFault)) return;
    }
    advance(EngineEvent::FaultCleared);
    if (obstacle_) hinder({});
}

}  // namespace gonio::daemon
