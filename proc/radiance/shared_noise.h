#pragma once
// The weights of several samples of one light, some of which share a part of their noise: frames
// that the same mean dark frame was taken from. With w_i = 1 / variance of what is sample i's own,
// and a_i the standard deviation of what it shares with the others of its source s, the inverse of
// their covariance is, by the formula of Sherman and Morrison,
//     W_ij = w_i (i = j) - w_i a_i w_j a_j / (1 + sum_s w a^2)     (i, j of one source; else 0).
// Without shared noise W is diagonal. A sample of weight 0 is not there.

#include <cstddef>
#include <span>
#include <vector>

namespace gonio::proc {

struct SharedNoise {
    std::size_t source = 0;
    double sigma = 0;  ///< in units of the sample
};

class SharedWeights {
public:
    /// Borrows both, one for each sample.
    SharedWeights(std::span<const double> weight, std::span<const SharedNoise> shared);

    [[nodiscard]] std::size_t size() const { return weight_.size(); }
    [[nodiscard]] bool present(std::size_t i) const { return weight_[i] > 0; }
    /// W_ij.
    [[nodiscard]] double at(std::size_t i, std::size_t j) const;
    /// sum_j W_ij: the weight of sample i in the mean of all.
    [[nodiscard]] double inMean(std::size_t i) const;
    /// All of a sample's variance, its own and the shared.
    [[nodiscard]] double variance(std::size_t i) const {
        return 1 / weight_[i] + shared_[i].sigma * shared_[i].sigma;
    }

private:
    /// Over the samples of one source.
    struct Source {
        double pull = 0;     // sum w a
        double squares = 0;  // sum w a^2
    };
    std::span<const double> weight_;
    std::span<const SharedNoise> shared_;
    std::vector<Source> sources_;
};

}  // namespace gonio::proc
