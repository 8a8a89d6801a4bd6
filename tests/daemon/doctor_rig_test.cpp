// The doctor on a simulated rig that he has claimed: each ailment once.

#include "daemon/doctor_rig.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "driver/rig.h"
#include "sim/in_process.h"

namespace gonio::daemon {
namespace {

constexpr std::uint64_t kSession = 0x1122334455667788;

/// A rig in process whose answers pass through `bend` on their way.
class BentRig : public driver::Transport, private Clock {
public:
    explicit BentRig(const sim::DeviceConfig& config) : door(config) {}

    [[nodiscard]] driver::DeviceStrings strings() const override { return door.strings(); }
    [[nodiscard]] const Clock& clock() const override { return *this; }
    Result<void> write(const driver::Report& report) override {
        pass(requestTakes);
        return door.write(report);
    }
    Result<void> setFeature(const driver::Report& report) override {
        pass(requestTakes);
        return door.setFeature(report);
    }
    [[nodiscard]] Result<driver::Report> getFeature(std::uint8_t id) override {
        pass(requestTakes);
        auto report = door.getFeature(id);
        if (report && bend) bend(*report);
        return report;
    }
    [[nodiscard]] Result<std::optional<driver::Report>> readInput(Nanoseconds wait) override {
        auto report = door.readInput(wait);
        if (report && *report && bend) bend(**report);
        if (report && *report && answerTakes && driver::decodeAck(**report))
            pass(answerTakes(door.clock().now()));
        return report;
    }
    [[nodiscard]] Result<std::optional<driver::BulkBytes>> readBulk(Nanoseconds wait) override {
        if (streamDead) {
            const auto nothing = door.readInput(wait);  // time passes
            if (!nothing) return nothing.error();
            return std::optional<driver::BulkBytes>();
        }
        return door.readBulk(wait);
    }
    Result<void> reopenReports() override { return door.reopenReports(); }
    Result<void> resetPort() override { return door.resetPort(); }

    sim::InProcessDoor door;
    std::function<void(driver::Report&)> bend;
    bool streamDead = false;
    double hostSlow = 0;          ///< the host's clock runs so much slower than the rig's
    Nanoseconds requestTakes{0};  ///< longer than it would
    /// ACKs, likewise, by the time at which they come.
    std::function<Nanoseconds(Nanoseconds)> answerTakes;

private:
    void pass(Nanoseconds time) { door.usb().advanceTo(door.clock().now() + time); }
    [[nodiscard]] Nanoseconds now() const override {
        const auto rig = door.clock().now();
        return rig - std::chrono::duration_cast<Nanoseconds>(rig * hostSlow);
    }
};

sim::DeviceConfig config() {
    return {.serial = "SIM-0042", .seed = 11, .bootCount = 1, .errors = {}};
}

class DoctorInside : public testing::Test {
protected:
    DoctorInside() : rig(config()), profile(*readProfile(defaultProfile())) {}
    [[nodiscard]] std::vector<Finding> all() { return examineInside(rig, kSession, profile); }
    [[nodiscard]] Finding seen(const std::string& subject) {
        for (const Finding& one : all()) {
            if (one.subject == subject) return one;
        }
        ADD_FAILURE() << subject;
        return {};
    }
    /// Changes one kind of the reports on their way.
    template <class T, class Decode>
    void change(Decode decode, std::function<void(T&)> how) {
        rig.bend = [decode, how](driver::Report& report) {
            auto value = decode(report);
            if (!value) return;  // another report
            how(*value);
            report = driver::encode(*value);
        };
    }

