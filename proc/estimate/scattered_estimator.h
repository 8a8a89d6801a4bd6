#pragma once
// Answers between scattered BRDF samples of an isotropic, reciprocal surface: the ratio of the data
// to a fitted model, less 1, by a Gaussian process (kriging) over the nearest samples.
//
// Coordinates of a pair: (rho_i, x, |y|), the light at phi = 0 and each direction on the equal-area
// disc, rho = sqrt(2) sin(theta / 2), which is drawn out towards grazing (rho (1 + g rho^6)), and x
// counted from the mirror direction, where that predicts better.
// Covariance of two pairs: Matern's of order 5/2 of their distance, averaged over exchanging light
// and view of either. Its length, the weight of rho_i and the noise are those under which each of
// at most 300 samples is predicted best from the others (leave-one-out likelihood [Rasmussen2006,
// ch. 5]).
//
// At a sample itself: as it was given, source measured; where the data say nothing of their
// uncertainty, neither does the answer. Elsewhere: interpolated; u_systematic is the process's own
// standard deviation (its noise is found from the data) and the samples' common one; none where the
// process could not be learned, as of values that the model meets exactly. u_random is 0, or none
// where the data have none. Beyond what was sampled the ratio returns to 1 and its deviation to
// that of all ratios: source model, flag extrapolated, from where it knows less than half of their
// variance.

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/estimate/incidence_method.h"
#include "proc/fit/brdf_data.h"

namespace gonio::proc {

struct ScatteredEstimatorOptions {
    std::size_t neighbours = 64;  ///< an answer is made of
    /// Families that may carry, by name; empty: carrierFamilies() and "lambert".
    std::vector<std::string> carriers;
};

/// A pair's place in a process's coordinates, both ways round.
struct KrigingPlace {
    Eigen::Vector3d straight = Eigen::Vector3d::Zero();
    Eigen::Vector3d exchanged = Eigen::Vector3d::Zero();
    double scale = 1;  ///< makes the correlation of a pair with itself 1
};

struct KrigingSample {
    LightView pair;
    KrigingPlace place;
    double ratio = 0;  ///< f over the model, less 1
    double f = 0;
    double uRandom = 0;
    double uSystematic = 0;
};

class ScatteredEstimator final : public Scatterer {
public:
    /// A Quality error where the data hold fewer than 8 samples or no model fits them.
    [[nodiscard]] static Result<std::unique_ptr<const ScatteredEstimator>> over(
        const BrdfData& data, const ScatteredEstimatorOptions& options = {});

    /// Some microseconds per 100 samples and a fifth of a millisecond.
    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return bands_; }
    [[nodiscard]] const Carrier& carrier() const { return carrier_; }

    struct Process {
        double length = 2;           ///< of the disc
        double incidenceWeight = 1;  ///< of rho_i in the square of a distance
        double grazing = 1;          ///< by how much the disc is drawn out at its rim
        bool fromMirror = false;
        double noise = 0.1;      ///< variance, relative to the process's
        double variance = 1e-2;  ///< of the ratio
        bool learned = false;    ///< else all of this is assumed
    };

private:
    struct OneBand {
        std::vector<KrigingSample> samples;
        Process process;
        double floor = 0;           ///< 1/sr, beside f and the model in their ratio
        double commonRelative = 0;  ///< systematic uncertainty
    };
    /// NaN where the band was not sampled, and where nothing is known of an uncertainty.
    struct BandAnswer {
        double f = std::numeric_limits<double>::quiet_NaN();
        double uRandom = std::numeric_limits<double>::quiet_NaN();
        double uSystematic = std::numeric_limits<double>::quiet_NaN();
        Source source = Source::Interpolated;
    };

    ScatteredEstimator(Carrier carrier, BandCount bands)
        : carrier_(std::move(carrier)), bands_(bands) {}
    [[nodiscard]] OneBand learn(const BrdfData& data,
                                const std::vector<LightView>& pairs,
                                std::size_t band) const;
    [[nodiscard]] BandAnswer bandAnswer(const LightView& pair, std::size_t band) const;

    Carrier carrier_;
    BandCount bands_;
    bool uKnown_ = true;  ///< of the samples
    std::array<OneBand, 3> bandsOf_;
    std::size_t neighbours_ = 64;
};

}  // namespace gonio::proc
