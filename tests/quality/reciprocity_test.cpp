#include "proc/quality/reciprocity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/models/spec.h"
#include "tests/support/sample_sets.h"

namespace gonio::proc {
namespace {

SampleSet seen(const std::string& spec) {
    const auto surface = makeModel(spec);
    EXPECT_TRUE(surface) << surface.error().message;
    return test::sampleSet([&](Radians incidence, const Direction& wo) {
        return (*surface)->answer({Direction::fromSpherical(incidence, Radians(0)), wo}).f[Band::G];
    });
}

void brighten(LedTable& led, double factor) {
    for (CellSamples& band : led.bands) {
        for (double& f : band.f) f *= factor;
    }
}

TEST(Reciprocity, SixPairsOfLedsOnBothSidesInThreeBands) {
    const auto pairs = reciprocalPairs(seen("lambert,albedo=0.5"));
    EXPECT_EQ(pairs.size(), 6U * 2 * 3);
    for (const ReciprocalPair& pair : pairs) {
        EXPECT_NEAR(pair.difference, 0, 1e-9);
        // 2 % common to a picture's cells and 1 % in each, two pictures, relative to their mean; of
        // twice and three times as much f in G and B.
        const double share = 1.0 / (1.0 + static_cast<double>(index(pair.band)));
        EXPECT_GT(pair.u, share * 0.02 * std::sqrt(2));
        EXPECT_LT(pair.u, share * std::hypot(0.02, 0.01) * std::sqrt(2));
    }
}

TEST(Reciprocity, ReciprocalSurfacesPassGlossyOnesToo) {
    // Bilinear between cells: of f's curvature within one degree, at most some tenths of a per
    // cent.
    for (const char* spec : {"lambert,albedo=0.3",
                             "oren-nayar,albedo=0.8,sigma=0.3",
                             "lambert,albedo=0.1+ggx,alpha=0.2,f0=0.04",
                             "ggx,alpha=0.05,f0=0.9"}) {
        const Verdict verdict = reciprocityVerdict(seen(spec));
        EXPECT_EQ(verdict.grade, Grade::Ok) << spec << ": " << described(verdict);
        ASSERT_TRUE(verdict.figure) << spec;
        EXPECT_LT(verdict.figure->value, 0.01) << spec;
    }
}

TEST(Reciprocity, AnLedThatSaysMoreThanTheOthersIsWarnedOfAndThenRefused) {
    // One LED of four is in half of the pairs, so that the median is that of its pairs when two
    // are.
    for (const auto& [factor, grade] : {std::pair(1.02, Grade::Ok),
                                        std::pair(1.12, Grade::Warned),
                                        std::pair(1.5, Grade::Refused)}) {
        SampleSet sample = seen("lambert,albedo=0.5");
        brighten(sample.leds[0], factor);
        brighten(sample.leds[1], factor);
        const Verdict verdict = reciprocityVerdict(sample);
        EXPECT_EQ(verdict.grade, grade) << described(verdict);
        EXPECT_EQ(verdict.next.empty(), grade == Grade::Ok);
    }
}

TEST(Reciprocity, LargeUncertaintiesExplainLargeDifferences) {
    SampleSet sample = seen("lambert,albedo=0.5");
    brighten(sample.leds[0], 1.3);
    brighten(sample.leds[1], 1.3);
    for (LedTable& led : sample.leds) {
        for (CellSamples& band : led.bands) {
            for (double& u : band.uSystematic) u *= 10;
        }
    }
    EXPECT_EQ(reciprocityVerdict(sample).grade, Grade::Ok);
}

TEST(Reciprocity, OneLedAloneDeterminesNothing) {
    SampleSet sample = seen("lambert,albedo=0.5");
    sample.leds.resize(1);
    EXPECT_EQ(reciprocityVerdict(sample).grade, Grade::NotDetermined);
    EXPECT_EQ(reciprocityVerdict({}).grade, Grade::NotDetermined);
}

}  // namespace
}  // namespace gonio::proc
