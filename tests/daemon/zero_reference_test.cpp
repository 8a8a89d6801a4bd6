// What a zero reference is worth, on the simulated rig, whose truth is known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "daemon/black_check.h"
#include "proc/core/median.h"
#include "tests/daemon/lab.h"

namespace gonio::daemon {
namespace {

/// How well a sample of one f everywhere was measured.
struct Seen {
    double medianError = 0;  ///< relative
    double medianU = 0;      ///< relative, k = 2
    double covered = 0;      ///< share of cells whose error is within 2 u
};

Seen seenOf(const proc::SampleSet& set, double truth) {
    std::vector<double> errors, uncertainties;
    double covered = 0;
    for (const proc::LedTable& led : set.leds) {
        for (const proc::CellSamples& band : led.bands) {
            for (std::size_t cell = 0; cell < band.size(); ++cell) {
                if (!band.present(cell)) continue;
                const double error = std::abs(band.f[cell] - truth);
                const double expanded = 2 * band.at(cell).u();
                errors.push_back(error / truth);
                uncertainties.push_back(expanded / truth);
                covered += error <= expanded ? 1 : 0;
            }
        }
    }
    const auto count = static_cast<double>(errors.size());
    EXPECT_GT(count, 100'000);
    return {median(errors), median(uncertainties), covered / count};
}

std::string lambert(double f) { return "lambert,albedo=" + std::to_string(f * kPi); }

class ZeroReference : public testing::Test {
protected:
    void SetUp() override {
        lab.calibrateMirror();
        lab.calibrateBlack();
        lab.calibrateWhite();
        lab.calibrateZero();
    }
    Seen measured(const Captured& captured, double f, bool zero) {
        const Seen seen = seenOf(lab.calibrated(captured.signals, zero), f);
        std::cout << "f = " << f << (zero ? ", zero" : ", black") << ": median error "
                  << 100 * seen.medianError << " %, U(k=2) " << 100 * seen.medianU
                  << " %, within it " << 100 * seen.covered << " %\n";
        return seen;
    }
    test::Lab lab{"none", "random", 1};
};

TEST_F(ZeroReference, MakesDarkSamplesLessUncertainAndStillCoversTheTruth) {
    for (const double f : {1e-3, 1e-2}) {
        const Captured captured = lab.captured(lambert(f), sampleBracket(Effort::Standard));
        const Seen black = measured(captured, f, false);
        const Seen zero = measured(captured, f, true);
        EXPECT_GT(black.covered, 0.9);
        EXPECT_GT(zero.covered, 0.9);
        // 3.2e-5 / sr of the black against 1e-5 / sr of the trap; noise and white are common to
        // both.
        EXPECT_LT(zero.medianU, f < 5e-3 ? black.medianU / 1.5 : black.medianU);
        EXPECT_LT(zero.medianError, black.medianU);
    }
}

TEST_F(ZeroReference, ReferenceEffortIsKnownTo1Point6PerCent) {
    // The goal of radiometry.md 4: total U(k=2) on f >= 0.01, which is worst at 0.01.
    const Captured captured = lab.captured(lambert(0.01), sampleBracket(Effort::Reference));
    const Seen zero = measured(captured, 0.01, true);
    EXPECT_LE(zero.medianU, 0.016);
    EXPECT_GT(zero.covered, 0.95);
}

TEST_F(ZeroReference, TheBlackIsAWitness) {
    const auto good = checkBlack(lab.references(true), lab.ledAngles());
    ASSERT_TRUE(good);
    EXPECT_TRUE(good->agrees()) << good->described();
    EXPECT_NEAR(good->u, std::hypot(0.1 * 0.001 / kPi, 1e-5), 1e-7);
    EXPECT_FALSE(checkBlack(lab.references(false), lab.ledAngles()));

    // A trap that gives back 1e-4 / sr more than it should: 3 u.
    const RigReferences references = lab.references(true);
    ReferenceRecord dusty = *references.zero;
    for (std::size_t led = 0; led < dusty.signals.size(); ++led) {
        proc::CellSignal& signal = dusty.signals[led][index(Band::G)];
        const proc::CellSignal& white = references.white.signals[led][index(Band::G)];
        for (std::size_t cell = 0; cell < signal.size(); ++cell)
            signal.signal[cell] += 1e-4 * kPi * white.signal[cell];
    }
    const auto bad = checkBlack({.lens = references.lens,
                                 .white = references.white,
                                 .black = references.black,
                                 .certified = references.certified,
                                 .profile = references.profile,
                                 .zero = &dusty},
                                lab.ledAngles());
    ASSERT_TRUE(bad);
    EXPECT_FALSE(bad->agrees()) << bad->described();
    proc::SampleInfo info;
    noteBlackCheck(bad, info);
    EXPECT_NE(info.extra["black_check"].find("do not agree"), std::string::npos);
    noteBlackCheck(std::nullopt, info);
    EXPECT_TRUE(info.extra.empty());
}

TEST_F(ZeroReference, MustBeDarkerThanBlack) {
    const RigReferences references = lab.references(true);
    EXPECT_TRUE(checkZero(references.zero->signals, references.black.signals));
    const auto swapped = checkZero(references.black.signals, references.zero->signals);
    ASSERT_FALSE(swapped);
    EXPECT_EQ(swapped.error().kind, ErrorKind::Quality);
    EXPECT_NE(swapped.error().message.find("light trap"), std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
