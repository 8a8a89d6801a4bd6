#pragma once
// Answers between scattered BRDF samples of an isotropic, reciprocal surface: the ratio of the data
// to a fitted model, less 1, by a Gaussian process (kriging) over the nearest samples.
//
// The process and its coordinates: kriging_process.h; of at most 300 samples it is learned how far
// they tell of one another. An answer is made of the 80 samples about the nearest one
// (local_kriging.h).
//
// At a sample itself: as it was given, source measured; where the data say nothing of their
// uncertainty, neither does the answer. Elsewhere: interpolated; u_random is what single values
// scatter by about the process (its noise, found from the data; it may be theirs or the surface's),
// u_systematic the process's own standard deviation and the samples' common one. None where the
// process could not be learned, as of values that the model meets exactly. Beyond what was sampled
// the ratio returns to 1 and its deviation to that of all ratios: source model, flag extrapolated,
// from where it knows less than half of their variance.

#include <array>
#include <limits>
#include <memory>
#include <vector>

#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/estimate/incidence_method.h"
#include "proc/estimate/local_kriging.h"
#include "proc/fit/brdf_data.h"

namespace gonio::proc {

struct ScatteredEstimatorOptions {
    std::size_t neighbours = 80;  ///< an answer is made of
    /// Families that may carry, by name; empty: carrierFamilies() and "lambert".
    std::vector<std::string> carriers;
};

struct KrigingSample {
    LightView pair;
    double f = 0;
    double uRandom = 0;
    double uSystematic = 0;
};

class ScatteredEstimator final : public Scatterer {
public:
    /// A Quality error where the data hold fewer than 8 samples or no model fits them.
    [[nodiscard]] static Result<std::unique_ptr<const ScatteredEstimator>> over(
        const BrdfData& data, const ScatteredEstimatorOptions& options = {});

    /// Some ten microseconds a band; a fifth of a millisecond of more than 2048 samples.
    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return bands_; }

private:
    struct OneBand {
        std::vector<KrigingSample> samples;
        KrigingProcess process;
        LocalKriging kriging;       ///< of f over the model, less 1
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

    struct Learning {
        std::size_t band = 0;
        std::size_t neighbours = 80;
    };

    ScatteredEstimator(Carrier carrier, BandCount bands)
        : carrier_(std::move(carrier)), bands_(bands) {}
    [[nodiscard]] OneBand learn(const BrdfData& data,
                                const std::vector<LightView>& pairs,
                                const Learning& what) const;
    [[nodiscard]] BandAnswer bandAnswer(const LightView& pair, std::size_t band) const;

    Carrier carrier_;
    BandCount bands_;
    std::array<OneBand, 3> bandsOf_;
};

}  // namespace gonio::proc
