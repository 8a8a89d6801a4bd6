#include "proc/estimate/scattered_estimator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <random>
#include <sstream>

#include "proc/fit/data_maker.h"
#include "proc/models/spec.h"
#include "tests/support/data_file.h"
#include "tests/support/random_directions.h"

namespace gonio::proc {
namespace {

struct Point {
    LightView pair;
    double f;
};

LightView pairOf(double thetaI, double phiI, double thetaO, double phiO) {
    const auto direction = [](double theta, double phi) {
        // A negative polar angle lies on the other side.
        return Direction::fromSpherical(Radians::fromDegrees(std::abs(theta)),
                                        Radians::fromDegrees(theta < 0 ? phi + 180 : phi));
    };
    return {.in = direction(thetaI, phiI), .out = direction(thetaO, phiO)};
}

/// One band, uncertainties not known.
BrdfData dataOf(const std::vector<Point>& points) {
    DataMaker maker(DataOptions{});
    maker.data().uKnown = false;
    maker.data().bands = BandCount::One;
    std::map<long, std::uint16_t> groups;
    for (const Point& point : points) groups[std::lround(point.pair.in.theta().degrees() * 10)] = 0;
    for (auto& [tenths, group] : groups) {
        group = static_cast<std::uint16_t>(maker.data().incidences.size());
        maker.data().incidences.push_back(Radians::fromDegrees(static_cast<double>(tenths) / 10));
    }
    for (const Point& point : points) {
        FitRow& row = maker.add(point.pair);
        row.group = groups[std::lround(point.pair.in.theta().degrees() * 10)];
        row.f[0] = point.f;
    }
    return std::move(maker).finished();
}

std::vector<Point> scattered(const Scatterer& truth, std::size_t count) {
    std::mt19937_64 random(11);
    std::vector<Point> points;
    for (const double thetaI : {10.0, 30.0, 50.0}) {
        for (std::size_t i = 0; i < count / 3; ++i) {
            const LightView pair{
                .in = Direction::fromSpherical(Radians::fromDegrees(thetaI), 0_deg),
                .out = test::randomDirection(random)};
            points.push_back({pair, truth.answer(pair).f[Band::R]});
        }
    }
    return points;
}

double rmsOf(const Scatterer& estimator, const std::vector<Point>& points) {
    double sum = 0;
    for (const Point& point : points) {
        const double error = estimator.answer(point.pair).f[Band::R] / point.f - 1;
        sum += error * error;
    }
    return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(ScatteredEstimator, AnswersASampleAsItWasGiven) {
    const auto truth = std::move(*makeModel("oren-nayar,albedo=0.6,sigma=0.4"));
    const auto points = scattered(*truth, 90);
    const auto made = ScatteredEstimator::over(dataOf(points));
    ASSERT_TRUE(made) << made.error().message;
    for (const Point& point : points) {
        const Answer answer = (*made)->answer(point.pair);
        EXPECT_EQ(answer.source, Source::Measured);
        EXPECT_DOUBLE_EQ(answer.f[Band::R], point.f);
        EXPECT_DOUBLE_EQ(answer.f[Band::B], point.f);
        EXPECT_FALSE(answer.u(Band::R)) << "the data say nothing of it";
    }
    // Between samples the deviation is learned from them all.
    const Answer between = (*made)->answer(pairOf(20, 0, 40, 77));
    ASSERT_TRUE(between.u(Band::R));
    EXPECT_GT(*between.u(Band::R), 0);
    EXPECT_LT(*between.u(Band::R), 0.02 * between.f[Band::R]);
    // What the data do say is said again.
    BrdfData known = dataOf(points);
    known.uKnown = true;
    for (FitRow& row : known.rows) row.uRandom[0] = 0.01 * row.f[0];
    const auto stated = ScatteredEstimator::over(known);
    ASSERT_TRUE(stated) << stated.error().message;
    const Answer given = (*stated)->answer(points[7].pair);
    ASSERT_TRUE(given.u(Band::G));
    EXPECT_DOUBLE_EQ(*given.u(Band::G), 0.01 * points[7].f);
}

TEST(ScatteredEstimator, IsRightBetweenItsSamplesAndReciprocal) {
    // No family that carries is this.
    const auto truth = std::move(*makeModel("disney-diffuse,albedo=0.6,roughness=0.9"));
    const auto made = ScatteredEstimator::over(dataOf(scattered(*truth, 300)));
    ASSERT_TRUE(made) << made.error().message;
    std::vector<Point> asked;
    for (const double thetaI : {15.0, 28.0, 44.0}) {
        for (const double phi : {20.0, 100.0, 170.0}) {
            const LightView pair = pairOf(thetaI, 0, 40, phi);
            asked.push_back({pair, truth->answer(pair).f[Band::R]});
        }
    }
    EXPECT_LT(rmsOf(**made, asked), 0.003);
    for (const Point& point : asked) {
        const double f = (*made)->answer(point.pair).f[Band::R];
        const LightView back{.in = point.pair.out, .out = point.pair.in};
        EXPECT_NEAR((*made)->answer(back).f[Band::R], f, 1e-9);
        EXPECT_EQ((*made)->answer(point.pair).source, Source::Interpolated);
    }
    // At the normal there is no azimuth, of neither direction.
    const double normal = (*made)->answer(pairOf(0, 0, 40, 0)).f[Band::R];
    for (const double phi : {20.0, 100.0, 170.0}) {
        EXPECT_NEAR((*made)->answer(pairOf(0, 0, 40, phi)).f[Band::R], normal, 1e-12);
        EXPECT_NEAR((*made)->answer(pairOf(40, phi, 0, 0)).f[Band::R], normal, 1e-9);
    }
}

TEST(ScatteredEstimator, RefusesTooFewSamplesAndKeepsTwins) {
    const auto truth = std::move(*makeModel("lambert,albedo=0.5"));
    auto points = scattered(*truth, 6);
    EXPECT_EQ(ScatteredEstimator::over(dataOf(points)).error().kind, ErrorKind::Quality);
    points = scattered(*truth, 30);
    points.push_back(points.front());  // the same pair twice
    const auto made = ScatteredEstimator::over(dataOf(points));
    ASSERT_TRUE(made);
    EXPECT_NEAR((*made)->answer(pairOf(20, 0, 40, 77)).f[Band::R], 0.5 / kPi, 1e-6);
    EXPECT_FALSE((*made)->answer(pairOf(20, 0, 95, 0)).present());
}

/// NIST's sintered PTFE at 532 nm (see SOURCES.md there): 30 % of the directions left out, ten
/// times.
TEST(ScatteredEstimator, PredictsNistsPtfe) {
    const auto file = test::dataFile("white_reference/PTFE.data.csv");
    if (!file) GTEST_SKIP();
    std::ifstream in(*file);
    std::string line;
    std::getline(in, line);
    std::vector<Point> points;
    while (std::getline(in, line)) {
        std::istringstream fields(line);
        std::array<double, 6> v{};
        char comma = 0;
        for (double& value : v) fields >> value >> comma;
        if (std::abs(v[0] - 0.532) > 1e-6) continue;
        points.push_back({pairOf(v[1], v[2], v[3], v[4]), v[5]});
    }
    ASSERT_EQ(points.size(), 1824U);
    const int splits = std::getenv("GONIO_NIGHTLY") != nullptr ? 10 : 2;
    double sum = 0;
    for (int seed = 0; seed < splits; ++seed) {
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        std::vector<Point> order = points;
        std::shuffle(order.begin(), order.end(), random);
        const std::ptrdiff_t out = static_cast<std::ptrdiff_t>(order.size() * 3 / 10);
        const std::vector<Point> held(order.begin(), order.begin() + out);
        const std::vector<Point> kept(order.begin() + out, order.end());
        const auto made = ScatteredEstimator::over(dataOf(kept));
        ASSERT_TRUE(made) << made.error().message;
        const double rms = rmsOf(**made, held);
        const auto within = std::count_if(held.begin(), held.end(), [&](const Point& point) {
            const Answer answer = (*made)->answer(point.pair);
            return std::abs(answer.f[Band::R] - point.f) <= 2 * *answer.u(Band::R);
        });
        const double share = static_cast<double>(within) / static_cast<double>(held.size());
        std::cout << "split " << seed << ": " << 100 * rms << " %, " << 100 * share
                  << " % within 2 u\n";
        EXPECT_GT(share, 0.85);
        sum += rms;
    }
    EXPECT_LT(sum / splits, 0.012);
}

/// One half of the plane of incidence of an RT-300S scan: f by signed theta_o, forward positive.
/// The raw scans are not plane-symmetric and off by 10 to 45 % in reciprocity (SOURCES.md).
using Scan = std::map<double, std::vector<std::pair<double, double>>>;

std::map<std::array<double, 3>, double> readScan(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    std::map<std::array<double, 3>, double> readings;
    while (std::getline(in, line)) {
        std::istringstream fields(line);
        std::array<double, 4> v{};
        char comma = 0;
        for (double& value : v) fields >> value >> comma;
        readings[{v[0], v[1], v[2]}] = v[3];
    }
    return readings;
}

/// f in the plane, both scans of it, without the shadow of the arm.
Scan inPlane(const std::map<std::array<double, 3>, double>& sample,
             const std::map<std::array<double, 3>, double>& blank) {
    Scan scan;
    for (const auto& [at, signal] : sample) {
        const auto black = blank.find(at);
        if (std::abs(at[0]) != 90 || black == blank.end()) continue;
        const double forward = at[0] < 0 ? at[2] : -at[2];
        if (std::abs(forward + at[1]) < 1) continue;
        const double cosine = std::cos(at[2] * kPi / 180);
        scan[at[1]].emplace_back(forward, (signal - black->second) / (kPi * cosine));
    }
    for (auto& [incidence, values] : scan) std::sort(values.begin(), values.end());
    return scan;
}

/// Mean of both scans, linear between receive angles, the last value beyond.
double atAngle(const std::vector<std::pair<double, double>>& values, double forward) {
    std::map<double, std::pair<double, double>> means;
    for (const auto& [x, f] : values) {
        means[x].first += f;
        means[x].second += 1;
    }
    const auto value = [](const auto& node) { return node.second.first / node.second.second; };
    const auto high = means.lower_bound(forward);
    if (high == means.end()) return value(*means.rbegin());
    if (high == means.begin() || high->first == forward) return value(*high);
    const auto low = std::prev(high);
    const double t = (forward - low->first) / (high->first - low->first);
    return (1 - t) * value(*low) + t * value(*high);
}

struct Rms {
    double ours;
    double specularLinear;
};

/// The incidence left out, predicted from the others; `linear` are the two sheets (or one twice).
Rms predicted(const Scan& scan, double leftOut, std::array<double, 2> linear) {
    std::vector<Point> kept;
    std::vector<Point> held;
    std::vector<double> offsets;
    for (const auto& [incidence, values] : scan) {
        for (const auto& [x, f] : values) {
            const Point point{pairOf(incidence, 0, std::abs(x), x > 0 ? 180 : 0), f};
            if (incidence != leftOut) {
                kept.push_back(point);
                continue;
            }
            held.push_back(point);
            offsets.push_back(x - leftOut);
        }
    }
    const auto made = ScatteredEstimator::over(dataOf(kept));
    EXPECT_TRUE(made) << made.error().message;
    double sum = 0;
    for (std::size_t i = 0; i < held.size(); ++i) {
        const double f = 0.5 * atAngle(scan.at(linear[0]), linear[0] + offsets[i]) +
                         0.5 * atAngle(scan.at(linear[1]), linear[1] + offsets[i]);
        sum += (f / held[i].f - 1) * (f / held[i].f - 1);
    }
    return {rmsOf(**made, held), std::sqrt(sum / static_cast<double>(held.size()))};
}

TEST(ScatteredEstimator, PredictsTheBlackOfAGoniophotometerBetterThanSpecularLinear) {
    const auto sample =
        test::dataFile("gonio_rt300s/ANOPLATE_AnoBlack_EC1_Alum6061_v1o0_20251115.RT.csv");
    const auto blank = test::dataFile("gonio_rt300s/blank_v2o0_20250911.RT.csv");
    if (!sample || !blank) GTEST_SKIP();
    const Scan scan = inPlane(readScan(*sample), readScan(*blank));
    const Rms at50 = predicted(scan, 50, {30, 70});
    const Rms at70 = predicted(scan, 70, {50, 50});
    std::cout << "50: " << 100 * at50.ours << " % against " << 100 * at50.specularLinear
              << " %; 70: " << 100 * at70.ours << " against " << 100 * at70.specularLinear << "\n";
    EXPECT_LT(at50.ours, 0.2);
    EXPECT_LT(at50.ours, 0.5 * at50.specularLinear);
    EXPECT_LT(at70.ours, 0.8 * at70.specularLinear);
}

}  // namespace
}  // namespace gonio::proc
