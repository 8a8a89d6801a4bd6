#include "sim/claim.h"

namespace gonio::sim {

using namespace driver;  // the wire's words

namespace {

constexpr std::size_t kStoredAcks = 8;

}  // namespace

SessionState Claim::state(std::uint16_t statusOfLastSet) const {
    return {.sessionId = id_,
            .heartbeatMs = static_cast<std::uint16_t>(heartbeat_.count() / 1'000'000),
            .hostMinor = hostMinor_,
            .statusOfLastSet = statusOfLastSet,
            .lastCommand = lastCommand_,
            .owner = owner_};
}

void Claim::renew(const SessionSet& set, Nanoseconds now) {
    id_ = set.sessionId;
    owner_ = Owner::Alive;
    heartbeat_ = std::chrono::milliseconds(set.heartbeatMs);
    hostMinor_ = set.hostMinor;
    fed_ = now;
}

bool Claim::owns(const Command& command) const { return alive() && command.sessionLow == lowId(); }

std::optional<Claim::Answer> Claim::answerOf(const Command& command) const {
    const auto refused = [&](std::uint16_t status) {
        return Answer{.ack = {.sequence = command.sequence,
                              .op = command.op,
                              .status = status,
                              .sessionLow = command.sessionLow}};
    };
    if (!owns(command)) return refused(status::kNotOwner);
    for (const auto& [before, answer] : stored_) {
        if (before.sequence != command.sequence) continue;
        if (before == command) return Answer{.ack = answer, .replayed = true};
        return refused(status::kBadSeq);
    }
    const auto ahead = static_cast<std::uint16_t>(command.sequence - lastCommand_);
    if (command.sequence == 0 || ahead == 0 || ahead > 32767) return refused(status::kBadSeq);
    return std::nullopt;
}

void Claim::keep(const Command& command, const Ack& ack) {
    lastCommand_ = command.sequence;
    stored_.emplace_back(command, ack);
    if (stored_.size() > kStoredAcks) stored_.pop_front();
}

Ack Claim::newest() const { return stored_.empty() ? Ack{.op = Op{}} : stored_.back().second; }

}  // namespace gonio::sim
