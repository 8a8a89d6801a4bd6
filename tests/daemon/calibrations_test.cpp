#include "daemon/calibrations.h"

#include <gtest/gtest.h>

#include <optional>

#include "daemon/rig_records.h"
#include "proc/formats/graw_exr.h"
#include "tests/daemon/uniform_capture.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

const RigNow kNow{
    .serial = "R1", .profileHash = "abc", .celsius = 26, .dateUtc = "2026-03-01T12:00:00Z"};

CalibrationRecord white() {
    return {.id = 12,
            .rig = "R1",
            .kind = "white",
            .dateUtc = "2026-03-01T11:00:00Z",
            .profileHash = "abc",
            .celsius = 24};
}

std::string whyNotNow(const CalibrationRecord& calibration) {
    return whyNot(calibration, kNow, ValidityLimits{});
}

TEST(CalibrationValidity, FreshOneOfTheRigIsGood) { EXPECT_EQ(whyNotNow(white()), ""); }

TEST(CalibrationValidity, SaysWhyNotAndWhatToRun) {
    const auto expect = [](const CalibrationRecord& bad, const std::vector<std::string>& words) {
        const std::string why = whyNotNow(bad);
        for (const std::string& word : words) {
            EXPECT_NE(why.find(word), std::string::npos) << word << " in: " << why;
        }
    };
    CalibrationRecord bad = white();
    bad.rig = "R2";
    expect(bad, {"white calibration 12", "R2", "R1"});
    bad = white();
    bad.profileHash = "def";
    expect(bad, {"def", "abc", "gonio calibrate white"});
    bad = white();
    bad.dateUtc = "2026-02-28T11:59:59Z";
    expect(bad, {"24.0 h old", "good for 24.0 h", "gonio calibrate white"});
    bad.dateUtc = "2026-03-01T12:05:01Z";
    expect(bad, {"2026-03-01T12:05:01Z, which is still to come", "2026-03-01T12:00:00Z", "clock"});
    bad.dateUtc = "yesterday";
    expect(bad, {"no date"});
    bad = white();
    bad.celsius = 20.9;
    expect(bad, {"20.9 degC", "26.0 degC", "5.0 K"});
}

TEST(CalibrationValidity, ClocksMayDifferByMinutes) {
    CalibrationRecord soon = white();
    soon.dateUtc = "2026-03-01T12:05:00Z";
    EXPECT_EQ(whyNotNow(soon), "");
}

TEST(CalibrationValidity, LensMapLivesLongerThanTiles) {
    CalibrationRecord mirror = white();
    mirror.kind = "mirror";
    mirror.dateUtc = "2026-01-01T12:00:00Z";
    EXPECT_EQ(whyNotNow(mirror), "");
    mirror.dateUtc = "2025-11-01T12:00:00Z";
    EXPECT_NE(whyNotNow(mirror), "");
}

TEST(CalibrationValidity, WhatWasNotKeptThenDoesNotCount) {
    CalibrationRecord old = white();  // of a store before these were kept
    old.profileHash.clear();
    old.celsius.reset();
    EXPECT_EQ(whyNotNow(old), "");
}

class CalibrationsInStore : public testing::Test {
protected:
    void SetUp() override {
        auto opened = Store::open(folder.path());
        ASSERT_TRUE(opened) << opened.error().message;
        store.emplace(std::move(*opened));
        for (const std::string rig : {"R1", "R2"}) {
            for (const std::string kind : {"mirror", "black", "white"}) keep(rig, kind);
        }
        keep("R1", "white");  // 7
        auto newest = newestSet(*store, "R1");
        ASSERT_TRUE(newest) << newest.error().message;
        set = std::move(*newest);
    }
    void keep(const std::string& rig, const std::string& kind) {
        ASSERT_TRUE(store->addCalibration(
            {.rig = rig, .kind = kind, .dateUtc = "t", .profileHash = "p", .celsius = 21.5},
            {.file = rig + kind, .raw = {}}));
    }
    void expectRefused(const std::string& text, ErrorKind kind) {
        const auto refused = parseSet(*store, text, set);
        ASSERT_FALSE(refused) << text;
        EXPECT_EQ(refused.error().kind, kind) << text;
        EXPECT_NE(refused.error().message.find("calibration"), std::string::npos);
    }
    test::TempFolder folder;
    std::optional<Store> store;
    CalibrationSet set;
};

TEST_F(CalibrationsInStore, NewestSetIsNamedByItsNumbers) {
    EXPECT_EQ(set.id(), "1+2+7");
    EXPECT_EQ(set.white.profileHash, "p");
    EXPECT_EQ(set.white.celsius, 21.5);
    EXPECT_EQ(store->calibrations()->size(), 7U);
    EXPECT_EQ(store->calibrations()->front().id, 7);
}

