#include "daemon/then_dark.h"

#include <gtest/gtest.h>

#include "tests/daemon/engine/running_engine.h"
#include "tests/daemon/engine/test_rig.h"

namespace gonio::daemon {
namespace {

/// A bench on a simulated rig whose owner counts how often it is asked to bring the rig back.
struct CountingBench {
    CountingBench() {
        auto opened = driver::Rig::open(cable, 0x1122334455667788);
        EXPECT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
        rig->onLost([this](const Error& lost) -> Result<driver::Transport*> {
            ++asked;
            return lost;
        });
    }
    [[nodiscard]] Result<int> thenDark(const Result<int>& measured) {
        const RigProfile profile;
        const test::TurnedClock clock;
        const Bench bench{.rig = *rig,
                          .profile = profile,
                          .nextPlanStep = nextPlanStep,
                          .clock = clock,
                          .attendance = {.captured = [this] { ++captured; }}};
        return daemon::thenDark(bench, measured);
    }

    test::Cable cable;
    std::optional<driver::Rig> rig;
    std::uint64_t nextPlanStep = 1;
    int asked = 0, captured = 0;
};

TEST(ThenDark, NobodyWaitsForARigThatIsLost) {
    CountingBench bench;
    bench.cable.pull();
    EXPECT_FALSE(bench.rig->keepAlive());
    ASSERT_EQ(bench.asked, 1);
    const Result<int> failed = bench.thenDark(Error{ErrorKind::Quality, "no spot"});
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "no spot");
    EXPECT_EQ(bench.captured, 0);
    EXPECT_EQ(*bench.thenDark(7), 7);
    EXPECT_EQ(bench.captured, 1);
    EXPECT_EQ(bench.asked, 1);
}

TEST(ThenDark, OneThatWillNotGoDarkIsToldOfAndCostsNothing) {
    CountingBench bench;
    const auto told = [&] {
        testing::internal::CaptureStderr();
        EXPECT_EQ(*bench.thenDark(7), 7);
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(told(), "");
    bench.cable.refuseDarkeningAfter(0);
    EXPECT_NE(told().find("darken"), std::string::npos);
    EXPECT_TRUE(bench.cable.hasRefused());
}

}  // namespace
}  // namespace gonio::daemon
