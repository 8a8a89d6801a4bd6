#pragma once
// Answers for the whole hemisphere of light and view from what a rig measured at a few incidences.
// The sample is isotropic: the light's azimuth is turned to 0.
//
// At a cell's centre and an incidence that were measured: the cell's own mean (source measured), in
// each band that has one.
// Elsewhere, in the order of trust:
//   reciprocity    the pair is asked with light and view exchanged, too, and both are weighted by
//                  how far they are from what was measured (reciprocal_method.h)
//   interpolated   by the method that predicts this sample's own incidences best, mostly the ratio
//                  to a fitted model that is carried (method_choice.h); between the cells of an
//                  incidence that was measured, by the best of those that keep to them
//   prior, model   beyond the incidences and theta_o that were measured: the method that predicts
//                  best what is outermost; the two methods blend over 5 degrees of incidence or 3
//                  layers of cells
//   extrapolated   where no model could be fitted: the nearest value.
//
// u_random is that of the cells that an answer is made of; u_systematic holds theirs, and the
// method's own error, learned from what it predicted wrong when parts of the sample were left out,
// or a posterior's deviation. Both are of k = 1. Where nothing can be left out (fewer than three
// incidences, draft) the method's error is not known off what was measured, and no uncertainty is
// told; of data without uncertainties u_random is not told, and u_systematic holds their noise.

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "proc/core/effort.h"
#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/estimate/coverage.h"
#include "proc/estimate/method_choice.h"
#include "proc/estimate/prior_method.h"
#include "proc/table/sample_lookup.h"

namespace gonio::proc {

struct SampleEstimatorOptions {
    /// "auto", or a name of methodNames().
    std::string method = "auto";
    /// Draft: the carrier of least chi-square without asking the sample, and no prior.
    Effort effort = Effort::Standard;
    /// Asked when the choice is made, by "auto" and "prior" alone; the basis is shared by all
    /// estimators of a run. Empty: none.
    std::function<std::shared_ptr<const PriorBasis>()> prior;
};

class SampleEstimator final : public Scatterer {
public:
    /// A Usage error for a sample of several rotations, and for a method that is none or cannot be
    /// made of the sample; a Quality error
    /// where nothing in it can be used. With "auto" the choice is made at the first question that a
    /// measured cell does not answer.
    [[nodiscard]] static Result<std::unique_ptr<const SampleEstimator>> over(
        SampleSet set, SampleEstimatorOptions options);
    /// Over anything that answers `measured` at what was measured, shared with its owner, and the
    /// data that it holds, at phi_i = 0.
    [[nodiscard]] static Result<std::unique_ptr<const SampleEstimator>> over(
        std::shared_ptr<const Scatterer> measured, BrdfData data, SampleEstimatorOptions options);

    [[nodiscard]] Answer answer(const LightView& pair) const override;
    [[nodiscard]] BandCount bandCount() const override { return data_.bands; }

    /// What was chosen and why; makes the choice where it was not made yet.
    [[nodiscard]] const MethodChoice& choice() const;
    /// The sample's gates of the prior; null where it was not asked.
    [[nodiscard]] const SamplePrior* prior() const;

private:
    SampleEstimator(std::shared_ptr<const Scatterer> measured,
                    BrdfData data,
                    SampleEstimatorOptions options);
    void choose() const;
    [[nodiscard]] Answer estimate(const LightView& pair) const;
    /// Between the cells of an incidence that was measured, one that keeps to them.
    [[nodiscard]] const ChosenMethod& methodBetween(const LightView& pair) const;
    /// Those of which the pair's cell has a value that can be used.
    [[nodiscard]] std::array<bool, 3> measuredBands(const LightView& pair) const;

    std::shared_ptr<const Scatterer> measured_;
    const SampleLookup* sample_;  ///< the same, where it is one; else null
    SampleEstimatorOptions options_;
    BrdfData data_;
    Coverage coverage_;
    Flags corrections_;  ///< that any cell of the sample has: glare, tilt, drift

    mutable std::once_flag chosen_;  // the choice is a pure function of the members above
    mutable MethodChoice choice_;
    mutable std::unique_ptr<const SamplePrior> samplePrior_;
};

/// The prior of the standard library (proc/fit/prior_library.h): made once, in about a second.
[[nodiscard]] std::shared_ptr<const PriorBasis> standardPrior();

}  // namespace gonio::proc
