#include "proc/radiance/shared_noise.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>

namespace gonio::proc {
namespace {

TEST(SharedNoise, WeightsAreTheInverseOfTheCovariance) {
    const std::array weight{0.5, 2.0, 1.0, 4.0, 0.25};
    const std::array<SharedNoise, 5> shared{{{0, 1.5}, {0, 0.5}, {2, 0.7}, {0, 0.1}, {2, 0.0}}};
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(5, 5);
    for (int i = 0; i < 5; ++i) {
        const auto a = static_cast<std::size_t>(i);
        covariance(i, i) += 1 / weight[a];
        for (int j = 0; j < 5; ++j) {
            const auto b = static_cast<std::size_t>(j);
            if (shared[a].source == shared[b].source)
                covariance(i, j) += shared[a].sigma * shared[b].sigma;
        }
    }
    const Eigen::MatrixXd inverse = covariance.inverse();
    const SharedWeights weights(weight, shared);
    for (int i = 0; i < 5; ++i) {
        const auto a = static_cast<std::size_t>(i);
        EXPECT_NEAR(weights.inMean(a), inverse.row(i).sum(), 1e-12);
        EXPECT_NEAR(weights.variance(a), covariance(i, i), 1e-12);
        for (int j = 0; j < 5; ++j)
            EXPECT_NEAR(weights.at(a, static_cast<std::size_t>(j)), inverse(i, j), 1e-12);
    }
}

TEST(SharedNoise, ASampleOfWeightZeroIsNotThere) {
    const std::array weight{1.0, 0.0, 2.0};
    const std::array<SharedNoise, 3> shared{{{0, 1}, {0, 1}, {0, 1}}};
    const SharedWeights three(weight, shared);
    const std::array<double, 2> other{1.0, 2.0};
    const std::array<SharedNoise, 2> own{{{0, 1}, {0, 1}}};
    const SharedWeights two(other, own);
    EXPECT_FALSE(three.present(1));
    EXPECT_EQ(three.inMean(1), 0);
    EXPECT_DOUBLE_EQ(three.inMean(0), two.inMean(0));
    EXPECT_DOUBLE_EQ(three.at(0, 2), two.at(0, 1));
}

}  // namespace
}  // namespace gonio::proc
