// The driver on the simulated rig, in virtual time: every byte passes the codec.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <random>
#include <vector>

#include "driver/rig.h"
#include "proc/models/spec.h"
#include "sim/in_process.h"

namespace gonio {
namespace {

constexpr Window kWindow{.x = 128, .y = 0, .size = {1024, 1024}, .binning = 1};
constexpr std::uint64_t kSession = 0x1122334455667788;

sim::Placement lambert() {
    return {.role = sim::Role::Sample,
            .surface = std::move(*proc::makeModel("lambert,albedo=0.5")),
            .wedge = {}};
}

TEST(RigOnSim, TakesFramesAsPlanned) {
    sim::InProcessDoor door({.serial = "SIM-0007", .seed = 3, .bootCount = 1, .errors = {}});
    door.device().place(lambert());
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig) << rig.error().message;
    EXPECT_EQ(rig->identify().serial, "SIM-0007");
    EXPECT_EQ(rig->identify().ledAngles.size(), 4U);
    ASSERT_TRUE(rig->configure(kWindow));
    const auto frames = rig->capture({.planStep = 5,
                                      .led = 1,
                                      .levels = LedLevels::only(Band::G, 65535),
                                      .exposure = Microseconds(320),
                                      .frames = 3});
    ASSERT_TRUE(frames) << frames.error().message;
    ASSERT_EQ(frames->size(), 3U);
    const Frame& frame = frames->front();
    EXPECT_EQ(frame.pixels.size(), kWindow.size);
    EXPECT_EQ(frame.led, 1);
    EXPECT_EQ(frame.exposure.granted, sim::grantedExposure(320));
    EXPECT_EQ(frame.captureId >> 16, 5U);
    // 0.5/pi x 0.95 x 4.5e7 e-/s x 320 us / 2.6 e-/DN + 60 DN in the middle, near enough.
    EXPECT_NEAR(frame.pixels.at(512, 512), 898, 60);
    EXPECT_EQ(rig->anomalies(), driver::Anomalies{});
}

/// Virtual seconds that a rig takes for dark full frames of the host's window.
double secondsFor(int frames, sim::CameraKind camera) {
    sim::InProcessDoor door({.errors = {}, .camera = camera});
    auto rig = driver::Rig::open(door, kSession);
    EXPECT_TRUE(rig);
    EXPECT_TRUE(rig->configure(kWindow));
    const Nanoseconds begin = door.device().now();
    const auto capture = rig->capture({.planStep = 1,
                                       .led = std::nullopt,
                                       .levels = {},
                                       .exposure = Microseconds(320),
                                       .frames = frames});
    EXPECT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(rig->anomalies(), driver::Anomalies{});
    return std::chrono::duration<double>(door.device().now() - begin).count();
}

TEST(RigOnSim, SixtyFramesOfAUsb3CameraTakeASecond) {
    // 59 periods, the last exposure, its 4 ms on the bus and the commands around.
    EXPECT_NEAR(secondsFor(60, sim::CameraKind::Usb3), 1, 0.015);
}

TEST(RigOnSim, TenFramesOfAUsb2CameraTakeFourTenthsOfASecond) {
    EXPECT_NEAR(secondsFor(10, sim::CameraKind::Usb2), 0.4, 0.015);
}

TEST(RigOnSim, LimitsTellTheFramePeriodOfTheCamera) {
    const auto periodOf = [](sim::CameraKind camera) {
        sim::InProcessDoor door({.errors = {}, .camera = camera});
        auto rig = driver::Rig::open(door, kSession);
        EXPECT_TRUE(rig);
        return rig->identify().framePeriod;
    };
    EXPECT_EQ(periodOf(sim::CameraKind::Usb2), Microseconds(40'000));
    EXPECT_EQ(periodOf(sim::CameraKind::Usb3), Microseconds(16'667));
}

/// A grey, lit green by LED 1 three times, after a pause; the means of the frames.
std::vector<double> meansOf(double ledDrift, Nanoseconds pause) {
    sim::InProcessDoor door({.errors = {}, .rig = {.ledDrift = ledDrift}});
    door.device().place(lambert());
    auto rig = driver::Rig::open(door, kSession);
    EXPECT_TRUE(rig);
    EXPECT_TRUE(rig->configure({.x = 384, .y = 256, .size = {512, 512}, .binning = 1}));
    std::vector<double> means;
    for (std::uint64_t step : {70U, 200U, 330U}) {
        door.device().advanceTo(door.device().now() + pause);
        EXPECT_TRUE(rig->keepAlive());
        const auto capture = rig->capture({.planStep = step,
                                           .led = 1,
                                           .levels = LedLevels::only(Band::G, 65535),
                                           .exposure = Microseconds(1000),
                                           .frames = 1});
        EXPECT_TRUE(capture) << capture.error().message;
        double sum = 0;
        for (std::uint16_t dn : capture->front().pixels.pixels()) sum += dn - sim::kBlackLevel;
        means.push_back(sum / 512 / 512);
    }
    return means;
}

TEST(RigOnSim, LedsDriftInLightAndNotInCurrent) {
    // A frame whose current left its tolerance would not be valid, and the capture would fail.
    const std::vector<double> nominal = meansOf(0, {});
    const std::vector<double> drifting = meansOf(0.01, {});
    const sim::LedDrift drift(sim::DeviceConfig{}.seed, 0.01);
    for (std::size_t i = 0; i < nominal.size(); ++i) {
        const double wander = drift.wander(1, Band::G, std::array{70U, 200U, 330U}[i]);
        // Half a per cent of the size for the heat of 18 ms; a mean of 262,144 pixels is known to
        // 3e-5, and its noise is the same in both.
        EXPECT_NEAR(drifting[i] / nominal[i], 1 + 0.01 * wander, 1e-4) << i;
    }
}

TEST(RigOnSim, DriftDoesNotDependOnTheWallClock) {
    EXPECT_EQ(meansOf(0.01, {}), meansOf(0.01, std::chrono::seconds(1)));
}

TEST(RigOnSim, DarkFramesShowTheBlackLevel) {
    sim::InProcessDoor door({});
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(rig->configure(kWindow));
    const auto frames = rig->capture({.planStep = 1,
                                      .led = std::nullopt,
                                      .levels = {},
                                      .exposure = Microseconds(5000),
                                      .frames = 1});
    ASSERT_TRUE(frames) << frames.error().message;
    double sum = 0;
    for (std::uint16_t dn : frames->front().pixels.pixels()) sum += dn;
    EXPECT_NEAR(sum / static_cast<double>(kWindow.size.pixels()), 60, 0.05);
    EXPECT_FALSE(frames->front().led);
}

TEST(RigOnSim, IsDarkAfterItIsGivenBack) {
    sim::InProcessDoor door({});
    door.device().place(lambert());
    {
        auto rig = driver::Rig::open(door, kSession);
        ASSERT_TRUE(rig);
        ASSERT_TRUE(rig->configure(kWindow));
        ASSERT_TRUE(rig->capture({.planStep = 1,
                                  .led = 0,
                                  .levels = LedLevels::only(Band::R, 65535),
                                  .exposure = Microseconds(100),
                                  .frames = 1}));
    }
    const auto report =
        door.device().getFeature(static_cast<std::uint8_t>(driver::ReportId::Status));
    ASSERT_TRUE(report);
    const auto status = driver::decodeStatus(*report);
    ASSERT_TRUE(status);
    EXPECT_EQ(status->ledOn, 0U);
    EXPECT_EQ(status->owner, driver::Owner::None);
}

TEST(RigOnSim, RefusesASecondOwner) {
    sim::InProcessDoor door({});
    auto first = driver::Rig::open(door, kSession);
    ASSERT_TRUE(first);
    auto second = driver::Rig::open(door, kSession + 1);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().kind, ErrorKind::Busy);
}

TEST(RigOnSim, GoesDarkWithoutAHeartbeat) {
    sim::InProcessDoor door({});
    door.device().place(lambert());
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(rig->configure(kWindow));
    ASSERT_TRUE(rig->capture({.planStep = 1,
                              .led = 2,
                              .levels = LedLevels::only(Band::B, 100),
                              .exposure = Microseconds(100),
                              .frames = 1}));
    door.device().advanceTo(door.device().now() + std::chrono::seconds(3));
    const auto status = driver::decodeStatus(*door.device().getFeature(0x10));
    ASSERT_TRUE(status);
    EXPECT_EQ(status->ledOn, 0U);
    EXPECT_EQ(status->owner, driver::Owner::Lapsed);
    EXPECT_EQ(door.device().stats().lapses, 1U);
}

TEST(RigOnSim, RefusesToLightWithTheInterlockOpen) {
    sim::InProcessDoor door({});
    door.device().setInterlock(0);
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(rig->configure(kWindow));
    const auto frames = rig->capture({.planStep = 1,
                                      .led = 0,
                                      .levels = LedLevels::only(Band::R, 1),
                                      .exposure = Microseconds(100),
                                      .frames = 1});
    ASSERT_FALSE(frames);
    EXPECT_EQ(frames.error().deviceStatus, driver::status::kInterlock);
    EXPECT_NE(frames.error().message.find("INTERLOCK"), std::string::npos);
}

TEST(RigOnSim, RefusesAWindowOffTheGrid) {
    sim::InProcessDoor door({});
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    const auto refused = rig->configure({.x = 129, .y = 0, .size = {1024, 1024}, .binning = 1});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().deviceStatus, driver::status::kBadArg);
}

/// A matt grey that counts how often it is asked.
class Counted : public Scatterer {
public:
    Answer answer(const LightView&) const override {
        ++asked;
        return {.f = LedBands::all(0.1)};
    }
    mutable std::atomic<int> asked = 0;
};

TEST(RigOnSim, LooksAtASurfaceOncePerLedAndWindow) {
    sim::InProcessDoor door({});
    const auto surface = std::make_shared<const Counted>();
    door.device().place({.role = sim::Role::Sample, .surface = surface, .wedge = {}});
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    std::uint64_t step = 1;
    const auto asked = [&](int led, Band band) {
        EXPECT_TRUE(rig->capture({.planStep = step++,
                                  .led = led,
                                  .levels = LedLevels::only(band, 65535),
                                  .exposure = Microseconds(100),
                                  .frames = 1}));
        return surface->asked.exchange(0);
    };
    ASSERT_TRUE(rig->configure(kWindow));
    EXPECT_GT(asked(0, Band::R), 500'000);  // the field of view, once for all bands
    EXPECT_EQ(asked(0, Band::G), 0);
    EXPECT_GT(asked(1, Band::G), 500'000);
    ASSERT_TRUE(rig->configure(kWindow));
    EXPECT_EQ(asked(0, Band::B), 0);
    EXPECT_EQ(asked(1, Band::B), 0);
    ASSERT_TRUE(rig->configure({.x = 640, .y = 512, .size = {16, 8}, .binning = 1}));
    EXPECT_EQ(asked(0, Band::B), 16 * 8);
}

driver::CaptureRequest lit(std::uint64_t planStep, Microseconds exposure, int frames = 1) {
    return {.planStep = planStep,
            .led = static_cast<int>(planStep % 4),
            .levels = LedLevels::only(kBands[planStep % 3], 65535),
            .exposure = exposure,
            .frames = frames};
}

/// Seconds on the rig for `captures` of one frame at one LED level, each of `exposure`.
double secondsFor(int captures, Microseconds exposure, bool overlapping) {
    sim::InProcessDoor door({});
    door.device().place(lambert());
    auto rig = driver::Rig::open(door, kSession);
    EXPECT_TRUE(rig && rig->configure(kWindow));
    driver::CaptureRequest request = lit(1, exposure);
    const Stopwatch onRig(door.clock());
    for (int i = 0; i < captures; ++i) {
        driver::CaptureRequest next = request;
        ++next.planStep;
        const bool more = overlapping && i + 1 < captures;
        EXPECT_TRUE(rig->capture(request, {more ? std::optional(next) : std::nullopt}));
        request = next;
    }
    return onRig.elapsed().count();
}

TEST(RigOnSim, ExposesTheNextCaptureWhileTheLastIsSent) {
    constexpr int kCaptures = 8;
    constexpr double kPeriod = 0.040, kTransfer = 0.039, kExposure = 0.030, kSettling = 0.005;
    constexpr Microseconds exposure(30000);
    // Three commands of 0.2 ms for each capture.
    EXPECT_NEAR(secondsFor(kCaptures, exposure, false),
                kSettling + kCaptures * (kExposure + kTransfer + 0.0006),
                0.005);
    // The last transfer has nothing to overlap with.
    EXPECT_NEAR(secondsFor(kCaptures, exposure, true),
                kSettling + kExposure + (kCaptures - 1) * kPeriod + kTransfer,
                0.005);
}

/// The in-process door with one of its chunks lost now and then.
class LossyDoor : public driver::Transport {
public:
    LossyDoor(sim::DeviceConfig config, unsigned seed, double loss)
        : door(std::move(config)), random_(seed), lost_(loss) {}
    [[nodiscard]] driver::DeviceStrings strings() const override { return door.strings(); }
    [[nodiscard]] const Clock& clock() const override { return door.clock(); }
    Result<void> write(const driver::Report& report) override { return door.write(report); }
    Result<void> setFeature(const driver::Report& report) override {
        return door.setFeature(report);
    }
    [[nodiscard]] Result<driver::Report> getFeature(std::uint8_t id) override {
        return door.getFeature(id);
    }
    [[nodiscard]] Result<std::optional<driver::Report>> readInput(Nanoseconds wait) override {
        return door.readInput(wait);
    }
    [[nodiscard]] Result<std::optional<driver::BulkBytes>> readBulk(Nanoseconds wait) override {
        auto chunk = door.readBulk(wait);
        if (chunk && *chunk && lost_(random_)) return std::optional<driver::BulkBytes>{};
        return chunk;
    }
    Result<void> reopenReports() override { return door.reopenReports(); }
    Result<void> resetPort() override { return door.resetPort(); }

    sim::InProcessDoor door;

private:
    std::mt19937 random_;
    std::bernoulli_distribution lost_;
};

TEST(RigOnSim, LossesWithCapturesArmedAheadChangeNoFrame) {
    constexpr Window kSmall{.x = 512, .y = 384, .size = {256, 256}, .binning = 1};
    constexpr int kCaptures = 80;
    int resends = 0, recaptures = 0;
    for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const sim::DeviceConfig config{.serial = "SIM-0007", .seed = 3, .errors = {}};
        LossyDoor lossy(config, seed, 0.18);
        sim::InProcessDoor sound(config);
        lossy.door.device().place(lambert());
        sound.device().place(lambert());
        auto rig = driver::Rig::open(lossy, kSession);
        auto twin = driver::Rig::open(sound, kSession);
        ASSERT_TRUE(rig && twin && rig->configure(kSmall) && twin->configure(kSmall));
        std::mt19937 random(seed);
        const auto requestFor = [&](std::uint64_t step) {
            return lit(step,
                       Microseconds(20 + static_cast<int>(random() % 20000)),
                       1 + static_cast<int>(random() % 5));
        };
        driver::CaptureRequest request = requestFor(1);
        for (std::uint64_t step = 1; step <= kCaptures; ++step) {
            const driver::CaptureRequest next = requestFor(step + 1);
            const auto seen = rig->capture(request, {next});
            ASSERT_TRUE(seen) << seen.error().message;
            const auto wanted = twin->capture(request);
            ASSERT_TRUE(wanted);
            ASSERT_EQ(seen->size(), wanted->size());
            for (std::size_t i = 0; i < seen->size(); ++i) {
                ASSERT_EQ((*seen)[i].captureId >> 16, step);
                ASSERT_EQ((*seen)[i].index, static_cast<int>(i));
                ASSERT_EQ((*seen)[i].led, request.led);
                ASSERT_EQ((*seen)[i].pixels, (*wanted)[i].pixels) << "step " << step;
            }
            resends += seen->resends;
            recaptures += seen->recaptures;
            // Now and then something else comes than what was armed ahead.
            request = random() % 8 == 0 ? requestFor(step + 1) : next;
            const bool darkened = random() % 16 != 0 || rig->darken();
            ASSERT_TRUE(darkened);
        }
    }
    EXPECT_GT(resends, 2 * kCaptures);
    EXPECT_GT(recaptures, 3);
}

TEST(RigOnSim, BinnedWindowIsFourTimesSmaller) {
    sim::InProcessDoor door({});
    door.device().place(lambert());
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(rig->configure({.x = 128, .y = 0, .size = {1024, 1024}, .binning = 2}));
    const auto frames = rig->capture({.planStep = 9,
                                      .led = 0,
                                      .levels = LedLevels::only(Band::G, 65535),
                                      .exposure = Microseconds(100),
                                      .frames = 2});
    ASSERT_TRUE(frames) << frames.error().message;
    EXPECT_EQ(frames->front().pixels.size(), (Size{512, 512}));
}

/// Two frames of a small window, of a rig with so many bits, in this format on the wire.
std::vector<Frame> framesIn(int bits, driver::PixelFormat format) {
    sim::InProcessDoor door({.errors = {}, .rig = {.bits = bits}});
    door.device().place(lambert());
    auto rig = driver::Rig::open(door, kSession);
    if (!rig) return {};
    EXPECT_TRUE(rig->configure({.x = 600, .y = 500, .size = {64, 32}, .binning = 1}, format));
    const auto frames = rig->capture({.planStep = 1,
                                      .led = 0,
                                      .levels = LedLevels::only(Band::G, 65535),
                                      .exposure = Microseconds(320),
                                      .frames = 2});
    EXPECT_TRUE(frames) << frames.error().message;
    if (!frames) return {};
    return {frames->begin(), frames->end()};
}

TEST(RigOnSim, EightTenAndTwelveBitsComeInBothFormats) {
    for (const int bits : {8, 10, 12}) {
        const auto packed = framesIn(bits, driver::PixelFormat::Mono12Packed);
        const auto wide = framesIn(bits, driver::PixelFormat::Mono16);
        ASSERT_EQ(packed.size(), 2U);
        ASSERT_EQ(wide.size(), 2U);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(packed[i].pixels, wide[i].pixels) << bits;
            EXPECT_EQ(packed[i].blackLevel, sim::digitsOf(bits).blackLevel);
        }
        EXPECT_NE(packed[0].pixels, packed[1].pixels);
    }
}

/// Mean DN above black of frames taken one after another, each at its plan step.
double meanDn(driver::Rig& rig, std::uint64_t planStep) {
    const auto frames = rig.capture({.planStep = planStep,
                                     .led = 0,
                                     .levels = LedLevels::only(Band::G, 65535),
                                     .exposure = Microseconds(320),
                                     .frames = 1});
    EXPECT_TRUE(frames) << frames.error().message;
    double sum = 0;
    for (std::uint16_t dn : frames->front().pixels.pixels()) sum += dn - sim::kBlackLevel;
    return sum / static_cast<double>(frames->front().pixels.pixels().size());
}

TEST(RigOnSim, LedsStepBetweenTwoPlanSteps) {
    sim::InProcessDoor door({.errors = {}, .rig = {.ledStep = {.size = 0.05, .planStep = 4}}});
    door.device().place(lambert());
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(rig->configure({.x = 560, .y = 432, .size = {160, 160}, .binning = 1}));
    const double before = meanDn(*rig, 2);
    // 25,600 pixels with some 2000 electrons: 1.4e-4.
    EXPECT_NEAR(meanDn(*rig, 3) / before, 1, 1e-3);
    EXPECT_NEAR(meanDn(*rig, 4) / before, 1.05, 1e-3);
    EXPECT_NEAR(meanDn(*rig, 5) / before, 1.05, 1e-3);
}

TEST(RigOnSim, ASoftSampleRelaxesWithThePhotometricClockAndStartsAnewWhenPlaced) {
    sim::InProcessDoor door({.errors = {}});
    sim::Placement soft = lambert();
    soft.errors.softness = 0.2;
    door.device().place(soft);
    auto rig = driver::Rig::open(door, kSession);
    ASSERT_TRUE(rig);
    ASSERT_TRUE(rig->configure({.x = 560, .y = 432, .size = {160, 160}, .binning = 1}));
    const double pressed = meanDn(*rig, 1);
    const auto dark = [&](std::uint64_t planStep) {
        return rig->capture(
            {.planStep = planStep, .exposure = Microseconds(1'000'000), .frames = 8});
    };
    ASSERT_TRUE(dark(2));
    const double relaxed = meanDn(*rig, 3);
    // The window is 24.2 degrees wide. Along each axis the mean of exp(-(x / 10)^2 / 2) over +-12.1
    // is 0.80; the lens is centred to 1 degree.
    EXPECT_NEAR(pressed / relaxed, 1 + 0.2 * 0.80 * 0.80, 0.005);
    door.device().advanceTo(door.device().now() + std::chrono::milliseconds(50));
    door.device().place(soft);
    EXPECT_NEAR(meanDn(*rig, 4) / pressed, 1, 2e-3);
}

}  // namespace
}  // namespace gonio
