#pragma once
// An engine's tests: a store, a rig that only a person can put things under, and its calibration.

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>

#include "daemon/engine/engine.h"
#include "daemon/rig_calibration.h"
#include "proc/optics/cell_grid.h"
#include "tests/daemon/engine/running_engine.h"
#include "tests/daemon/engine/test_rig.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {

inline const JobRequest kMirrorJob{.kind = JobKind::CalibrateMirror};

/// A store, and a rig of the kind that only a person can put things under.
class EngineOnRig : public testing::Test {
protected:
    std::int64_t submit(test::RunningEngine& engine, const JobRequest& request = kMirrorJob) {
        const auto job = engine->submit(request);
        EXPECT_TRUE(job) << job.error().message;
        return job ? job->id : 0;
    }
    JobRecord kept(std::int64_t job) {
        auto book = Logbook::open(folder.path());
        const auto found = book->job(job);
        EXPECT_TRUE(found) << found.error().message;
        return found ? *found : JobRecord{};
    }
    /// An engine whose job stands still at its first look at the rig.
    std::int64_t submitHeld(test::RunningEngine& engine) {
        engine.await(EngineState::Idle);
        test::Watcher watcher(*engine);
        port.cable.hold();
        const auto job = submit(engine);
        watcher.until("rig", {{"state", "running"}});
        return job;
    }
    test::TempFolder folder;
    test::TestPort port;
};

inline LensRecord lensRecord() {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(8, 8) * 1e-8;
    covariance(0, 1) = covariance(1, 0) = 1e-9;
    return {.fit = {.map = proc::LensMap::fTheta({640, 512}, 6.6),
                    .covariance = covariance,
                    .rmsPixels = 0.02,
                    .worstPixels = 0.05},
            .spots = 20,
            .dateUtc = "t"};
}

/// A rig calibrated as far as a check of its white needs: the signals are far above what a white
/// tile gives, so that it has changed by less than 100 %.
inline void calibrate(const std::filesystem::path& root) {
    auto store = Store::open(root);
    ASSERT_TRUE(store) << store.error().message;
    ASSERT_TRUE(store->addCalibration({.rig = "SIM-0001", .kind = "mirror", .dateUtc = "t"},
                                      {.file = encodeLens(lensRecord()), .raw = {}}));
    auto signal = proc::CellSignal::missing(proc::CellGrid::count());
    for (std::size_t cell = 0; cell < signal.size(); ++cell) {
        signal.signal[cell] = 1e15;
        signal.variance[cell] = 1;
        signal.nEff[cell] = 1;
        signal.flags[cell] = Flags{Flag::Measured};
    }
    const PlacementSignals white(4, {signal, signal, signal});
    const auto bytes = encodeReference({{}, white}, {0_deg, 20_deg, 40_deg, 60_deg});
    ASSERT_TRUE(bytes) << bytes.error().message;
    ASSERT_TRUE(store->addCalibration({.rig = "SIM-0001", .kind = "white", .dateUtc = "t"},
                                      {.file = *bytes, .raw = {}}));
}

}  // namespace gonio::daemon
