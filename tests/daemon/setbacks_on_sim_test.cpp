// Brackets on a simulated rig that goes wrong by a script, in virtual time: what comes of them is
// what an undisturbed rig gives, and each fault is told by its cause.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "daemon/frame_watch.h"
#include "daemon/sequencer.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"

namespace gonio::daemon {
namespace {

using namespace std::chrono_literals;

constexpr Window kWindow{.x = 512, .y = 384, .size = {256, 256}};
constexpr State kFirst{1, Band::G}, kSecond{2, Band::R};

sim::Placement sample(const std::string& model) {
    return {.role = sim::Role::Sample, .surface = std::move(*proc::makeModel(model)), .wedge = {}};
}
sim::Placement matt(const std::string& albedo) { return sample("lambert,albedo=" + albedo); }

/// A rig with a surface under it, a matt grey at first, whose light does not drift.
class Bed {
public:
    explicit Bed(const std::string& script = {}) : Bed(matt("0.5"), script) {}
    explicit Bed(sim::Placement placement, const std::string& script = {}) {
        auto known = readProfile(defaultProfile());
        EXPECT_TRUE(known) << known.error().message;
        profile = std::move(*known);
        first.device().place(std::move(placement));
        auto opened = driver::Rig::open(first, 7);
        EXPECT_TRUE(opened) << opened.error().message;
        rig.emplace(std::move(*opened));
        rig->onLost([this](const Error& lost) { return comeBack(lost); });
        EXPECT_TRUE(rig->configure(kWindow));
        auto faults = sim::FaultScript::parse(script);
        EXPECT_TRUE(faults) << faults.error().message;
        first.usb().play(std::move(*faults));
    }

    /// Two states of four exposures of two frames.
    Result<void> take() {
        Sequencer sequencer(*rig, profile, nextPlanStep, attendance);
        if (darks) sequencer.watch().expect(*darks, white);
        std::vector<KnownShot> shots;
        for (const State state : {kFirst, kSecond}) {
            for (const Microseconds exposure : {80us, 320us, 160us, 640us})
                shots.push_back({.state = state,
                                 .shot = {.level = 1, .exposure = exposure},
                                 .frames = 2,
                                 .joins = exposure != 80us});
        }
        auto taken = sequencer.take(shots,
                                    {.frame = [&](std::size_t shot, Frame&& frame) -> Result<void> {
                                         boots[shot / 4].push_back(rig->bootId());
                                         frames[shot / 4].push_back(std::move(frame));
                                         return {};
                                     },
                                     .done = [&](std::size_t shot) -> Result<void> {
                                         if (done) done(shot);
                                         return {};
                                     },
                                     .begin = [&](std::size_t shot) -> Result<void> {
                                         frames[shot / 4].clear();
                                         boots[shot / 4].clear();
                                         return {};
                                     }});
        odd = sequencer.oddFrames();
        breaks = sequencer.breaks();
        return taken;
    }
    /// The rig is only kept alive until it has another boot.
    void awaitReboot() {
        const std::uint32_t boot = rig->bootId();
        for (int looks = 0; looks < 400 && rig->bootId() == boot; ++looks) {
            usb().advanceTo(usb().now() + 200ms);
            EXPECT_TRUE(rig->keepAlive());
        }
        EXPECT_NE(rig->bootId(), boot);
    }
    /// By frames that the rig has made since it booted: this long at least.
    [[nodiscard]] Seconds exposed() {
        const auto stats = rig->link().stats();
        EXPECT_TRUE(stats) << stats.error().message;
        return (stats ? stats->framesMade : 0) * Seconds(rig->identify().framePeriod);
    }
    [[nodiscard]] std::vector<std::string> causes() const {
        std::vector<std::string> names;
        for (const Setback& one : setbacks) names.emplace_back(name(one.cause));
        return names;
    }

    /// From now on a lit frame must show light: `rates` is what white gives.
    void expectLight(WhiteRates rates) {
        Sequencer sequencer(*rig, profile, nextPlanStep, attendance);
        profile.exposures = {80us, 320us, 160us, 640us};
        auto library = sequencer.darks(4, [] { return Result<void>(); });
        ASSERT_TRUE(library) << library.error().message;
        darks = std::move(*library);
        white = std::move(rates);
    }

