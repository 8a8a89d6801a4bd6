#include "proc/table/scattered_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "proc/table/neighbour_study.h"
#include "tests/support/random_directions.h"
#include "tests/support/retroreflective.h"

namespace gonio::proc {
namespace {

constexpr std::array<PairSymmetry, 3> kSymmetries{
    PairSymmetry::None, PairSymmetry::Isotropic, PairSymmetry::Plane};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

ScatteredSample sampleAt(const LightView& pair, double f = 0.3) {
    return {.pair = pair, .f = LedBands::all(f), .uRandom = {}, .uSystematic = {}};
}

LightView pairAt(double thetaInDeg, double thetaOutDeg, double phiDeg = 0) {
    return {.in = Direction::fromSpherical(Radians::fromDegrees(thetaInDeg), Radians(0)),
            .out = Direction::fromSpherical(Radians::fromDegrees(thetaOutDeg),
                                            Radians::fromDegrees(phiDeg))};
}

/// One of 9^4 pairs of a coarse grid, the normal and the horizon among them: many are equal, and
/// many distances too.
LightView coarsePair(std::mt19937_64& random) {
    const auto step = [&](double degrees) {
        return Radians::fromDegrees(degrees * static_cast<double>(random() % 9));
    };
    return {.in = Direction::fromSpherical(step(11.25), step(40)),
            .out = Direction::fromSpherical(step(11.25), step(40))};
}

/// What can be asked of a set, with small and large numbers and with limits that bite.
NeighbourQuery randomQuery(std::mt19937_64& random) {
    const std::size_t counts[] = {0, 1, 2, 10, 60, 5000};
    const double limits[] = {0, 0.05, 0.4, 1.2, kInfinity};
    return {.count = counts[random() % 6], .maxDistance = limits[random() % 5]};
}

TEST(ScatteredSet, MatchesBruteForceThroughRandomAddsAndRemoves) {
    constexpr std::uint64_t kSeed = 20261130;
    for (const PairSymmetry symmetry : kSymmetries) {
        SCOPED_TRACE(testing::Message() << "seed " << kSeed);
        std::mt19937_64 random(kSeed);
        ScatteredSet set(symmetry);
        std::size_t answers = 0;
        for (int i = 0; i < 6000; ++i) {
            // It grows, and shrinks from the 4000th step on.
            if (random() % 10 < (i < 4000 ? 8U : 2U)) {
                const LightView pair = random() % 2 == 0 ? coarsePair(random)
                                                         : LightView{test::randomDirection(random),
                                                                     test::randomDirection(random)};
                ASSERT_TRUE(set.add(sampleAt(pair)));
            } else if (!set.empty()) {
                const auto ids = set.ids();
                ASSERT_TRUE(set.remove(ids[random() % ids.size()]));
            }
            if (i % 5 != 0) continue;
            const LightView at = coarsePair(random);
            const NeighbourQuery query = randomQuery(random);
            const auto found = set.nearest(at, query);
            ASSERT_EQ(found, set.nearestByBruteForce(at, query)) << "step " << i;
            answers += found.size();
        }
        EXPECT_GT(answers, 10'000U);
    }
}

TEST(ScatteredSet, OrdersByDistanceThenId) {
    for (const PairSymmetry symmetry : kSymmetries) {
        ScatteredSet set(symmetry);
        std::vector<ScatteredSample> samples(200, sampleAt(pairAt(20, 30)));
        samples[150] = sampleAt(pairAt(20, 31));
        ASSERT_TRUE(set.add(samples));
        const auto found = set.nearest(pairAt(20, 31), {.count = 4});
        ASSERT_EQ(found.size(), 4U);
        EXPECT_EQ(found[0], (Neighbour{150, 0}));
        for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(found[i].id, i - 1);
    }
}

TEST(ScatteredSet, HoldsOneSample) {
    ScatteredSet set;
    ASSERT_TRUE(set.add(sampleAt(pairAt(0, 0), 2.5)));
    EXPECT_EQ(set.size(), 1U);
    EXPECT_EQ(set.nearest(pairAt(90, 90), {.count = 10}).size(), 1U);
    EXPECT_EQ(set.nearest(pairAt(0, 0), {.count = 1, .maxDistance = 0}).size(), 1U);
    EXPECT_TRUE(set.nearest(pairAt(0, 1), {.count = 1, .maxDistance = 0}).empty());
    EXPECT_TRUE(set.nearest(pairAt(0, 0), {.count = 0}).empty());
    EXPECT_TRUE(set.nearest(pairAt(0, 0), {.count = 1, .maxDistance = -1}).empty());
    EXPECT_TRUE(set.nearest(pairAt(0, 0), {.count = 1, .maxDistance = std::nan("")}).empty());
    ASSERT_NE(set.find(0), nullptr);
    EXPECT_EQ(set.find(0)->f[Band::G], 2.5);
    EXPECT_EQ(set.find(1), nullptr);
}

TEST(ScatteredSet, TakesTheLimitIn) {
    for (const std::size_t others : {0U, 500U}) {  // walked through, and by the tree
        ScatteredSet set;
        ASSERT_TRUE(set.add(sampleAt(pairAt(0, 0))));
        ASSERT_TRUE(set.add(std::vector(others, sampleAt(pairAt(0, 80)))));
        const double distance = set.nearest(pairAt(90, 0), {}).front().distance;
        EXPECT_NEAR(distance, std::sqrt(2.0), 1e-15);
        const double above = std::nextafter(distance, 2.0);
        EXPECT_EQ(set.nearest(pairAt(90, 0), {.count = 1, .maxDistance = above}).size(), 1U);
        EXPECT_TRUE(set.nearest(pairAt(90, 0), {.count = 1, .maxDistance = 1.414}).empty());
    }
}

TEST(ScatteredSet, AnswersAllWhereMoreAreWanted) {
    ScatteredSet set(PairSymmetry::Isotropic);
    ASSERT_TRUE(set.add(rigLikeSamples(300, 1)));
    const auto all = set.nearest(pairAt(45, 45), {.count = 1'000'000});
    EXPECT_EQ(all.size(), 300U);
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end(), [](const auto& a, const auto& b) {
        return a.distance < b.distance;
    }));
}

TEST(ScatteredSet, KeepsNormalAndHorizonApart) {
    for (const PairSymmetry symmetry : kSymmetries) {
        ScatteredSet set(symmetry);
        std::vector<ScatteredSample> samples;
        for (int phi = 0; phi < 360; ++phi) {
            samples.push_back(sampleAt(pairAt(0, 90, phi)));
            samples.push_back(sampleAt(pairAt(90, 0, phi)));
        }
        ASSERT_TRUE(set.add(samples));
        const auto found = set.nearest(pairAt(0, 90, 77), {.count = 1});
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NEAR(found.front().distance, 0, 1e-15);
        EXPECT_EQ(found.front().id % 2, 0U);
        const auto close = set.nearest(pairAt(0, 90, 77), {.count = 1000, .maxDistance = 1e-12});
        // By symmetry all azimuths about the normal are the same pair.
        EXPECT_EQ(close.size(), symmetry == PairSymmetry::None ? 1U : 360U);
    }
}

TEST(ScatteredSet, IsEmptyAfterRemovalOfEverythingAndFillsAgain) {
    ScatteredSet set(PairSymmetry::Isotropic);
    ASSERT_TRUE(set.add(rigLikeSamples(500, 2)));
    for (const SampleId id : set.ids()) {
        ASSERT_TRUE(set.remove(id));
        EXPECT_FALSE(set.remove(id));
        EXPECT_EQ(set.find(id), nullptr);
    }
    EXPECT_TRUE(set.empty());
    EXPECT_TRUE(set.ids().empty());
    EXPECT_TRUE(set.nearest(pairAt(10, 10), {.count = 5}).empty());
    EXPECT_EQ(set.treeBytes(), 0U);
    const auto id = set.add(sampleAt(pairAt(10, 10)));
    ASSERT_TRUE(id);
    EXPECT_EQ(*id, 500U);  // never given twice
    EXPECT_EQ(set.nearest(pairAt(10, 11), {.count = 5}).size(), 1U);
}

TEST(ScatteredSet, CopiesAreApart) {
    ScatteredSet set;
    ASSERT_TRUE(set.add(rigLikeSamples(200, 3)));
    ScatteredSet copy = set;
    ASSERT_TRUE(copy.remove(7));
    ASSERT_TRUE(copy.add(sampleAt(pairAt(1, 1))));
    EXPECT_EQ(set.size(), 200U);
    EXPECT_NE(set.find(7), nullptr);
    const LightView at = pairAt(1, 1);
    EXPECT_EQ(set.nearest(at, {.count = 9}), set.nearestByBruteForce(at, {.count = 9}));
    EXPECT_EQ(copy.nearest(at, {.count = 9}), copy.nearestByBruteForce(at, {.count = 9}));
    EXPECT_EQ(copy.nearest(at, {.count = 1}).front().id, 200U);
}

TEST(ScatteredSet, RefusesWhatIsNotANumberAtTheDoor) {
    const double nan = std::nan("");
    ScatteredSample band = sampleAt(pairAt(1, 2));
    band.f[Band::B] = nan;
    ScatteredSample huge = sampleAt(pairAt(1, 2), kInfinity);
    ScatteredSample random = sampleAt(pairAt(1, 2));
    random.uRandom = LedBands::all(nan);
    ScatteredSample negative = sampleAt(pairAt(1, 2));
    negative.uSystematic = LedBands::all(-1e-9);
    for (const ScatteredSample& bad : {band, huge, random, negative}) {
        ScatteredSet set;
        const auto added = set.add(std::vector{sampleAt(pairAt(3, 4)), bad});
        ASSERT_FALSE(added);
        EXPECT_EQ(added.error().kind, ErrorKind::File);
        EXPECT_NE(added.error().message.find("sample 2 of 2"), std::string::npos);
        EXPECT_TRUE(set.empty());  // all or none
    }
}

TEST(ScatteredSet, KeepsNoiseAtAndBelowZero) {
    ScatteredSet set;
    ASSERT_TRUE(set.add(sampleAt(pairAt(1, 2), 0)));
    ASSERT_TRUE(set.add(sampleAt(pairAt(1, 3), -2e-4)));
    EXPECT_EQ(set.find(0)->f[Band::R], 0);
    EXPECT_EQ(set.find(1)->f[Band::R], -2e-4);
}

TEST(ScatteredSet, AnswersSeveralThreadsAtOnce) {
    ScatteredSet set(PairSymmetry::Isotropic);
    ASSERT_TRUE(set.add(rigLikeSamples(5000, 4)));
    ASSERT_TRUE(set.add(rigLikeSamples(40, 5)));  // pending ones too
    const auto queries = rigLikeSamples(200, 6);
    std::vector<std::vector<Neighbour>> alone;
    for (const auto& query : queries) alone.push_back(set.nearest(query.pair, {.count = 10}));
    std::array<bool, 4> same{};
    {
        std::vector<std::jthread> threads;
        for (bool& ok : same) {
            threads.emplace_back([&] {
                ok = true;
                for (std::size_t i = 0; i < queries.size(); ++i) {
                    ok = ok && set.nearest(queries[i].pair, {.count = 10}) == alone[i];
                }
            });
        }
    }
    for (const bool ok : same) EXPECT_TRUE(ok);
}

TEST(ScatteredSet, MatchesBruteForceOnARetroreflectiveTape) {
    const auto samples = test::retroreflectiveTape();
    if (samples.empty()) return;
    EXPECT_EQ(samples.size(), 7311U);  // of 7397: 86 lie on the horizon
    for (const PairSymmetry symmetry : kSymmetries) {
        ScatteredSet set(symmetry);
        ASSERT_TRUE(set.add(samples));
        for (std::size_t i = 0; i < samples.size(); i += 97) {
            const LightView& at = samples[i].pair;
            const NeighbourQuery query{.count = 12, .maxDistance = 0.3};
            const auto found = set.nearest(at, query);
            EXPECT_EQ(found, set.nearestByBruteForce(at, query));
            ASSERT_FALSE(found.empty());
            EXPECT_EQ(found.front().distance, 0);
        }
    }
}

}  // namespace
}  // namespace gonio::proc
