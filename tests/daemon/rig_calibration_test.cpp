#include "daemon/rig_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "daemon/calibrations.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

LensRecord lensRecord() {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(8, 8) * 1e-8;
    covariance(0, 1) = covariance(1, 0) = 1e-9;
    return {.fit = {.map = proc::LensMap({.centreX = 641.25,
                                          .centreY = 508.5,
                                          .rotation = 0.01,
                                          .a = 1e-3,
                                          .b = -2e-3,
                                          .c1 = 1.32,
                                          .c3 = 0.02,
                                          .c5 = -0.003}),
                    .covariance = covariance,
                    .rmsPixels = 0.02,
                    .worstPixels = 0.05},
            .spots = 20,
            .dateUtc = "2026-01-02T03:04:05Z",
            .glare = proc::GlareSpread{.everywhere = 0.001,
                                       .halo = 0.002,
                                       .radius = 70.5,
                                       .exponent = 1.25,
                                       .uShare = 1e-5,
                                       .uRelative = 0.3}};
}

/// One LED whose cells hold their own number; the last cell is blocked.
PlacementSignals signals() {
    auto signal = proc::CellSignal::missing(proc::CellGrid::count());
    for (std::size_t cell = 0; cell + 1 < signal.size(); ++cell) {
        signal.signal[cell] = static_cast<double>(cell) - 5;
        signal.variance[cell] = 4;
        signal.nEff[cell] = 40;
        signal.uGlare[cell] = 0.25;
        signal.flags[cell] = Flags{Flag::Measured};
    }
    signal.flags.back() = Flags{Flag::Blocked};
    return {{signal, signal, signal}};
}

class RigCalibrationInStore : public testing::Test {
protected:
    void SetUp() override {
        auto opened = Store::open(folder.path());
        ASSERT_TRUE(opened) << opened.error().message;
        store.emplace(std::move(*opened));
    }
    void keep(const std::string& kind, const std::string& bytes) {
        const auto added = store->addCalibration({.rig = "R1", .kind = kind, .dateUtc = "today"},
                                                 {.file = bytes, .raw = {}});
        ASSERT_TRUE(added) << added.error().message;
    }
    test::TempFolder folder;
    std::optional<Store> store;
};

TEST_F(RigCalibrationInStore, LensSurvivesToTheLastBit) {
    const LensRecord lens = lensRecord();
    keep("mirror", encodeLens(lens));
    const auto mirror = newestOf(*store, "R1", "mirror");
    ASSERT_TRUE(mirror) << mirror.error().message;
    const auto read = readLens(*mirror);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->fit.map.parameters(), lens.fit.map.parameters());
    EXPECT_EQ(read->fit.covariance, lens.fit.covariance);
    EXPECT_EQ(read->fit.rmsPixels, lens.fit.rmsPixels);
    EXPECT_EQ(read->fit.worstPixels, lens.fit.worstPixels);
    EXPECT_EQ(read->spots, lens.spots);
    EXPECT_EQ(read->dateUtc, lens.dateUtc);
}

TEST_F(RigCalibrationInStore, MissingAndBrokenLensSayWhatToRun) {
    const auto missing = newestOf(*store, "R1", "mirror");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().kind, ErrorKind::Quality);
    EXPECT_NE(missing.error().message.find("gonio calibrate mirror"), std::string::npos);
    for (const std::string bad : {"", "{", "[]", R"({"schema":"gonio/lens/1","values":[1,2]})"}) {
        const auto broken = decodeLens(bad, "lens map of R1");
        ASSERT_FALSE(broken) << bad;
        EXPECT_EQ(broken.error().kind, ErrorKind::File);
        EXPECT_NE(broken.error().message.find("lens map of R1"), std::string::npos);
        EXPECT_NE(broken.error().message.find("gonio calibrate mirror"), std::string::npos);
    }
}

TEST_F(RigCalibrationInStore, ReferenceSurvivesToFloatPrecision) {
    const PlacementSignals kept = signals();
    const proc::SampleInfo info{.name = "white", .rigSerial = "R1"};
    const auto bytes = encodeReference({info, kept}, {20_deg});
    ASSERT_TRUE(bytes) << bytes.error().message;
    keep("mirror", encodeLens(lensRecord()));
    keep("white", *bytes);
    const auto mirror = newestOf(*store, "R1", "mirror");
    const auto white = newestOf(*store, "R1", "white");
    ASSERT_TRUE(mirror && white);
    const auto read = readReference(*store, *white, *viewOf(*mirror, {}, {}));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->info.rigSerial, "R1");
    ASSERT_EQ(read->signals.size(), 1U);
    for (Band band : kBands) {
        const proc::CellSignal& a = kept[0][index(band)];
        const proc::CellSignal& b = read->signals[0][index(band)];
        ASSERT_EQ(b.size(), a.size());
        for (std::size_t cell = 0; cell < a.size(); ++cell) {
            ASSERT_EQ(b.flags[cell], a.flags[cell]);
            if (!a.present(cell)) {
                EXPECT_TRUE(std::isnan(b.signal[cell]) && std::isnan(b.variance[cell]));
                continue;
            }
            // All of these fit a float: whole numbers below 2^24 and 2 = sqrt(4).
            ASSERT_EQ(b.signal[cell], a.signal[cell]);
            ASSERT_EQ(b.variance[cell], a.variance[cell]);
            ASSERT_EQ(b.nEff[cell], a.nEff[cell]);
        }
    }
}

TEST_F(RigCalibrationInStore, MissingReferenceSaysWhatToRun) {
    const auto read = newestOf(*store, "R1", "black");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().kind, ErrorKind::Quality);
    EXPECT_NE(read.error().message.find("gonio calibrate black"), std::string::npos);
    EXPECT_EQ(decodeReference("no picture", "x").error().kind, ErrorKind::File);
}

}  // namespace
}  // namespace gonio::daemon
