#pragma once
// How wrong a method may be, learned from what was left out of a sample: errors relative to f, in
// proportion to how far an answer reaches beyond what was measured.

#include <array>
#include <vector>

#include "proc/estimate/coverage.h"

namespace gonio::proc {

/// One value that was predicted from the others.
struct ProbeError {
    double squared = 0;  ///< relative to f, less what its noise makes; may be negative
    Reach reach;
    Radians fromMirror;  ///< between wo and the mirror direction
    bool even = true;    ///< of an even choice over the hemisphere; else one more of the lobe
    bool lobe = false;   ///< f is above a tenth of the incidence's largest
};

/// Standard relative errors.
class ErrorModel {
public:
    /// What cells of a degree resolve, whatever the method.
    static constexpr double kLeast = 5e-4;

    ErrorModel() = default;
    /// `anchored`: the method is right at an incidence that was measured (incidence_method.h), and
    /// its error grows with Reach::between; else it is the same everywhere.
    ErrorModel(bool anchored, const std::vector<ProbeError>& between);
    void learnBeyondIncidence(const std::vector<ProbeError>& errors);
    void learnEdge(const std::vector<ProbeError>& errors);

    [[nodiscard]] double at(const Reach& reach, Radians fromMirror) const;

private:
    /// Upper limits of the bins by the angle from the mirror direction, in degrees.
    static constexpr std::array<double, 5> kBins{5, 15, 30, 60, 180};
    static std::size_t binOf(Radians fromMirror);

    bool anchored_ = true;
    std::array<double, kBins.size()> between_{};  ///< at Reach::between = 1
    double beyondIncidence_ = 0;                  ///< 10 degrees beyond the last incidence
    double steps_ = 0;                            ///< 10 layers beyond what was measured
};

}  // namespace gonio::proc