TEST_F(CalibrationsInStore, SetIsFoundByItsNameOrOneNumberInThePlaceOfItsKind) {
    EXPECT_EQ(parseSet(*store, "1+2+3", set)->id(), "1+2+3");
    EXPECT_EQ(parseSet(*store, "3", set)->id(), "1+2+3");
    EXPECT_EQ(parseSet(*store, "1", set)->id(), "1+2+7");
}

TEST_F(CalibrationsInStore, AZeroReferenceIsTheFourthNumber) {
    keep("R1", "zero");  // 8
    const auto newest = newestSet(*store, "R1");
    ASSERT_TRUE(newest) << newest.error().message;
    EXPECT_EQ(newest->id(), "1+2+7+8");
    EXPECT_EQ(parseSet(*store, "1+2+7+8", set)->id(), "1+2+7+8");
    EXPECT_EQ(parseSet(*store, "8", set)->id(), "1+2+7+8") << "one number adds it";
    EXPECT_EQ(parseSet(*store, "3", *newest)->id(), "1+2+3+8");
    EXPECT_EQ(parseSet(*store, "1+2+7", *newest)->id(), "1+2+7") << "three say: without it";
    for (const char* bad : {"1+2+8", "1+2+8+7", "1+8", "1+2+7+8+8"}) {
        expectRefused(bad, ErrorKind::Usage);
    }
}

TEST_F(CalibrationsInStore, WhatElseThereIsFollowsInItsOrder) {
    for (const std::string kind : {"sensor", "flat", "dark", "leds", "zero"}) keep("R1", kind);
    const auto newest = newestSet(*store, "R1");
    ASSERT_TRUE(newest) << newest.error().message;
    EXPECT_EQ(newest->id(), "1+2+7+12+9+11+8") << "zero, flat, leds, sensor";
    EXPECT_EQ(parseSet(*store, newest->id(), set)->id(), newest->id());
    EXPECT_EQ(parseSet(*store, "1+2+7+9", set)->flat->id, 9);
    expectRefused("1+2+7+9+12", ErrorKind::Usage);  // not in their order
    expectRefused("10", ErrorKind::Usage);          // dark frames are of the capture
}

TEST(CalibrationValidity, TilesAreOfTheFiguresOfTheSensorThatTheyWereMergedWith) {
    RigNow now = kNow;
    now.profileHash += "/14";
    CalibrationRecord tile = white();
    EXPECT_NE(whyNot(tile, now, {}).find("figures of the sensor"), std::string::npos);
    tile.profileHash += "/14";
    EXPECT_EQ(whyNot(tile, now, {}), "");
    EXPECT_NE(whyNotNow(tile), "");
    tile.kind = "mirror";
    EXPECT_EQ(whyNotNow(tile), "") << "a lens map does not depend on them";
    tile.kind = "leds";
    tile.celsius = -10;
    EXPECT_EQ(whyNotNow(tile), "") << "warmth is what it is about";
}

TEST_F(CalibrationsInStore, AStaleZeroReferenceIsLeftOut) {
    keep("R1", "zero");
    auto newest = newestSet(*store, "R1");
    ASSERT_TRUE(newest && newest->zero);
    newest->zero->dateUtc = "2026-03-01T11:00:00Z";
    newest->zero->profileHash = kNow.profileHash;
    newest->zero->celsius = kNow.celsius;
    leaveOutStale(*newest, kNow, {});
    EXPECT_TRUE(newest->zero);
    newest->zero->dateUtc = "2026-02-28T11:59:59Z";
    leaveOutStale(*newest, kNow, {});
    EXPECT_FALSE(newest->zero);
    EXPECT_EQ(newest->id(), "1+2+7");
}

TEST_F(CalibrationsInStore, WhatIsNoSetIsRefused) {
    for (const char* bad : {"",
                            "x",
                            "-1",
                            "0",
                            "1+2+",
                            "+",
                            "1+2+3+7",
                            "1+2",
                            "3+2+1",
                            "1.5",
                            "99999999999999999999"}) {
        expectRefused(bad, ErrorKind::Usage);
    }
    expectRefused("8", ErrorKind::Quality);
    expectRefused("4", ErrorKind::Quality);  // of R2
}

TEST_F(CalibrationsInStore, MissingKindSaysWhatToRun) {
    const auto none = newestSet(*store, "R3");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::Quality);
    EXPECT_NE(none.error().message.find("gonio calibrate mirror"), std::string::npos);
}

