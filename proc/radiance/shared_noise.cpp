#include "proc/radiance/shared_noise.h"

namespace gonio::proc {

SharedWeights::SharedWeights(std::span<const double> weight, std::span<const SharedNoise> shared)
    : weight_(weight), shared_(shared) {
    for (std::size_t i = 0; i < weight.size(); ++i) {
        if (sources_.size() <= shared[i].source) sources_.resize(shared[i].source + 1);
        Source& source = sources_[shared[i].source];
        source.pull += weight[i] * shared[i].sigma;
        source.squares += weight[i] * shared[i].sigma * shared[i].sigma;
    }
}

double SharedWeights::at(std::size_t i, std::size_t j) const {
    const double own = i == j ? weight_[i] : 0;
    if (shared_[i].source != shared_[j].source) return own;
    const double both = weight_[i] * shared_[i].sigma * weight_[j] * shared_[j].sigma;
    return own - both / (1 + sources_[shared_[i].source].squares);
}

double SharedWeights::inMean(std::size_t i) const {
    const Source& source = sources_[shared_[i].source];
    return weight_[i] * (1 - shared_[i].sigma * source.pull / (1 + source.squares));
}

}  // namespace gonio::proc
