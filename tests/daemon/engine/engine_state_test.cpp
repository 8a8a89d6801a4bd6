#include "daemon/engine/engine_state.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace gonio::daemon {
namespace {

using enum EngineState;
using enum EngineEvent;

constexpr EngineState kStates[] = {
    Offline, Connecting, Idle, Running, Finishing, Suspended, Interrupted, Fault};
constexpr EngineEvent kEvents[] = {Appeared,
                                   Claimed,
                                   Lost,
                                   JobBegun,
                                   Captured,
                                   JobEnded,
                                   FaultSeen,
                                   FaultCleared,
                                   Hindered,
                                   Resumed};

std::set<EngineState> reachedFrom(EngineState from) {
    std::set<EngineState> reached;
    std::set<EngineState> fresh{from};
    while (!fresh.empty()) {
        const EngineState state = fresh.extract(fresh.begin()).value();
        for (const EngineEvent event : kEvents) {
            const auto to = next(state, event);
            if (to && reached.insert(*to).second) fresh.insert(*to);
        }
    }
    return reached;
}

TEST(EngineState, EachHasANameOfItsOwn) {
    std::set<std::string_view> names;
    for (const EngineState state : kStates) names.insert(name(state));
    EXPECT_EQ(names.size(), std::size(kStates));
    EXPECT_EQ(name(Offline), "offline");
    EXPECT_EQ(name(Fault), "fault");
}

TEST(EngineState, EveryOneIsReachedAndLeadsBackToIdle) {
    EXPECT_EQ(reachedFrom(Offline).size(), std::size(kStates));
    for (const EngineState state : kStates) {
        EXPECT_TRUE(reachedFrom(state).contains(Idle)) << name(state);
    }
}

TEST(EngineState, JobBeginsOnAnIdleRigOnly) {
    for (const EngineState state : kStates) {
        EXPECT_EQ(next(state, JobBegun).has_value(), state == Idle) << name(state);
    }
}

TEST(EngineState, RigThatIsThereCanBeLost) {
    for (const EngineState state : kStates) {
        const bool there = state != Offline && state != Interrupted;
        EXPECT_EQ(next(state, Lost).has_value(), there) << name(state);
    }
    EXPECT_EQ(next(Running, Lost), Interrupted);
    EXPECT_EQ(next(Idle, Lost), Offline);
}

TEST(EngineState, LostRigIsClaimedAgainBeforeItIsIdle) {
    EXPECT_EQ(next(Interrupted, Appeared), Connecting);
    EXPECT_EQ(next(Connecting, Claimed), Idle);
    EXPECT_FALSE(next(Interrupted, Claimed));
    EXPECT_EQ(next(Interrupted, JobEnded), Offline) << "a job's end does not bring a rig back";
}

TEST(EngineState, JobGoesOnWhenItsRigIsBackOrMayLightAgain) {
    EXPECT_EQ(next(Running, Hindered), Suspended);
    EXPECT_EQ(next(Suspended, Resumed), Running);
    EXPECT_EQ(next(Interrupted, Resumed), Running);
    EXPECT_EQ(next(Suspended, Lost), Interrupted);
    EXPECT_EQ(next(Suspended, JobEnded), Idle) << "cancelled: the rig's fault shows by itself";
    for (const EngineState state : kStates) {
        EXPECT_EQ(next(state, Hindered).has_value(), state == Running) << name(state);
    }
}

TEST(EngineState, FaultEndsWhenItsCauseIsGone) {
    EXPECT_EQ(next(Fault, FaultCleared), Idle);
    EXPECT_FALSE(next(Idle, FaultCleared)) << "what cannot happen changes nothing";
    EXPECT_FALSE(next(Fault, JobBegun));
}

}  // namespace
}  // namespace gonio::daemon
