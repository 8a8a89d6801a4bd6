#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "daemon/calibrations.h"
#include "daemon/engine/job.h"
#include "daemon/measurement.h"
#include "proc/formats/gonio_exr.h"
#include "tests/daemon/uniform_capture.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::json;

constexpr Size kSize{180, 180};
constexpr float kBlack = 1, kGrey = 50, kWhite = 100;
const std::vector<int> kBothLeds{0, 1};

std::string raw(const std::vector<int>& leds, float radiance) {
    return test::uniformCapture(leds, radiance, kSize);
}

/// The sample "tile" of rig R under two LEDs, measured with the calibrations 1+2+3.
class StoredSample : public testing::Test {
protected:
    void SetUp() override {
        auto opened = Store::open(folder.path());
        ASSERT_TRUE(opened) << opened.error().message;
        store.emplace(std::move(*opened));
        auto read = readProfile(defaultProfile());
        ASSERT_TRUE(read) << read.error().message;
        profile = std::move(*read);
        profile.hash = "abc";
        keepLens(1.1);
        keepReference("black", kBothLeds, kBlack);
        keepReference("white", kBothLeds, kWhite);
        keepSample("1+2+3");
    }

    /// How the records of this store are made: signals as the first lens bins them.
    PlacementSignals signalsOf(const std::vector<int>& leds, float radiance) const {
        const test::TempFolder scratch;
        const auto file = scratch / "c.graw";
        EXPECT_TRUE(proc::writeGraw(file, *proc::decodeGraw(raw(leds, radiance), "c")));
        auto signals = binned(file, {.lens = test::evenLens(1.1, 90)});
        EXPECT_TRUE(signals) << signals.error().message;
        return signals ? std::move(*signals) : PlacementSignals();
    }
    void keepLens(double pixelsPerDegree) {
        ASSERT_TRUE(store->addCalibration(
            {.rig = "R", .kind = "mirror", .dateUtc = "t"},
            {.file = encodeLens(test::evenLens(pixelsPerDegree, 90)), .raw = {}}));
    }
    void keepReference(const std::string& kind, const std::vector<int>& leds, float radiance) {
        const PlacementSignals signals = signalsOf(kBothLeds, radiance);
        const std::size_t count = leds.size();
        const auto bytes = encodeReference(
            {.info = {.name = kind},
             .signals = {signals.begin(), signals.begin() + static_cast<std::ptrdiff_t>(count)}},
            {0_deg, 20_deg});
        ASSERT_TRUE(bytes) << bytes.error().message;
        ASSERT_TRUE(store->addCalibration(
            {.rig = "R", .kind = kind, .dateUtc = "t", .profileHash = profile.hash},
            {.file = *bytes, .raw = raw(leds, radiance)}));
    }
    void keepSample(const std::string& calibration) {
        const auto set = newestSet(*store, "R");
        ASSERT_TRUE(set) << set.error().message;
        const auto loaded = loadSet(*store, *set);
        ASSERT_TRUE(loaded) << loaded.error().message;
        const auto certified = loadReferences(profile);
        ASSERT_TRUE(certified) << certified.error().message;
        const auto sample = calibrateSample(
            signalsOf(kBothLeds, kGrey),
            {0_deg, 20_deg},
            {loaded->view.lens, loaded->white, loaded->black, *certified, profile},
            {.name = "tile", .rigSerial = "R", .profileHash = "abc", .calibrationId = calibration});
        const auto bytes = proc::encodeGonio(sample);
        ASSERT_TRUE(bytes) << bytes.error().message;
        ASSERT_TRUE(store->addSample({.name = "tile", .rig = "R", .dateUtc = "t"},
                                     {.file = *bytes, .raw = raw(kBothLeds, kGrey)}));
    }

    Result<std::string> again(
        const std::string& calibration = "",
        const std::function<Result<void>()>& goOn = [] { return Result<void>(); }) {
        const Desk desk{
            .store = *store, .profile = profile, .utcNow = [] { return "t"; }, .goOn = goOn};
        return recalibrate(
            desk, {.kind = JobKind::Recalibrate, .name = "tile", .calibration = calibration});
    }
    void expectRefused(const std::string& calibration, ErrorKind kind, const std::string& word) {
        const auto refused = again(calibration);
        ASSERT_FALSE(refused) << *refused;
        EXPECT_EQ(refused.error().kind, kind) << refused.error().message;
        EXPECT_NE(refused.error().message.find(word), std::string::npos) << refused.error().message;
    }

    test::TempFolder folder;
    std::optional<Store> store;
    RigProfile profile;
};

