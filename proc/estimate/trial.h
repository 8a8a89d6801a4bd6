#pragma once
// A part of a sample left out, to be predicted from the rest.

#include <optional>
#include <vector>

#include "proc/estimate/coverage.h"
#include "proc/estimate/error_model.h"
#include "proc/estimate/error_scale.h"
#include "proc/estimate/incidence_method.h"
#include "proc/fit/brdf_data.h"

namespace gonio::proc {

struct TrialOptions {
    std::size_t stride = 8;      ///< every how many rows of what was left out are predicted
    std::size_t lobeRows = 300;  ///< of each incidence those nearest to the mirror direction, too
};

/// A row to be predicted.
struct Probe {
    std::uint32_t row = 0;
    bool even = true;  ///< see ProbeError
};

class Trial {
public:
    /// An incidence left out.
    [[nodiscard]] static Trial withoutIncidence(const BrdfData& data,
                                                std::size_t group,
                                                const TrialOptions& options);
    /// The outermost 15 degrees of theta_o left out; empty where what is left would reach less than
    /// 20 degrees.
    [[nodiscard]] static std::optional<Trial> withoutEdge(const BrdfData& data,
                                                          const TrialOptions& options);

    /// What a method may see.
    [[nodiscard]] const BrdfData& seen() const { return inner_ ? *inner_ : *data_; }
    [[nodiscard]] const std::vector<bool>& groups() const { return groups_; }
    [[nodiscard]] std::optional<std::size_t> without() const { return without_; }

    /// Of a method made from what it may see, one per value of a band that it has seen, relative to
    /// `scale` of all the data; `off` is NaN where the method has no answer.
    /// Answers are means over a row's nodes, asked both ways (reciprocal_method.h).
    [[nodiscard]] std::vector<ProbeError> errorsOf(const IncidenceMethod& method,
                                                   const ErrorScale& scale) const;

private:
    Trial(const BrdfData& data, std::optional<BrdfData> inner, std::vector<bool> groups);
    void addProbes(std::size_t group, double mostCosine, const TrialOptions& options);

    const BrdfData* data_;           ///< all of it; the caller's
    std::optional<BrdfData> inner_;  ///< of an edge left out
    std::vector<bool> groups_;
    std::optional<std::size_t> without_;
    Coverage coverage_;
    std::vector<Probe> probes_;
};

}  // namespace gonio::proc
