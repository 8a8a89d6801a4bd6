#pragma once
// How wrong a method may be, learned from what was left out of a sample, in proportion to how far
// an answer reaches beyond what was measured: of bright answers relative to them, of dark ones as
// an amount (error_scale.h).
//
// Of errors that are not Gaussian, as those at a surface's dark edges are, no root of a mean square
// tells what to expect: the standard error is the one whose 1 and 2 standard deviations hold 68.3
// and 95.4 % of them, noise taken off.

#include <array>
#include <vector>

#include "proc/estimate/coverage.h"
#include "proc/estimate/error_scale.h"

namespace gonio::proc {

/// One value that was predicted from the others.
struct ProbeError {
    double off = 0;       ///< 1/sr, from f
    double u = 0;         ///< 1/sr, of f
    double toBoth = 1;    ///< 1/sr, what it is relative to when methods are compared
    double toAnswer = 1;  ///< 1/sr, when the answer is all that is known
    bool dark = false;    ///< the answer
    Reach reach;
    Radians fromMirror;  ///< between wo and the mirror direction
    bool even = true;    ///< of an even choice over the hemisphere; else one more of the lobe
    bool lobe = false;   ///< f is above a tenth of the incidence's largest

    /// Relative, less what noise makes; may be negative. At most 4, and 2 of values of one sign,
    /// however dark f is.
    [[nodiscard]] double squared() const { return (off * off - u * u) / (toBoth * toBoth); }
};

class ErrorModel {
public:
    /// What cells of a degree resolve, whatever the method; relative.
    static constexpr double kLeast = 5e-4;

    ErrorModel() = default;
    /// `anchored`: the method is right at an incidence that was measured (incidence_method.h), and
    /// its error grows with Reach::between; else it is the same everywhere.
    ErrorModel(ErrorScale scale, bool anchored, const std::vector<ProbeError>& between);
    void learnBeyondIncidence(const std::vector<ProbeError>& errors);
    void learnEdge(const std::vector<ProbeError>& errors);

    /// Standard error of an answer f, 1/sr.
    [[nodiscard]] double of(double f,
                            std::size_t band,
                            const Reach& reach,
                            Radians fromMirror) const;

private:
    struct Standard {
        double relative = 0;
        double dark = 0;  ///< 1/sr
    };
    /// Upper limits of the bins by the angle from the mirror direction, in degrees.
    static constexpr std::array<double, 5> kBins{5, 15, 30, 60, 180};
    static std::size_t binOf(Radians fromMirror);
    class PerReach;

    ErrorScale scale_;
    bool anchored_ = true;
    /// At Reach::between = 1; where nothing could be predicted, as wrong as at the worst.
    std::array<Standard, kBins.size()> between_{};
    Standard beyondIncidence_;  ///< 10 degrees beyond the last incidence
    Standard steps_;            ///< 10 layers beyond what was measured
};

}  // namespace gonio::proc