TEST_F(StoredSample, WithItsOwnCalibrationIsTheSame) {
    const auto same = again();
    ASSERT_TRUE(same) << same.error().message;
    EXPECT_EQ(Json::parse(*same)["calibration"], "1+2+3");
}

TEST_F(StoredSample, DrawsAreKeptWithItAndMakeItsUncertaintiesAgain) {
    const Desk desk{.store = *store, .profile = profile, .utcNow = [] { return "t"; }};
    const auto drawn =
        recalibrate(desk, {.kind = JobKind::Recalibrate, .name = "tile", .monteCarlo = 100});
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_FALSE(Json::parse(*drawn)["identical"]);
    const auto same = again();
    ASSERT_TRUE(same) << same.error().message;
    EXPECT_TRUE(Json::parse(*same)["identical"]) << "as it was worked out";
}

TEST_F(StoredSample, OneNumberTakesThePlaceOfItsKindInWhatItWasMeasuredWith) {
    keepReference("white", kBothLeds, kWhite);  // 4
    const auto with = again("4");
    ASSERT_TRUE(with) << with.error().message;
    EXPECT_EQ(Json::parse(*with)["calibration"], "1+2+4");
}

TEST_F(StoredSample, NoOtherCalibrationTakesThePlaceOfOneThatIsLost) {
    keepSample("1+2+9");  // a white that the store has not
    expectRefused("1", ErrorKind::Quality, "what the sample was measured with: calibration 9");
    const auto named = again("1+2+3");
    EXPECT_TRUE(named) << named.error().message;
}

TEST_F(StoredSample, OfAnOlderNameIsCompletedByTheNewest) {
    keepSample("R/2025-12-01");
    const auto with = again("3");
    ASSERT_TRUE(with) << with.error().message;
    EXPECT_EQ(Json::parse(*with)["calibration"], "1+2+3");
}

TEST_F(StoredSample, ItsSensorCannotBeExchangedNorTilesOfOtherFiguresBeUsed) {
    ASSERT_TRUE(store->addCalibration({.rig = "R", .kind = "sensor", .dateUtc = "t"},
                                      {.file = "{}", .raw = {}}));  // 4
    expectRefused("4", ErrorKind::Usage, "cannot be exchanged");
    expectRefused("1+2+3+4", ErrorKind::Usage, "cannot be exchanged");
    const auto same = again();
    ASSERT_TRUE(same) << same.error().message;
    EXPECT_EQ(Json::parse(*same)["calibration"], "1+2+3") << "the newest sensor is not its own";
    profile.hash = "abc/4";  // of the tiles that are taken from now on
    keepReference("white", kBothLeds, kWhite);
    const auto kept = store->sample("tile");
    ASSERT_TRUE(kept);
    const auto sample = proc::readGonio(kept->file);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->info.profileHash, "abc");
    expectRefused("", ErrorKind::Quality, "figures of the sensor");
}

TEST_F(StoredSample, IsLetBeWhenTheJobIsEndedMeanwhile) {
    const auto before = store->sample("tile");
    ASSERT_TRUE(before);
    keepReference("white", kBothLeds, 2 * kWhite);
    int asked = 0;
    const Error ended{ErrorKind::Interrupted, "cancelled"};
    const auto refused = again("", [&]() -> Result<void> {
        ++asked;
        return ended;
    });
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Interrupted);
    EXPECT_GT(asked, 0);
    EXPECT_EQ(store->sample("tile")->file, before->file);
    EXPECT_TRUE(again());
    EXPECT_NE(store->sample("tile")->file, before->file);
}

TEST_F(StoredSample, ReferenceOfFewerLedsIsRefused) {
    keepReference("white", {0}, kWhite);
    expectRefused("", ErrorKind::File, "white reference: 1 LEDs, wanted 2");
    keepReference("white", kBothLeds, kWhite);
    keepReference("black", {0}, kBlack);
    expectRefused("", ErrorKind::File, "black reference: 1 LEDs, wanted 2");
}

TEST_F(StoredSample, ReferenceWhoseRawCaptureLacksAStateIsRefused) {
    keepReference("white", kBothLeds, kWhite);  // 4
    std::string lacking = raw({1}, kWhite);
    {
        const auto record = store->calibration(4);
        ASSERT_TRUE(record && *record);
        std::filesystem::permissions((*record)->raw, std::filesystem::perms::owner_all);
        ASSERT_TRUE(proc::writeGraw((*record)->raw, *proc::decodeGraw(lacking, "r")));
    }
    keepLens(1.05);  // 5: references are binned again
    expectRefused("", ErrorKind::File, "white calibration 4: ");
    expectRefused("", ErrorKind::File, "LED 0 r is missing");
}

}  // namespace
}  // namespace gonio::daemon
