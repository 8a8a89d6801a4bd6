#pragma once
// Collects the rows of BrdfData, whatever they come from.

#include "proc/fit/brdf_data.h"

namespace gonio::proc {

class DataMaker {
public:
    explicit DataMaker(const DataOptions& options) : options_(options) {
        data_.assumedRelative = options.assumedRelative;
    }

    /// A row whose bands the caller fills: NaN until then. Weights of the nodes sum to 1.
    FitRow& add(std::span<const WeightedNode> nodes, double cosThetaO);
    FitRow& add(const LightView& pair);
    void leaveOut() { ++data_.leftOut; }
    BrdfData& data() { return data_; }

    /// With uncertainties assumed where there are none, without rows and groups that have no value.
    [[nodiscard]] BrdfData finished() &&;

private:
    void assumeUncertainty();
    void dropEmptyGroups();

    DataOptions options_;
    BrdfData data_;
};

}  // namespace gonio::proc
