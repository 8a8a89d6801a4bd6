// Whether the prior's posterior is as wrong as it says: materials of the library's kind that it has
// not seen, measured with 1 % of noise, and asked between and beyond the angles. Seven; 330 with
// GONIO_NIGHTLY.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <random>

#include "proc/estimate/interpolation_study.h"
#include "proc/estimate/prior_method.h"
#include "proc/estimate/sample_estimator.h"
#include "proc/fit/thinned_rows.h"
#include "proc/models/spec.h"
#include "tests/fit/simulated.h"

namespace gonio::proc {
namespace {

/// Pairs over the hemisphere of both, to 80 and 89 degrees.
std::vector<LightView> asked(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto direction = [&](double mostDeg) {
        const double least = std::cos(mostDeg * kPi / 180);
        return Direction::fromSpherical(Radians(std::acos(1 - unit(random) * (1 - least))),
                                        Radians(2 * kPi * unit(random)));
    };
    std::vector<LightView> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const Direction wi = direction(80);
        pairs.push_back({.in = wi, .out = direction(89)});
    }
    return pairs;
}

SamplePrior judged(const Scatterer& surface, std::uint64_t seed) {
    return {standardPrior(), test::noisy(test::simulated(surface, 1500, {0.01, 1e-6}), seed)};
}

struct Tally {
    int passed = 0;
    double within = 0;  ///< of 1.96 deviations
    double values = 0;
};

void add(Tally& tally, const Scatterer& truth, const SamplePrior& prior, std::uint64_t seed) {
    ++tally.passed;
    const auto method = prior.method();
    for (const LightView& pair : asked(100, seed)) {
        const double f = truth.answer(pair).f[Band::R];
        if (f < 1e-5) continue;  // darker than a rig measures
        const MethodAnswer answer = method->at(withLightAtZero(pair));
        if (std::abs(answer.f[Band::R] - f) <= 1.96 * answer.uRandom[Band::R]) ++tally.within;
        ++tally.values;
    }
}

TEST(PriorCoverage, IsWhatItSaysForMaterialsItHasNotSeen) {
    // A library of one's own gets as many functions as the standard one, whose coverage this is.
    EXPECT_EQ(standardPrior()->size(), PriorBasis::kFunctions);
    const bool nightly = std::getenv("GONIO_NIGHTLY") != nullptr;
    const std::size_t count = nightly ? 330 : 7;
    Tally tally;
    std::uint64_t seed = 1000;
    for (const std::string& spec : PriorLibrary::standard(count, 20261130).specs) {
        const auto truth = std::move(*makeModel(spec));
        const SamplePrior prior = judged(*truth, ++seed);
        if (prior.passes()) add(tally, *truth, prior, seed);
    }
    const double coverage = tally.within / tally.values;
    std::cout << "gate passed by " << tally.passed << " of " << count
              << "; within 1.96 u: " << 100 * coverage << " % of " << tally.values << "\n";
    EXPECT_GE(tally.passed, static_cast<int>(0.85 * static_cast<double>(count)));
    // Answers of one material err together: seven of them say less.
    EXPECT_GT(coverage, nightly ? 0.93 : 0.88);
    EXPECT_LT(coverage, nightly ? 0.97 : 1.0);
}

TEST(PriorCoverage, RefusesEveryMaterialOutsideOfTheLibrary) {
    for (const StudyMaterial& material : studyMaterials()) {
        const SamplePrior prior = judged(*material.truth, 77);
        EXPECT_EQ(prior.passes(), material.inLibrary) << material.name;
    }
}

}  // namespace
}  // namespace gonio::proc
