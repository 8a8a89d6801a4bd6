#pragma once
// Which method suits a sample, asked of the sample itself: each incidence between two others is
// left out in turn and predicted from the rest by every candidate (trial.h), and the one that is
// least wrong is taken. Beyond the angles that were measured another may be better: of those that
// are made for it, the one that predicts best the last incidence and the outermost 15 degrees of
// theta_o when these are left out. What both were wrong by says how wrong they may be elsewhere
// (error_model.h).
//
// Candidates: log interpolation in specular-relative, direction-cosine and half-vector frames, and
// cubic; the fitted model of each carrier family, alone and carrying the ratio of the data to it;
// the prior's posterior where its gate passes.
//
// With fewer than three incidences nothing can be left out: the carrier of least chi-square is
// taken, and nothing is known of its errors.

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proc/estimate/carrier_fit.h"
#include "proc/estimate/error_model.h"
#include "proc/estimate/incidence_method.h"
#include "proc/estimate/prior_method.h"
#include "proc/estimate/trial.h"

namespace gonio::proc {

/// Relative errors (error_scale.h), root mean square less the noise. Each is relative to what was
/// measured and to the answer alike, so that no value counts for more than an error of 200 %: a
/// dark cell cannot outweigh a lobe.
struct MethodScore {
    std::string name;
    double hemisphere = 0;         ///< at incidences that were left out
    double lobe = 0;               ///< there where f is above a tenth of its largest
    std::optional<double> beyond;  ///< at the last incidence and the edge, left out
    bool anchored = true;          ///< IncidenceMethod::anchored
    [[nodiscard]] double between() const { return std::hypot(hemisphere, lobe); }
};

struct ChosenMethod {
    std::shared_ptr<const IncidenceMethod> method;  ///< shared with what it answers for
    ErrorModel errors;
    bool errorsKnown = false;
};

struct MethodChoice {
    ChosenMethod between;
    ChosenMethod beyond;
    ChosenMethod anchored;  ///< the best between of the anchored; no method where none was asked
    std::vector<MethodScore> scores;  ///< of all candidates, by between()
    Carriers carriers;                ///< fitted to all incidences
};

struct MethodChoiceOptions {
    CarrierFitOptions fit;
    TrialOptions trial;
    bool learn = true;  ///< leave parts out; else as with fewer than three incidences
    std::string only;   ///< a name: no other is asked; empty: all
};

/// Names a candidate makes, in the order of the list above.
[[nodiscard]] std::vector<std::string> methodNames();
/// A method by its name from all incidences; a Usage error for a name that is none, or one whose
/// carrier or prior is not there.
[[nodiscard]] Result<std::shared_ptr<const IncidenceMethod>> methodNamed(const std::string& name,
                                                                         const BrdfData& data,
                                                                         const Carriers& carriers,
                                                                         const SamplePrior* prior);

/// `prior`: null where there is none. The data must outlive the call only. Where `only` cannot be
/// made, the methods are null.
[[nodiscard]] MethodChoice chooseMethod(const BrdfData& data,
                                        const SamplePrior* prior,
                                        const MethodChoiceOptions& options = {});

}  // namespace gonio::proc
