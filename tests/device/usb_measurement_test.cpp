// A measurement through the real USB code: the brackets of all states, each
// frame equal to the in-process door's.

#include <sys/resource.h>

#include <iostream>

#include "daemon/measurement.h"
#include "daemon/sequencer.h"
#include "tests/daemon/bracket_of.h"
#include "tests/device/usb_rig_fixture.h"
#include "tests/support/wait_until.h"

namespace gonio::device_test {
namespace {

double cpuSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// A rig and what a measurement needs of it.
struct Measuring {
    driver::Rig rig;
    std::uint64_t nextPlanStep = 1;
    daemon::Sequencer sequencer;

    Measuring(driver::Rig opened, const daemon::RigProfile& profile)
        : rig(std::move(opened)), sequencer(rig, profile, nextPlanStep) {}
};

/// Time and processor time of the real rig's part alone.
struct Cost {
    double seconds = 0, cpu = 0;
    template <class Work>
    auto of(Work work) {
        const auto begin = std::chrono::steady_clock::now();
        const double cpuBegin = cpuSeconds();
        auto result = work();
        cpu += cpuSeconds() - cpuBegin;
        seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return result;
    }
};

TEST_F(UsbRigTest, AMeasurementOfTwelveStatesIsThatOfTheInProcessDoor) {
    const auto profile = daemon::readProfile(daemon::defaultProfile());
    ASSERT_TRUE(profile) << profile.error().message;
    sim::InProcessDoor door(rigConfig());
    door.device().place(mattGrey());
    auto twinRig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(twinRig);
    Measuring twin(std::move(*twinRig), *profile);
    const auto window = daemon::configureWindow(twin.rig);
    ASSERT_TRUE(window) << window.error().message;
    const daemon::BracketPlan plan = {.longest = 4};
    const auto states = twin.sequencer.states();
    ASSERT_EQ(states.size(), 12U);
    const auto next = [&](std::size_t state) {
        return state + 1 < states.size() ? std::optional(states[state + 1]) : std::nullopt;
    };
    // All of the twin's first: the real rig would wait for it without a heartbeat.
    std::vector<std::vector<Frame>> wanted;
    for (std::size_t state = 0; state < states.size(); ++state) {
        auto frames = daemon::test::bracketOf(twin.sequencer, states[state], plan, next(state));
        ASSERT_TRUE(frames) << frames.error().message;
        wanted.push_back(std::move(*frames));
    }

    mock.live().warmUp(*window);
    const auto transport = opened();
    ASSERT_TRUE(transport);
    auto realRig = driver::Rig::open(*transport, kSession);
    ASSERT_TRUE(realRig) << realRig.error().message;
    Measuring real(std::move(*realRig), *profile);
    ASSERT_TRUE(real.rig.configure(*window));

    Cost cost;
    std::size_t frames = 0;
    for (std::size_t state = 0; state < states.size(); ++state) {
        const auto seen = cost.of([&] {
            return daemon::test::bracketOf(real.sequencer, states[state], plan, next(state));
        });
        ASSERT_TRUE(seen) << seen.error().message;
        ASSERT_TRUE(real.rig.keepAlive());
        ASSERT_EQ(seen->size(), wanted[state].size());
        for (std::size_t i = 0; i < seen->size(); ++i) {
            ASSERT_EQ((*seen)[i].captureId, wanted[state][i].captureId);
            ASSERT_EQ((*seen)[i].pixels, wanted[state][i].pixels) << "frame " << i;
        }
        frames += seen->size();
    }
    EXPECT_EQ(real.rig.anomalies(), driver::Anomalies{});
    expectCleanReports(real.rig.link().counters());
    std::cout << frames << " frames in " << cost.seconds << " s, " << cost.cpu
              << " s of processor time (rig and USB bus simulated in them)\n";
}

}  // namespace
}  // namespace gonio::device_test