    RigProfile profile;
    std::optional<proc::DarkLibrary> darks;
    WhiteRates white;
    sim::InProcessDoor first{{}};
    std::vector<std::unique_ptr<sim::InProcessDoor>> doors;
    std::optional<driver::Rig> rig;  // ends before its doors
    std::uint64_t nextPlanStep = 1;
    std::vector<Setback> setbacks;
    int clearings = 0, breaks = 0;
    std::function<void(std::size_t)> done;  ///< called after each shot
    Attendance attendance{.suspended = [this](const Error& why) { return awaitLight(why); },
                          .setback = [this](const Setback& one) { setbacks.push_back(one); }};
    std::array<std::vector<Frame>, 2> frames;
    std::array<std::vector<std::uint32_t>, 2> boots;
    std::vector<OddFrame> odd;

private:
    [[nodiscard]] sim::FaultyUsb& usb() { return (doors.empty() ? first : *doors.back()).usb(); }
    Result<driver::Transport*> comeBack(const Error& lost) {
        for (int looks = 0; looks < 100; ++looks) {
            first.usb().advanceTo(first.usb().now() + 500ms);
            auto again = first.openAgain();
            if (!again) continue;
            doors.push_back(std::move(*again));
            return doors.back().get();
        }
        return lost;
    }
    Result<void> awaitLight(const Error& why) {
        for (int looks = 0; looks < 1000; ++looks) {
            const auto said = rig->status();
            if (!said) return said.error();
            if (!driver::interlock::mayLight(said->interlock)) continue;
            if (said->state == driver::RigState::Fault &&
                !rig->link().command(driver::Op::ClearFault))
                continue;
            ++clearings;
            return {};
        }
        return why;
    }
};

void expectSame(const Bed& seen, const Bed& wanted) {
    for (std::size_t state = 0; state < 2; ++state) {
        ASSERT_EQ(seen.frames[state].size(), wanted.frames[state].size());
        for (std::size_t i = 0; i < seen.frames[state].size(); ++i) {
            EXPECT_EQ(seen.frames[state][i].pixels, wanted.frames[state][i].pixels)
                << "state " << state << ", frame " << i;
        }
        // No bracket mixes boots.
        for (const std::uint32_t boot : seen.boots[state])
            EXPECT_EQ(boot, seen.boots[state].front());
    }
}

struct Case {
    std::string name, script, cause;
};

class Setbacks : public testing::TestWithParam<Case> {};

TEST_P(Setbacks, AreToldAndTheFramesAreThoseOfAnUndisturbedRig) {
    Bed undisturbed;
    ASSERT_TRUE(undisturbed.take());
    EXPECT_TRUE(undisturbed.setbacks.empty());
    Bed bed(GetParam().script);
    const auto taken = bed.take();
    ASSERT_TRUE(taken) << taken.error().message;
    ASSERT_FALSE(bed.setbacks.empty());
    for (const std::string& cause : bed.causes()) EXPECT_EQ(cause, GetParam().cause);
    EXPECT_NE(bed.setbacks.front().message, "");
    expectSame(bed, undisturbed);
}

// Frames 1 to 8 are the first bracket's, 9 to 16 the second's.
INSTANTIATE_TEST_SUITE_P(
    OnSim,
    Setbacks,
    testing::Values(
        Case{"PictureAgain", "on frame 4 previous frame again", "repeated"},
        Case{"PictureAgainOfTheBracketBefore", "on frame 9 previous frame again", "repeated"},
        Case{"NoPicture", "on frame 3 black frame", "blank"},
        Case{"LedNotLit", "on frame 6 unlit led", "exposure"},
        Case{"SettingsLate", "on frame 3 late settings", "rejected"},
        Case{"ExposureNotApplied", "on frame 3 old exposure", "exposure"},
        Case{"ReflexOfSomebody", "on frame 7 saturating reflex", "reflex"},
        Case{"InterlockOpenedForAWhile", "on frame 3 open interlock for 2s", "suspended"},
        Case{"TooWarmForAWhile", "on frame 11 overheat for 3s", "suspended"},
        Case{"PowerLost", "on frame 5 unplug\nat 3s plug rebooted", "new-boot"},
        Case{"PowerLostAfterTheFirstFrame", "on frame 2 unplug\nat 3s plug rebooted", "new-boot"}),
    [](const auto& one) { return one.param.name; });

// The bracket is taken again by the same plan steps, so that its first frames are bit for bit those
// of the first attempt: they are no repeats. Frame 1 has none before it.
TEST(SetbacksOnSim, PictureThatComesAgainOnceIsOneSetbackWhereverInABracketItIs) {
    Bed undisturbed;
    ASSERT_TRUE(undisturbed.take());
    for (const int frame : {2, 3, 5, 8, 9, 10, 16}) {
        SCOPED_TRACE(frame);
        Bed bed("on frame " + std::to_string(frame) + " previous frame again");
        const auto taken = bed.take();
        ASSERT_TRUE(taken) << taken.error().message;
        EXPECT_EQ(bed.causes(), std::vector<std::string>{"repeated"});
        expectSame(bed, undisturbed);
    }
}

/// Electrons per second and pixel of a white tile, by LED and band.
WhiteRates ratesOfWhite() {
    Bed bed(matt("0.99"));
    EXPECT_TRUE(bed.take());
    WhiteRates rates(4);
    for (const auto& [frames, state] :
         {std::pair(bed.frames[0], kFirst), {bed.frames[1], kSecond}}) {
        const Frame& frame = frames.front();
        double sum = 0;
        for (const std::uint16_t dn : frame.pixels.pixels()) sum += dn - frame.blackLevel;
        rates[static_cast<std::size_t>(state.led)][index(state.band)] =
            bed.profile.noise.electronsPerDn * sum /
            static_cast<double>(frame.pixels.size().pixels()) / frame.exposure.seconds();
    }
    return rates;
}

struct Surface {
    std::string name;
    sim::Placement placement;
};

class NoAlarm : public testing::TestWithParam<Surface> {};

// What a sound rig sees of it is no setback, whatever the noise: 64 frames each.
TEST_P(NoAlarm, OfASoundRig) {
    Bed bed(GetParam().placement);
    const WhiteRates white = ratesOfWhite();
    ASSERT_GT(white[1][index(Band::G)], 1e5) << "else nothing would be called dark";
    bed.expectLight(white);
    for (int run = 0; run < 4; ++run) {
        const auto taken = bed.take();
        ASSERT_TRUE(taken) << taken.error().message;
    }
    EXPECT_TRUE(bed.setbacks.empty()) << bed.setbacks.front().message;
}

INSTANTIATE_TEST_SUITE_P(
    OnSim,
    NoAlarm,
    // The blackest coatings that are sold send back 2e-4 to 4e-4 of the light.
    testing::Values(Surface{"Blackest", matt("0.0003")},
                    Surface{"LightTrap",
                            {.role = sim::Role::Zero, .surface = nullptr, .wedge = {}}},
                    Surface{"BlackTile", matt("0.02")},
                    Surface{"Mirror", {.role = sim::Role::Mirror, .surface = nullptr, .wedge = {}}},
                    Surface{"Polished", sample("ggx,alpha=0.02,f0=0.9")},
                    Surface{"White", matt("0.99")}),
    [](const auto& one) { return one.param.name; });

TEST(SetbacksOnSim, StateThatStaysWithoutLightIsTakenForWhatLiesThereWithAWarning) {
    Bed bed("with chance 1 per frame unlit led");
    bed.expectLight(ratesOfWhite());
    const auto taken = bed.take();
    ASSERT_TRUE(taken) << taken.error().message;
    ASSERT_FALSE(bed.setbacks.empty());
    for (const std::string& cause : bed.causes()) EXPECT_EQ(cause, "unlit");
    const proc::Verdict verdict = framesVerdict(bed.odd);
    EXPECT_EQ(verdict.grade, proc::Grade::Warned) << verdict.evidence;
}

TEST(SetbacksOnSim, CableBumpIsNoneOfTheBracketsBusiness) {
    Bed undisturbed;
    ASSERT_TRUE(undisturbed.take());
    Bed bed("on frame 5 unplug for 700ms");
    const auto taken = bed.take();
    ASSERT_TRUE(taken) << taken.error().message;
    EXPECT_TRUE(bed.setbacks.empty()) << bed.setbacks.front().message;
    const auto interruptions = bed.rig->takeInterruptions();
    ASSERT_EQ(interruptions.size(), 1U);
    EXPECT_TRUE(interruptions.front().sameBoot);
    expectSame(bed, undisturbed);
}

/// The rig boots beside the measurement, after so many shots of two times four.
void takeWithABootAfter(std::size_t shot, Bed& bed) {
    bed.done = [&bed, shot, done = false](std::size_t now) mutable {
        if (now == shot && !std::exchange(done, true)) bed.awaitReboot();
    };
    Bed undisturbed;
    ASSERT_TRUE(undisturbed.take());
    const auto taken = bed.take();
    ASSERT_TRUE(taken) << taken.error().message;
    expectSame(bed, undisturbed);
    EXPECT_EQ(bed.breaks, 1);
    EXPECT_GE(bed.exposed(), bed.profile.warmUp) << "its LED was lit before";
}

TEST(SetbacksOnSim, PowerLostBesideABracketHasItTakenAgain) {
    Bed bed("at 30s unplug\nat 31s plug rebooted");
    takeWithABootAfter(1, bed);
    EXPECT_EQ(bed.causes(), std::vector<std::string>{"new-boot"});
}

TEST(SetbacksOnSim, PowerLostBetweenTwoBracketsCostsNoneOfThem) {
    Bed bed("at 30s unplug\nat 31s plug rebooted");
    takeWithABootAfter(3, bed);
    EXPECT_TRUE(bed.setbacks.empty()) << bed.setbacks.front().message;
    EXPECT_NE(bed.boots[0].front(), bed.boots[1].front());
}

TEST(SetbacksOnSim, LedThatWasDarkForAWhileIsWarmAgainBeforeItsBracket) {
    Bed undisturbed, bed("on frame 3 open interlock for 2s");
    ASSERT_TRUE(undisturbed.take());
    ASSERT_TRUE(bed.take());
    EXPECT_EQ(bed.breaks, 1);
    EXPECT_EQ(undisturbed.breaks, 0);
    EXPECT_GE(bed.exposed(), undisturbed.exposed() + bed.profile.warmUp);
}

TEST(SetbacksOnSim, DarkFramesWaitForTheInterlockToo) {
    Bed bed("on frame 3 open interlock for 2s");
    Sequencer sequencer(*bed.rig, bed.profile, bed.nextPlanStep, bed.attendance);
    const auto darks = sequencer.darks(4, [] { return Result<void>(); });
    ASSERT_TRUE(darks) << darks.error().message;
    EXPECT_EQ(darks->size(), bed.profile.exposures.size());
    EXPECT_EQ(bed.clearings, 1);
    ASSERT_FALSE(bed.setbacks.empty());
    EXPECT_EQ(bed.setbacks.back().cause, Setback::Cause::Suspended);
    EXPECT_EQ(bed.setbacks.back().bracket, "dark");
}

TEST(SetbacksOnSim, FrameThatStaysOddIsRefusedWithItsEvidence) {
    Bed bed("with chance 1 per frame black frame");
    const auto refused = bed.take();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Quality) << refused.error().message;
    EXPECT_NE(refused.error().message.find("once more not what was asked for"), std::string::npos)
        << refused.error().message;
    EXPECT_EQ(bed.odd.size(), 2U);
}

TEST(SetbacksOnSim, BrokenLedIsNotWaitedFor) {
    Bed bed("with chance 1 per frame drifting led");
    const auto refused = bed.take();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Device) << refused.error().message;
    EXPECT_EQ(bed.clearings, 0);
}

TEST(SetbacksOnSim, RigThatDoesNotStayUpIsGivenUp) {
    Bed bed("every 300ms unplug\nevery 310ms plug rebooted");
    const auto refused = bed.take();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Device);
    EXPECT_NE(refused.error().message.find("power supply"), std::string::npos)
        << refused.error().message;
}

}  // namespace
}  // namespace gonio::daemon
