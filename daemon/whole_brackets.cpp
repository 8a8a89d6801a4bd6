#include "daemon/whole_brackets.h"

#include <algorithm>
#include <cmath>

#include "driver/protocol/constants.h"

namespace gonio::daemon {
namespace {

constexpr int kBoots = 3;  // of a rig within one bracket
constexpr std::uint16_t kFullLevel = 65535;
constexpr const char* kAgain = "; the bracket is taken again";

}  // namespace

WholeBrackets::WholeBrackets(driver::Rig& rig,
                             const RigProfile& profile,
                             const std::uint64_t& nextPlanStep,
                             const Attendance& attendance)
    : rig_(rig),
      profile_(profile),
      nextPlanStep_(nextPlanStep),
      attendance_(attendance),
      watch_(profile.noise) {}

Result<void> WholeBrackets::take(std::optional<State> state,
                                 const std::function<Result<void>()>& attempt) {
    open(state);
    std::erase_if(reviewed_, [&](const OddFrame& odd) {
        const bool its = odd.state == state;
        attemptsLike(odd) += its ? 1 : 0;
        return its;
    });
    while (true) {
        isOdd_ = false;
        watch_.begin();
        (void)takeReboot();  // seen since the last bracket: nothing of this one is lost
        Result<void> taken = warmUp(state);
        if (taken) taken = attempt();
        if (taken) return taken;  // of one piece: a boot that was seen after it is the next one's
        if (taken.error().kind == ErrorKind::Interrupted) return taken;  // by whoever asked for it
        if (takeReboot()) {
            const std::string& why = taken.error().message;
            if (++boots_ > kBoots) {
                return Error{ErrorKind::Device,
                             bracketName(state) + ": the rig booted " + std::to_string(boots_) +
                                 " times in one bracket; see to its power supply: " + why};
            }
            tell(Cause::NewBoot, why + kAgain);
            continue;
        }
        if (Result<void> may = mayTakeAgain(taken.error()); !may) return may;
    }
}

void WholeBrackets::open(std::optional<State> state) {
    state_ = state;
    boots_ = oddAttempts_ = unlitAttempts_ = 0;
}

bool WholeBrackets::review(State state, std::span<const Frame> frames) {
    open(state);
    watch_.begin();
    return std::ranges::all_of(frames,
                               [&](const Frame& frame) { return look(state, frame).has_value(); });
}

Result<void> WholeBrackets::mayTakeAgain(const Error& why) {
    if (isOdd_) {
        if (attemptsLike(odd_.back())++ == 0) return {};
        return Error{why.kind,
                     "taken again, and once more not what was asked for: " + why.message + "; " +
                         kOddFramesCure,
                     why.deviceStatus};
    }
    const std::optional<Error> passing = passes(why);
    if (!passing) return why;
    if (Result<void> again = attendance_.suspended(*passing); !again) return again;
    noteBreak();
    tell(Cause::Suspended, why.message + kAgain);
    return {};
}

/// The causes that pass by themselves, or by a person's hand; a broken LED does not. Dark frames do
/// not stop when the interlock opens: they are merely not valid.
std::optional<Error> WholeBrackets::passes(const Error& why) {
    using namespace driver::status;
    if (why.deviceStatus == kInterlock || why.deviceStatus == kOverTemp) return why;
    if (why.deviceStatus != 0 || why.kind != ErrorKind::Device) return std::nullopt;
    const Result<driver::Status> now = rig_.status();
    const bool open = now && !driver::interlock::mayLight(now->interlock);
    if (!open) return std::nullopt;
    return Error{why.kind, why.message, kInterlock};
}

Result<void> WholeBrackets::look(std::optional<State> state, const Frame& frame) {
    std::optional<OddFrame> odd = watch_.see(state, frame);
    if (!odd) return {};
    odd->dropped = odd->kind != Cause::Unlit || unlitAttempts_ == 0;
    odd_.push_back(*odd);
    const char* const then = !odd->dropped             ? "; taken for what lies there"
                             : attemptsLike(*odd) == 0 ? kAgain
                                                       : ", once more";
    tell(odd->kind, odd->text() + then);
    if (!odd->dropped) return {};
    isOdd_ = true;
    return Error{ErrorKind::Quality, bracketName(state) + ": " + odd->text()};
}

Result<void> WholeBrackets::warmUp(std::optional<State> state) {
    if (!cold_ || !state || profile_.warmUp <= Seconds(0)) return {};
    const Microseconds exposure = profile_.exposures.back();
    const double period = std::max(Seconds(exposure), Seconds(rig_.identify().framePeriod)).count();
    int left = static_cast<int>(std::ceil(profile_.warmUp.count() / period));
    while (left > 0) {
        const int frames = std::min(left, rig_.identify().maxFrames);
        attendance_.alive();
        const auto lit = rig_.capture({.planStep = nextPlanStep_,
                                       .led = state->led,
                                       .levels = LedLevels::only(state->band, kFullLevel),
                                       .exposure = exposure,
                                       .frames = frames},
                                      {},
                                      [](const Frame&) { return Result<void>(); });
        if (!lit) return lit.error();
        left -= frames;
    }
    cold_ = false;
    return {};
}

std::optional<Error> WholeBrackets::takeReboot() {
    std::optional<Error> reboot = rig_.takeReboot();
    if (reboot) noteBreak();
    return reboot;
}

void WholeBrackets::noteBreak() {
    ++breaks_;
    cold_ = true;
}

void WholeBrackets::tell(Cause cause, const std::string& message) const {
    attendance_.setback({.cause = cause, .bracket = bracketName(state_), .message = message});
}

}  // namespace gonio::daemon