    BentRig rig;
    RigProfile profile;
};

TEST_F(DoctorInside, SoundRigHasNoAilmentAndIsGivenBackDark) {
    const auto findings = all();
    ASSERT_EQ(findings.size(), 9U);
    for (const Finding& one : findings) {
        EXPECT_EQ(one.verdict, Verdict::Ok) << one.subject << ": " << one.seen;
        EXPECT_EQ(one.cure, "") << one.subject;
    }
    EXPECT_FALSE(rig.door.device().lit());
    const auto free = driver::Rig::open(rig, kSession + 2);
    EXPECT_TRUE(free) << free.error().message;
}

TEST_F(DoctorInside, RigThatAnotherSessionOwnsIsLeftToIt) {
    auto owner = driver::Rig::open(rig, kSession + 2);
    ASSERT_TRUE(owner);
    const auto findings = all();
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings.front().subject, "claim");
    EXPECT_EQ(findings.front().verdict, Verdict::Fail);
    EXPECT_TRUE(owner->status());
    EXPECT_EQ(owner->status()->owner, driver::Owner::Alive);
}

TEST_F(DoctorInside, DriftingClockIsAWarningWithItsFigure) {
    rig.hostSlow = 2e-3;
    const Finding clock = seen("clock");
    EXPECT_EQ(clock.verdict, Verdict::Warn);
    EXPECT_NE(clock.seen.find("drift 200"), std::string::npos) << clock.seen;  // 2004 ppm or near
    EXPECT_NE(clock.seen.find(" in 5."), std::string::npos) << clock.seen;     // six looks
    EXPECT_NE(clock.cure.find("oscillator"), std::string::npos) << clock.cure;
}

TEST_F(DoctorInside, ClockOfASoundRigIsLookedAtTwice) {
    EXPECT_NE(seen("clock").seen.find(" in 1."), std::string::npos) << seen("clock").seen;
}

TEST_F(DoctorInside, ComputerThatGetsBusyAfterTheFirstLookIsNoDrift) {
    using namespace std::chrono_literals;
    // All of the delay is on the way back: the offset shifts by half of it.
    rig.answerTakes = [](Nanoseconds now) { return now < 500ms ? 0ns : 1600us; };
    const Finding clock = seen("clock");
    EXPECT_NE(clock.verdict, Verdict::Warn) << clock.seen;
    EXPECT_NE(clock.seen.find(" in 5."), std::string::npos) << clock.seen;  // it was suspected
}

TEST_F(DoctorInside, DriftIsTheLinksDoingWhereItIsSlow) {
    using namespace std::chrono_literals;
    rig.answerTakes = [](Nanoseconds now) { return now < 500ms ? 0ns : 50ms; };
    const Finding clock = seen("clock");
    EXPECT_EQ(clock.verdict, Verdict::Warn) << clock.seen;
    EXPECT_NE(clock.cure.find("without a hub"), std::string::npos) << clock.cure;
}

TEST_F(DoctorInside, SlowLinkHoldsNobodyForLong) {
    using namespace std::chrono_literals;
    // Three ACKs of four are late, from the first look on or from the second.
    const auto lateAcks = [](int first) {
        return [first, seen = 0](Nanoseconds) mutable {
            return ++seen > first && seen % 4 != 0 ? 300ms : 0ms;
        };
    };
    const std::array<std::function<void(BentRig&)>, 5> links{
        [](BentRig& slow) { slow.requestTakes = 52ms; },
        [](BentRig& slow) {
            slow.requestTakes = 500ms;
            slow.streamDead = true;  // which costs many commands more
        },
        [](BentRig& slow) {
            slow.requestTakes = 45ms;
            slow.streamDead = true;
        },
        [&](BentRig& slow) { slow.answerTakes = lateAcks(0); },
        [&](BentRig& slow) { slow.answerTakes = lateAcks(40); }};
    for (std::size_t i = 0; i < links.size(); ++i) {
        BentRig another(config());
        auto claimed = driver::Rig::open(another, kSession);
        ASSERT_TRUE(claimed) << claimed.error().message;
        links[i](another);
        const Nanoseconds before = another.door.clock().now();
        const auto findings = examineClaimed(*claimed, profile);
        // A daemon that is busy with it for longer is killed by its watchdog.
        EXPECT_LT(another.door.clock().now() - before, 10s) << "link " << i;
        const Finding& clock = findings[1];
        EXPECT_EQ(clock.verdict == Verdict::Warn, i < 3) << i << ": " << clock.seen;
        EXPECT_EQ(clock.cure.find("oscillator"), std::string::npos) << i << ": " << clock.seen;
        const bool usuallySlow = i < 2 || i == 3;
        EXPECT_EQ(findings[4].verdict == Verdict::Note, usuallySlow)
            << i << ": " << findings[4].seen;
    }
}

// A self-test that fails takes 7 s; two looks so far apart tell it by their round trips alone.
TEST_F(DoctorInside, DriftIsSeenWithoutTimeForMoreLooks) {
    rig.hostSlow = 2e-3;
    rig.streamDead = true;
    const Nanoseconds before = rig.door.clock().now();
    const Finding clock = seen("clock");
    EXPECT_LT(rig.door.clock().now() - before, std::chrono::seconds(10));
    EXPECT_EQ(clock.verdict, Verdict::Warn) << clock.seen;
    EXPECT_NE(clock.cure.find("oscillator"), std::string::npos) << clock.seen;
}

TEST_F(DoctorInside, HotRigIsAFailureAndAWarmOneAWarning) {
    const auto at = [&](std::int16_t hundredths) {
        change<driver::Status>([](const driver::Report& r) { return driver::decodeStatus(r); },
                               [hundredths](driver::Status& s) { s.temperature[0] = hundredths; });
        return seen("temperature").verdict;
    };
    const auto link = driver::RigLink::open(rig, {.sessionId = kSession});
    ASSERT_TRUE(link);
    const std::int16_t highest = (*link)->limits().ledTemperature[1];
    ASSERT_TRUE((*link)->release());
    EXPECT_EQ(at(static_cast<std::int16_t>(highest - 201)), Verdict::Ok);
    EXPECT_EQ(at(static_cast<std::int16_t>(highest - 199)), Verdict::Warn);
    EXPECT_EQ(at(static_cast<std::int16_t>(highest + 1)), Verdict::Fail);
}

TEST_F(DoctorInside, OpenInterlockIsAWarningThatSaysWhichOne) {
    rig.door.device().setInterlock(driver::interlock::kSeated);
    EXPECT_EQ(seen("interlock").verdict, Verdict::Warn);
    EXPECT_EQ(seen("interlock").seen, "the cover is open");
    rig.door.device().setInterlock(driver::interlock::kCoverClosed);
    EXPECT_NE(seen("interlock").seen.find("aperture"), std::string::npos);
    EXPECT_EQ(seen("self-test").verdict, Verdict::Note);  // no frame would be valid
}

TEST_F(DoctorInside, RigThatSendsNoFrameFailsItsSelfTestInTime) {
    rig.streamDead = true;
    const Nanoseconds before = rig.door.clock().now();
    EXPECT_EQ(seen("self-test").verdict, Verdict::Fail);
    // A daemon that is busy with it for longer is killed by its watchdog.
    EXPECT_LT(rig.door.clock().now() - before, std::chrono::seconds(10));
    EXPECT_EQ(seen("noise").verdict, Verdict::Note);
}

TEST_F(DoctorInside, NoiseOfAnotherSensorThanTheProfilesIsAWarning) {
    EXPECT_EQ(seen("noise").verdict, Verdict::Ok) << seen("noise").seen;
    profile.noise.readNoiseElectrons *= 1.5;
    EXPECT_EQ(seen("noise").verdict, Verdict::Warn);
    profile.noise.readNoiseElectrons /= 3;
    EXPECT_EQ(seen("noise").verdict, Verdict::Warn);
}

TEST_F(DoctorInside, LightThatLeaksInIsAWarning) {
    rig.door.device().place({.errors = {.ambient = 0.2}});
    const Finding noise = seen("noise");
    EXPECT_EQ(noise.verdict, Verdict::Warn) << noise.seen;
    EXPECT_NE(noise.cure.find("light leak"), std::string::npos);
}

TEST_F(DoctorInside, LightThatFlickersIsAWarningToo) {
    auto script = sim::FaultScript::parse("on frame 2 black frame");
    ASSERT_TRUE(script) << script.error().message;
    rig.door.usb().play(std::move(*script));
    const Finding noise = seen("noise");
    EXPECT_EQ(noise.verdict, Verdict::Warn) << noise.seen;
    EXPECT_EQ(noise.seen.find("nan"), std::string::npos) << noise.seen;
    EXPECT_NE(noise.cure.find("light leak"), std::string::npos);
}

TEST_F(DoctorInside, RigThatIsTooWarmOrOpenedInItsSelfTestNeedsNoOtherCable) {
    for (const auto& [fault, cure] : {std::pair{"on frame 1 overheat", "cool"},
                                      std::pair{"on frame 1 open interlock", "cover"}}) {
        auto script = sim::FaultScript::parse(fault);
        ASSERT_TRUE(script) << script.error().message;
        BentRig another(config());  // a fault stays until its cause is gone
        another.door.usb().play(std::move(*script));
        for (const Finding& test : examineInside(another, kSession, profile)) {
            if (test.subject != "self-test") continue;
            EXPECT_EQ(test.verdict, Verdict::Warn) << test.seen;
            EXPECT_NE(test.cure.find(cure), std::string::npos) << fault << ": " << test.seen;
            EXPECT_EQ(test.cure.find("cable"), std::string::npos) << test.cure;
        }
    }
}

TEST_F(DoctorInside, RigThatIsLostMeanwhileIsAFailureOfItsLink) {
    auto script = sim::FaultScript::parse("on frame 2 unplug");
    ASSERT_TRUE(script) << script.error().message;
    rig.door.usb().play(std::move(*script));
    const Finding link = seen("link");
    EXPECT_EQ(link.verdict, Verdict::Fail);
    EXPECT_NE(link.seen.find("is gone"), std::string::npos) << link.seen;
    EXPECT_NE(link.cure.find("plug it in"), std::string::npos);
}

TEST_F(DoctorInside, EventsThatWereMissedAreNotSaidToBeMadeGood) {
    auto script = sim::FaultScript::parse("on frame 1 pile up 400 reports");
    ASSERT_TRUE(script) << script.error().message;
    rig.door.usb().play(std::move(*script));
    const Finding link = seen("link");
    EXPECT_EQ(link.verdict, Verdict::Note);
    EXPECT_NE(link.seen.find("events were gone"), std::string::npos) << link.seen;
    EXPECT_EQ(link.seen.find("events lost"), std::string::npos) << link.seen;
}

TEST_F(DoctorInside, CountersTellOfAHostThatIsTooSlowAndOfACableThatIsBad) {
    const auto with = [&](std::function<void(driver::Stats&)> how) {
        change<driver::Stats>([](const driver::Report& r) { return driver::decodeStats(r); },
                              std::move(how));
        return seen("counters");
    };
    EXPECT_NE(with([](driver::Stats& s) { s.fifoOverruns = 1; }).cure.find("too slow"),
              std::string::npos);
    EXPECT_NE(with([](driver::Stats& s) { s.resends = 5000; }).cure.find("cable"),
              std::string::npos);
    EXPECT_NE(with([](driver::Stats& s) { s.crcRejects = 5000; }).cure.find("cable"),
              std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
