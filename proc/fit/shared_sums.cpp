#include "proc/fit/shared_sums.h"

namespace gonio::proc {

SharedSums::SharedSums(const BrdfData& data, bool wanted) : shares_(data.shared) {
    if (wanted && data.sharesErrors()) patches_.resize(shares_.size() * kBandCount * kPatches);
}

void SharedSums::addTo(AlongModel& all, const AlongModel& one, double factor) {
    all.r += factor * one.r;
    all.v += factor * one.v;
    for (std::size_t i = 0; i < kMostLocal; ++i) all.j[i] += factor * one.j[i];
}

double SharedSums::taken() const {
    double sum = 0;
    eachTaken([&](std::size_t, double factor, const AlongModel& along) {
        sum += factor * along.r * along.r;
    });
    return sum;
}

}  // namespace gonio::proc
