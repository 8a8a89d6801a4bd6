#include "sim/faults/fault_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/random.h"

namespace gonio::sim {
namespace {

using Kind = FaultMoment::Kind;

Nanoseconds nanoseconds(double seconds) {
    return Nanoseconds(static_cast<std::int64_t>(std::llround(seconds * 1e9)));
}

double within(const FaultRange& range, double u) {
    return range.low + u * (range.high - range.low);
}

/// A whole number, each as likely as the others.
double wholeWithin(const FaultRange& range, double u) {
    return std::min(range.high, range.low + std::floor(u * (range.high - range.low + 1)));
}

// What a number is drawn for.
enum Drawing : std::uint64_t {
    kMoment,
    kFrame,
    kChance,
    kChoice,
    kCount,
    kTime,
    kLasting,
    kKey
};

}  // namespace

FaultPlayer::FaultPlayer(FaultScript script, Nanoseconds start)
    : script_(std::move(script)), states_(script_.rules.size()) {
    for (std::size_t i = 0; i < states_.size(); ++i) {
        const FaultMoment& when = script_.rules[i].when;
        if (when.kind == Kind::Period) {
            nextPeriod(i, start);
        } else if (when.kind == Kind::Time) {
            const double at = within(when.value, draw(i, 0, kMoment));
            agenda_.emplace(start + nanoseconds(at), Entry{.fault = {}, .rule = i});
        }
        states_[i].wanted = wholeWithin(when.value, draw(i, 0, kMoment));
        if (when.ofFrame) states_[i].ofFrame = wholeWithin(*when.ofFrame, draw(i, 0, kFrame));
    }
}

double FaultPlayer::draw(std::size_t rule, std::uint64_t occurrence, std::uint64_t what) const {
    return uniform(mixed(mixed(script_.seed, rule), what), occurrence);
}

void FaultPlayer::nextPeriod(std::size_t rule, Nanoseconds from) {
    const auto turn = static_cast<std::uint64_t>(states_[rule].seen++);
    const double period = within(script_.rules[rule].when.value, draw(rule, turn, kMoment));
    agenda_.emplace(from + nanoseconds(period), Entry{.fault = {}, .rule = rule});
}

DueFault FaultPlayer::fired(std::size_t rule) {
    const auto turn = static_cast<std::uint64_t>(states_[rule].fired++);
    const std::vector<Fault>& faults = script_.rules[rule].faults;
    const FaultRange choices{0, static_cast<double>(faults.size() - 1)};
    const double choice = wholeWithin(choices, draw(rule, turn, kChoice));
    const Fault& fault = faults[static_cast<std::size_t>(choice)];
    DueFault due{.kind = fault.kind,
                 .count = static_cast<int>(wholeWithin(fault.count, draw(rule, turn, kCount))),
                 .time = nanoseconds(within(fault.time, draw(rule, turn, kTime))),
                 .name = fault.name,
                 .key = mixed(mixed(mixed(script_.seed, rule), kKey), turn)};
    if (fault.lasting)
        due.lasting = nanoseconds(within(*fault.lasting, draw(rule, turn, kLasting)));
    return due;
}

Nanoseconds FaultPlayer::next() const {
    return agenda_.empty() ? Nanoseconds::max() : agenda_.begin()->first;
}

std::optional<DueFault> FaultPlayer::timed(Nanoseconds now) {
    if (next() > now) return std::nullopt;
    const auto [when, entry] = *agenda_.begin();
    agenda_.erase(agenda_.begin());
    if (entry.rule == kNoRule) return entry.fault;
    if (script_.rules[entry.rule].when.kind == Kind::Period) nextPeriod(entry.rule, when);
    return fired(entry.rule);
}

void FaultPlayer::takeEnds(const FaultPlayer& other) {
    for (const auto& [when, entry] : other.agenda_)
        if (entry.rule == kNoRule && entry.fault.isEnd) agenda_.emplace(when, entry);
}

bool FaultPlayer::lucky(State& state) {
    const auto rule = static_cast<std::size_t>(&state - states_.data());
    const auto turn = static_cast<std::uint64_t>(state.seen++);
    return draw(rule, turn, kChance) < script_.rules[rule].when.chance;
}

template <class Matches>
std::vector<DueFault> FaultPlayer::matching(Matches matches) {
    std::vector<DueFault> due;
    for (std::size_t i = 0; i < states_.size(); ++i) {
        const FaultMoment& when = script_.rules[i].when;
        if (matches(when, states_[i])) due.push_back(fired(i));
    }
    return due;
}

std::vector<DueFault> FaultPlayer::chunkSent(const Place& place) {
    ++chunks_;
    return matching([&](const FaultMoment& when, State& state) {
        if (when.kind == Kind::PerChunk) return lucky(state);
        if (when.kind != Kind::Chunk) return false;
        if (!when.ofFrame) return state.wanted == chunks_;
        const bool here = state.ofFrame == place.frame && state.wanted == place.chunk;
        return here && state.fired == 0;
    });
}

std::vector<DueFault> FaultPlayer::frameSent() {
    ++frames_;
    return matching([&](const FaultMoment& when, const State& state) {
        return when.kind == Kind::FrameSent && state.wanted == frames_;
    });
}

std::vector<DueFault> FaultPlayer::exposureBegins() {
    ++exposures_;
    return matching([&](const FaultMoment& when, State& state) {
        if (when.kind == Kind::PerExposure) return lucky(state);
        return when.kind == Kind::Exposure && state.wanted == exposures_;
    });
}

std::vector<DueFault> FaultPlayer::commands(FaultMoment::Kind kind, driver::Op op) {
    return matching([&](const FaultMoment& when, State& state) {
        if (when.kind == Kind::PerCommand) return kind == Kind::OnCommand && lucky(state);
        if (when.kind != kind || (when.op && *when.op != op)) return false;
        return state.wanted == ++state.seen;
    });
}

std::vector<DueFault> FaultPlayer::onCommand(driver::Op op) {
    return commands(Kind::OnCommand, op);
}

std::vector<DueFault> FaultPlayer::afterCommand(driver::Op op) {
    return commands(Kind::AfterCommand, op);
}

}  // namespace gonio::sim
