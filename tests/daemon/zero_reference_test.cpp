// What a zero reference is worth, on the simulated rig, whose truth is known.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "daemon/black_check.h"
#include "proc/core/median.h"
#include "proc/core/number_text.h"
#include "tests/daemon/lab.h"

namespace gonio::daemon {
namespace {

using Lower = test::Lab::Lower;

/// How well a sample of one f everywhere was measured.
struct How {
    double medianError = 0;  ///< relative
    double medianU = 0;      ///< relative, k = 2
    double covered = 0;      ///< share of cells whose error is within 2 u
};

How howWell(const proc::SampleSet& set, double truth) {
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

std::string lambert(double f) { return "lambert,albedo=" + shortest(f * kPi); }

How measured(const test::Lab& lab, const test::Lab::Seen& sample, double f, Lower lower) {
    const How how = howWell(lab.calibrated(sample, lower), f);
    std::cout << "f = " << f << (lower == Lower::Zero ? ", zero" : ", black") << ": median error "
              << 100 * how.medianError << " %, U(k=2) " << 100 * how.medianU << " %, within it "
              << 100 * how.covered << " %\n";
    return how;
}

/// At 1e-3 / sr, where 3.2e-5 / sr of the black stand against 1e-5 / sr of the trap.
void expectDarkSamplesAreLessUncertain(test::Lab& lab) {
    const test::Lab::Seen seen = lab.seen(lambert(1e-3), {.frames = 1});
    const How black = measured(lab, seen, 1e-3, Lower::Black);
    const How zero = measured(lab, seen, 1e-3, Lower::Zero);
    EXPECT_GT(black.covered, 0.9);
    EXPECT_GT(zero.covered, 0.9);
    EXPECT_LT(zero.medianU, black.medianU / 1.5);
}

/// The goal of radiometry.md 4: total U(k=2) on f >= 0.01, which is worst at 0.01.
void expectReferenceEffortReaches1Point6PerCent(test::Lab& lab) {
    const test::Lab::Seen seen = lab.seen(lambert(0.01), {.frames = 8});
    const How black = measured(lab, seen, 0.01, Lower::Black);
    const How zero = measured(lab, seen, 0.01, Lower::Zero);
    EXPECT_LT(zero.medianU, black.medianU);
    EXPECT_LE(zero.medianU, 0.016);
    EXPECT_GT(zero.covered, 0.95);
}

/// A trap that gives back 1e-4 / sr more than it should: three times what black and trap may be
/// apart.
ReferenceRecord dusty(const RigReferences& references) {
    ReferenceRecord trap = *references.zero;
    for (std::size_t led = 0; led < trap.signals.size(); ++led) {
        proc::CellSignal& signal = trap.signals[led][index(Band::G)];
        const proc::CellSignal& white = references.white.signals[led][index(Band::G)];
        for (std::size_t cell = 0; cell < signal.size(); ++cell)
            signal.signal[cell] += 1e-4 * kPi * white.signal[cell];
    }
    return trap;
}

void expectTheBlackIsAWitness(const test::Lab& lab) {
    EXPECT_FALSE(checkBlack(lab.references(Lower::Black), lab.ledAngles()));
    RigReferences references = lab.references(Lower::Zero);
    const auto good = checkBlack(references, lab.ledAngles());
    ASSERT_TRUE(good);
    EXPECT_TRUE(good->agrees()) << good->described();
    EXPECT_NEAR(good->u, std::hypot(0.1 * 0.001 / kPi, 1e-5), 1e-7);

    const ReferenceRecord dirty = dusty(references);
    references.zero = &dirty;
    const auto bad = checkBlack(references, lab.ledAngles());
    ASSERT_TRUE(bad);
    EXPECT_FALSE(bad->agrees()) << bad->described();
    proc::SampleInfo info;
    noteBlackCheck(bad, info);
    EXPECT_NE(info.extra["black_check"].find("do not agree"), std::string::npos);
    noteBlackCheck(std::nullopt, info);
    EXPECT_TRUE(info.extra.empty());
}

void expectATrapIsDarkerThanBlack(const test::Lab& lab) {
    const RigReferences references = lab.references(Lower::Zero);
    EXPECT_TRUE(checkZero(references.zero->signals, references.black.signals));
    const auto swapped = checkZero(references.black.signals, references.zero->signals);
    ASSERT_FALSE(swapped);
    EXPECT_EQ(swapped.error().kind, ErrorKind::Quality);
    EXPECT_NE(swapped.error().message.find("light trap"), std::string::npos);
}

TEST(ZeroReferenceOnSim, MakesDarkSamplesLessUncertainAndStillCoversTheTruth) {
    if (std::getenv("GONIO_NIGHTLY") == nullptr) GTEST_SKIP() << "a nightly study of a minute";
    test::Lab lab("none", "random", 1, 4);
    lab.calibrateMirror();
    lab.calibrateBlack();
    lab.calibrateWhite();
    lab.calibrateZero();
    expectATrapIsDarkerThanBlack(lab);
    expectTheBlackIsAWitness(lab);
    expectDarkSamplesAreLessUncertain(lab);
    expectReferenceEffortReaches1Point6PerCent(lab);
}

}  // namespace
}  // namespace gonio::daemon
