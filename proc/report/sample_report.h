#pragma once
// All that is known of a measured sample as one HTML file that a laboratory hands out: identity,
// calibration, uncertainty budget, verdicts, maps, slices, reflectance, reciprocity, what is
// missing, how answers between the angles come about, fitted models, and what the words mean.
// Every number has its unit and, where one is known, its uncertainty, and no more digits than that
// allows. What each part shows and where its numbers come from: docs/report.md.

#include <string>

#include "proc/core/scatterer.h"
#include "proc/report/report_origin.h"
#include "proc/table/sample_set.h"

namespace gonio::proc {

class SampleEstimator;
struct Selection;

/// What was made of the sample; null where it was not, with the reason in one sentence.
struct ReportEstimates {
    const SampleEstimator* estimator = nullptr;
    std::string noEstimator;
    /// Fills in what is missing of the reflectance; any estimator, in the sample's own frame.
    const Scatterer* surface = nullptr;
    const Selection* fits = nullptr;
    std::string noFits;
};

/// The document. Total: what the sample does not have is said to be missing.
[[nodiscard]] std::string sampleReport(SampleSet sample,
                                       const ReportOrigin& origin,
                                       const ReportEstimates& estimates);

}  // namespace gonio::proc
