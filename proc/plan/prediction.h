#pragma once
// What frames achieve: the distribution of the relative uncertainties over all planned cells.

#include <vector>

#include "proc/plan/demands.h"

namespace gonio::proc {

/// The frames of one state: how many of each option.
struct StateFrames {
    const std::vector<ShotOption>& options;
    std::vector<int> frames;
};

/// Relative random uncertainty, k = 1, of a cell's f; infinite without information.
[[nodiscard]] double randomUncertainty(const PlanCell& cell, const StateFrames& taken);
/// The same with dark frames that have no noise: the Cramer-Rao bound of these frames.
[[nodiscard]] double cramerRaoUncertainty(const PlanCell& cell, const StateFrames& taken);

/// A value of `count` alike cells.
struct Counted {
    double value = 0;
    int count = 1;
};
/// Infinite values are the worst.
[[nodiscard]] Spread spreadOf(std::vector<Counted> values);

/// Gathers cells state by state.
class PredictionSum {
public:
    explicit PredictionSum(const SystematicFloor& floor) : floor_(floor) {}
    /// So many cells will be added.
    void reserve(std::size_t cells);
    /// A cell that is planned.
    void add(const PlanCell& cell, const StateFrames& taken);
    [[nodiscard]] Prediction result() const;

private:
    const SystematicFloor& floor_;
    std::vector<Counted> random_, systematic_, total_, cramerRao_;
};

}  // namespace gonio::proc