/// Lens, reference, and a lens map that was taken since.
TEST(CalibrationReference, IsBinnedAgainWhereAnotherLensMapIsWanted) {
    const test::TempFolder folder;
    auto store = Store::open(folder.path());
    ASSERT_TRUE(store) << store.error().message;
    const auto keepLens = [&](const LensRecord& lens) {
        return *store->addCalibration({.rig = "R", .kind = "mirror", .dateUtc = "t"},
                                      {.file = encodeLens(lens), .raw = {}});
    };
    const LensRecord first = test::evenLens(4.0), second = test::evenLens(4.4);
    const CalibrationRecord firstMirror = keepLens(first);
    auto reference = [&]() -> Result<CalibrationRecord> {
        test::TempFolder raw;
        if (auto wrote =
                proc::writeGraw(raw / "r.graw", *proc::decodeGraw(test::uniformCapture({0}), "r"));
            !wrote) {
            return wrote.error();
        }
        const auto signals = binned(raw / "r.graw", {.lens = first});
        if (!signals) return signals.error();
        const auto bytes = encodeReference({{.name = "white"}, *signals}, {0_deg});
        if (!bytes) return bytes.error();
        return store->addCalibration({.rig = "R", .kind = "white", .dateUtc = "t"},
                                     {.file = *bytes, .raw = test::uniformCapture({0})});
    }();
    ASSERT_TRUE(reference) << reference.error().message;
    const CalibrationRecord secondMirror = keepLens(second);
    const auto asKept = readReference(*store, *reference, *viewOf(firstMirror, {}, {}));
    const auto again = readReference(*store, *reference, *viewOf(secondMirror, {}, {}));
    ASSERT_TRUE(asKept && again);
    // Radiance per solid angle goes with the square of the picture's scale.
    constexpr std::size_t kCell = 500;
    const double ratio = again->signals[0][0].signal[kCell] / asKept->signals[0][0].signal[kCell];
    EXPECT_NEAR(ratio, (4.4 * 4.4) / (4.0 * 4.0), 0.01);
    // With a flat field of 2 in all pixels there is half the light; the first lens's signals again.
    proc::FlatField flat{.response = Image<float>({700, 700}, 2.0F),
                         .window = {.size = {700, 700}}};
    const auto record = store->addCalibration({.rig = "R", .kind = "flat", .dateUtc = "t"},
                                              {.file = *encodeFlat(flat), .raw = {}});
    ASSERT_TRUE(record);
    const auto view = viewOf(firstMirror, *record, {});
    ASSERT_TRUE(view) << view.error().message;
    EXPECT_EQ(view->id, "1+4");
    const auto flattened = readReference(*store, *reference, *view);
    ASSERT_TRUE(flattened) << flattened.error().message;
    const double kept = asKept->signals[0][0].signal[kCell];
    EXPECT_NEAR(flattened->signals[0][0].signal[kCell], kept / 2, 1e-4 * kept);
    EXPECT_FALSE(flattened->signals[0][0].flags[kCell].has(Flag::DriftCorrected));
}

TEST(Corrections, SignalsAreThoseOfNominalLight) {
    const auto capture = proc::decodeGraw(test::uniformCapture({0}), "r");
    ASSERT_TRUE(capture);
    proc::RawState state = capture->states.front();
    state.bracket = {{.level = 65535, .frames = 1, .celsius = {27.0, {}, {}, {}}, .milliamp = 350},
                     {.level = 65535, .frames = 3, .celsius = {29.0, {}, {}, {}}, .milliamp = 350}};
    Corrections corrections;
    corrections.leds.emplace();
    corrections.leds->bands[index(Band::R)] = {.perKelvin = -0.01, .celsius = 27};
    EXPECT_NEAR(*lightOf(*corrections.leds, Band::R, state.bracket), 1 - 0.01 * 1.5, 1e-12);
    const LensRecord lens = test::evenLens(4);
    const Window& window = state.merged.window;
    const proc::Binning binning(lens.fit.map, window, kField);
    const proc::GlareFilter glare = glareFilterOf(lens, window);
    const auto plain = signalOf(state, {}, glare, binning);
    const auto steady = signalOf(state, corrections, glare, binning);
    constexpr std::size_t kCell = 500;
    EXPECT_NEAR(steady.signal[kCell], plain.signal[kCell] / 0.985, 1e-9 * plain.signal[kCell]);
    EXPECT_TRUE(steady.flags[kCell].has(Flag::DriftCorrected));
    state.bracket.front().celsius[0].reset();
    EXPECT_FALSE(lightOf(*corrections.leds, Band::R, state.bracket)) << "nothing tells";
    EXPECT_FALSE(lightOf(*corrections.leds, Band::R, {}));
    const auto untold = signalOf(state, corrections, glare, binning);
    EXPECT_EQ(untold.signal[kCell], plain.signal[kCell]);
    EXPECT_FALSE(untold.flags[kCell].has(Flag::DriftCorrected));
}

TEST(CalibrationReference, RawCaptureThatIsNoneIsNamed) {
    const auto none = binned("/no/such.graw", {.lens = test::evenLens(4)});
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("/no/such.graw"), std::string::npos);
    const test::TempFolder folder;
    ASSERT_TRUE(
        proc::writeGraw(folder / "r.graw", *proc::decodeGraw(test::uniformCapture({64}), "r")));
    EXPECT_EQ(binned(folder / "r.graw", {.lens = test::evenLens(4)}).error().kind, ErrorKind::File);
}

}  // namespace
}  // namespace gonio::daemon
