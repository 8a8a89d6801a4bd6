#include "proc/estimate/local_kriging.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

constexpr KrigingProcess kProcess{
    .length = 0.5, .incidenceWeight = 4, .grazing = 3, .fromMirror = true, .noise = 1e-4};

/// Pairs all over, a few at the normal, at the horizon and twice.
std::vector<KrigingPlace> somePlaces(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<KrigingPlace> places;
    const auto add = [&](const Direction& in, const Direction& out) {
        places.push_back(krigingPlace(kProcess, {.in = in, .out = out}));
    };
    const Direction flat = Direction::fromSpherical(89.999_deg, Radians(1));
    add(Direction(), Direction());
    add(flat, Direction());
    add(flat, flat);
    while (places.size() < count) {
        const Direction in = test::randomDirection(random);
        const Direction out = test::randomDirection(random);
        add(in, out);
        if (places.size() % 10 == 0) add(out, in);  // of the same place, exchanged
    }
    places.resize(count);
    return places;
}

TEST(LocalKriging, MatchesReference) {
    constexpr std::size_t kAll = 150;  // neighbours of each other
    const std::vector<KrigingPlace> places = somePlaces(kAll, 31);
    Eigen::VectorXd values(static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
        values(static_cast<Eigen::Index>(i)) = std::sin(3 * places[i].straight.sum());
    }
    const LocalKriging kriging(kProcess, places, values, kAll);
    for (const KrigingPlace& here : somePlaces(60, 32)) {
        for (const std::size_t count : {1U, 5U, 64U, 2000U}) {
            ASSERT_EQ(kriging.nearest(here, count), kriging.nearestByBruteForce(here, count));
        }
        // The same out of whole matrices.
        const std::size_t first = kriging.nearest(here, 1).front();
        const auto around = kriging.nearestByBruteForce(places[first], kAll);
        std::vector<KrigingPlace> at;
        Eigen::VectorXd y(kAll), alike(kAll);
        for (std::size_t i = 0; i < around.size(); ++i) {
            at.push_back(places[around[i]]);
            y(static_cast<Eigen::Index>(i)) = values(around[i]);
            alike(static_cast<Eigen::Index>(i)) = correlation(here, at.back());
        }
        Eigen::MatrixXd matrix = correlations(at);
        matrix.diagonal().array() += kProcess.noise;
        const Eigen::LDLT<Eigen::MatrixXd> factor(matrix);
        const Kriged kriged = kriging.at(here, first);
        // A condition of 64 / 1e-4 leaves nine digits.
        EXPECT_NEAR(kriged.value, alike.dot(factor.solve(y)), 1e-8);
        EXPECT_NEAR(kriged.unknown, 1 - alike.dot(factor.solve(alike)), 1e-8);
    }
}

double ofBothAngles(const LightView& pair) { return pair.in.z() * pair.out.z(); }

TEST(LocalKriging, KnowsTheOtherIncidencesOfSamplesThatStandDenseAtAFew) {
    // More than are kept, and far more at each incidence than an answer is made of.
    std::mt19937_64 random(35);
    std::vector<KrigingPlace> places;
    std::vector<double> values;
    const KrigingProcess process{.length = 1, .incidenceWeight = 1, .grazing = 1, .noise = 1e-6};
    for (const Radians incidence : {20_deg, 40_deg}) {
        for (std::size_t i = 0; i < 1500; ++i) {
            const LightView pair{.in = Direction::fromSpherical(incidence, Radians(0)),
                                 .out = test::randomDirection(random)};
            places.push_back(krigingPlace(process, pair));
            values.push_back(ofBothAngles(pair));
        }
    }
    ASSERT_GT(places.size(), LocalKriging::kMostKept);
    const LocalKriging kriging(
        process,
        places,
        Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())),
        80);
    for (const double degrees : {26.0, 34.0}) {
        const LightView pair{
            .in = Direction::fromSpherical(Radians::fromDegrees(degrees), Radians(0)),
            .out = Direction::fromSpherical(55_deg, Radians(2))};
        const KrigingPlace here = krigingPlace(process, pair);
        const Kriged kriged = kriging.at(here, kriging.nearest(here, 1).front());
        EXPECT_NEAR(kriged.value, ofBothAngles(pair), 3e-3) << degrees;
        EXPECT_LT(kriged.unknown, 1e-3) << degrees;
    }
}

}  // namespace
}  // namespace gonio::proc
