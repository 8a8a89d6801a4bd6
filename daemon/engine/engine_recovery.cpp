// A job goes on: after its rig was lost, once the same one is there again, and after it would not
// light, once it may.

#include "daemon/engine/engine.h"
#include "daemon/engine/fault_text.h"
#include "daemon/engine/monitor.h"
#include "driver/replay.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;

constexpr auto kPause = 100ms;  // between two looks at a clock, a wish and a rig

/// Without patience nobody has waited.
Error gaveUp(const Error& why, Seconds patience) {
    if (patience <= Seconds(0)) return why;
    return {
        why.kind, why.message + "; waited " + fixed(patience.count(), 0) + " s", why.deviceStatus};
}

}  // namespace

/// Nothing comes from a recording that is over, or that was left: why the job ends here.
std::optional<Error> Engine::recordingEnded(const Error& lost) const {
    const driver::Replay* replay = port_.replay();
    const auto end = replay ? replay->end() : std::nullopt;
    if (!end) return std::nullopt;
    if (lost.message.find(end->message) != std::string::npos) return lost;
    return Error{lost.kind, lost.message + "; " + end->message, lost.deviceStatus};
}

/// Or until somebody wants the job to end.
void Engine::pause() {
    std::unique_lock lock(mutex_);
    asked_.wait_for(lock, kPause, [&] { return wish_ == Wish::Cancel; });
}

/// Outside of a job nobody waits: the owner looks for it again by itself. Asked again within one
/// gap, with the reason, when what was found could not be taken up.
Result<driver::Transport*> Engine::comeBack(const Error& lost) {
    if (monitor_ == nullptr || !monitor_->needsRig()) return lost;
    if (const auto ended = recordingEnded(lost)) return *ended;
    const bool first = !lostAt_;
    if (first) lostAt_ = world_.clock.now();
    if (!patientSince(*lostAt_)) return gaveUp(lost, world_.patience);
    port_.close();
    publish([](EngineStatus& status) { status.rig.reset(); });
    hinder(lost, first ? monitor_->job() + " waits for the rig: " : "");
    advance(EngineEvent::Lost, lost.message);
    while (patientSince(*lostAt_)) {
        world_.alive();
        if (Result<void> on = monitor_->goOn(); !on) return on.error();
        if (world_.clock.now() >= nextTry_) {
            Result<driver::Transport*> there = lookAgain();
            if (there) return there;
            hinder(there.error());
            if (const auto ended = recordingEnded(lost)) return *ended;
        }
        pause();
    }
    return gaveUp(lost, world_.patience);
}

/// The rig itself refuses another boot's or another host's claim; it is lost again then.
Result<driver::Transport*> Engine::lookAgain() {
    nextTry_ = world_.clock.now() + kRescanning;
    Result<driver::Transport*> there = port_.open();
    if (!there) return there;
    const std::string wanted = status().serial, found = (*there)->strings().serial;
    if (found != wanted) {
        port_.close();
        return Error{
            ErrorKind::NoRig,
            "the job is on rig " + wanted + ", refused is " + found + ": plug the first in again"};
    }
    return there;
}

/// The rig has been taken up again, or may light again.
void Engine::resume() {
    lostAt_.reset();
    advance(EngineEvent::Resumed);
    hinder({});
}

Result<void> Engine::awaitLight(const Error& why) {
    const Nanoseconds since = world_.clock.now();
    if (monitor_ == nullptr || !patientSince(since)) return why;
    const std::string wanted = explained(static_cast<std::uint16_t>(why.deviceStatus));
    while (patientSince(since)) {
        hinder(Error{ErrorKind::Device, wanted, why.deviceStatus}, monitor_->job() + " waits: ");
        advance(EngineEvent::Hindered, wanted);  // also after it was lost meanwhile
        world_.alive();
        if (Result<void> on = monitor_->goOn(); !on) return on;
        const Result<bool> may = mayLight();
        if (!may) return may.error();
        if (*may) {
            resume();
            return {};
        }
        pause();
    }
    return gaveUp(why, world_.patience);
}

/// Its cause is gone, and the fault is cleared.
Result<bool> Engine::mayLight() {
    if (Result<void> there = rig_->keepAlive(); !there) return there.error();
    const Result<driver::Status> said = rig_->status();
    if (!said) return false;  // lost: the next look finds it again, or not
    publishRig();
    if (!driver::interlock::mayLight(said->interlock)) return false;
    if (said->state != driver::RigState::Fault) return true;
    return rig_->link().command(driver::Op::ClearFault).has_value();
}

}  // namespace gonio::daemon
