#include "daemon/alongside.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "driver/steady_clock.h"
#include "tests/driver/scripted_rig.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;
using driver::Op;

/// A scripted rig whose deadlines are the computer's.
class RealTimeRig : public driver::test::ScriptedRig {
public:
    [[nodiscard]] const gonio::Clock& clock() const override { return steady_; }

private:
    driver::SteadyClock steady_;
};

class AlongsideTest : public testing::Test {
protected:
    void SetUp() override {
        auto opened = driver::Rig::open(device, {.sessionId = 7, .heartbeatMs = 500});
        ASSERT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
    }
    template <class Task>
    auto beside(Task task) {
        return alongside(
            *rig, [this] { ++waits; }, std::move(task));
    }
    RealTimeRig device;
    std::optional<driver::Rig> rig;
    int waits = 0;
};

TEST_F(AlongsideTest, GivesTheTasksValue) {
    const Result<int> value = beside([] { return 42; });
    ASSERT_TRUE(value);
    EXPECT_EQ(*value, 42);
    const Result<std::string> result = beside([] { return Result<std::string>("ok"); });
    EXPECT_EQ(*result, "ok");
    bool done = false;
    const Result<void> nothing = beside([&] { done = true; });
    EXPECT_TRUE(nothing && done);
}

TEST_F(AlongsideTest, TaskMayOwnWhatCanOnlyBeMoved) {
    auto owned = std::make_unique<int>(5);
    const auto value = beside([owned = std::move(owned)] { return *owned; });
    EXPECT_EQ(*value, 5);
}

TEST_F(AlongsideTest, ErrorsAndExceptionsAreErrors) {
    const Result<void> refused = beside([]() -> Result<void> {
        return Error{ErrorKind::Quality, "too dark"};
    });
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Quality);
    const Result<int> thrown = beside([]() -> int { throw std::runtime_error("no memory"); });
    ASSERT_FALSE(thrown);
    EXPECT_EQ(thrown.error().kind, ErrorKind::Internal);
    EXPECT_NE(thrown.error().message.find("no memory"), std::string::npos);
}

TEST_F(AlongsideTest, KeepsTheRigAliveMeanwhile) {
    const auto value = beside([] {
        std::this_thread::sleep_for(900ms);
        return 1;
    });
    EXPECT_TRUE(value);
    // Each 200 ms, and the link sends one when a fifth of the heartbeat has passed.
    EXPECT_GE(device.count(Op::Ping), 2);
    EXPECT_GE(waits, 2) << "and whoever watches the waiting";
}

TEST_F(AlongsideTest, ALostRigDoesNotCostTheValue) {
    device.deaf = true;
    const auto value = beside([] {
        std::this_thread::sleep_for(500ms);
        return 1;
    });
    EXPECT_TRUE(value);
    EXPECT_FALSE(rig->darken()) << "but the next call says so";
}

TEST_F(AlongsideTest, OnlyTheTaskRunsInTheOtherThread) {
    const auto here = std::this_thread::get_id();
    const auto there = beside([] { return std::this_thread::get_id(); });
    EXPECT_NE(*there, here);
}

TEST_F(AlongsideTest, DestructionWaitsForTheTask) {
    std::atomic<bool> done = false;
    {
        const Alongside task([&] {
            std::this_thread::sleep_for(50ms);
            done = true;
        });
    }
    EXPECT_TRUE(done);
}

}  // namespace
}  // namespace gonio::daemon
