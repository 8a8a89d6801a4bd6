#include "proc/estimate/prior_method.h"

#include <cmath>
#include <limits>

#include "proc/fit/common_uncertainty.h"
#include "proc/fit/thinned_rows.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Values that a posterior is made from.
constexpr std::size_t kRows = 6000;
/// The posterior's deviation is taken as larger by this: materials of the library's own kind that
/// it had not seen lay within twice the deviation in 93 % instead of 95.4 % of their directions.
constexpr double kWidening = 1.1;

class PriorMethod final : public IncidenceMethod {
public:
    PriorMethod(std::shared_ptr<const PriorBasis> basis,
                std::array<std::optional<PriorPosterior>, 3> posteriors,
                std::array<double, 3> commonRelative)
        : basis_(std::move(basis)),
          posteriors_(std::move(posteriors)),
          commonRelative_(commonRelative) {}

    [[nodiscard]] std::string name() const override { return "prior"; }
    [[nodiscard]] bool anchored() const override { return false; }
    [[nodiscard]] bool ownError() const override { return true; }

    [[nodiscard]] MethodAnswer at(const LightView& pair) const override {
        const Eigen::VectorXd functions = basis_->at(pair);
        const double rest = basis_->restVariance(pairOf<double>(pair));
        const double cosines = pair.in.z() * pair.out.z();
        MethodAnswer answer;
        for (const Band band : kBands) {
            const auto& posterior = posteriors_[index(band)];
            if (!posterior) {
                answer.f[band] = answer.uRandom[band] = answer.uSystematic[band] = kNan;
                continue;
            }
            const PriorPosterior::Value value = posterior->at(functions, rest);
            const double g = std::exp(value.y);
            answer.f[band] = (g - kPriorFloor) / cosines;
            answer.uRandom[band] = g * kWidening * value.deviation / cosines;
            answer.uSystematic[band] = commonRelative_[index(band)] * std::abs(answer.f[band]);
        }
        return answer;
    }

private:
    std::shared_ptr<const PriorBasis> basis_;
    std::array<std::optional<PriorPosterior>, 3> posteriors_;
    std::array<double, 3> commonRelative_;
};

}  // namespace

SamplePrior::SamplePrior(std::shared_ptr<const PriorBasis> basis, const BrdfData& data)
    : basis_(std::move(basis)) {
    const std::size_t groups = data.incidences.size();
    const BrdfData few = withRows(data, thinnedRows(data, std::vector(groups, true), kRows));
    const Eigen::MatrixXd functions = basis_->at(few);
    for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
        PriorEvidence evidence(*basis_, few, functions, b);
        if (evidence.empty()) continue;
        gates_[b] = priorGate(evidence, groups);
        evidence_[b] = std::move(evidence);
        commonRelative_[b] = sharedRelative(few, b);
    }
}

bool SamplePrior::passes() const {
    bool any = false;
    for (const auto& gate : gates_) {
        if (!gate) continue;
        if (!gate->passes()) return false;
        any = true;
    }
    return any;
}

std::unique_ptr<const IncidenceMethod> SamplePrior::method(
    std::optional<std::size_t> without) const {
    std::array<std::optional<PriorPosterior>, 3> posteriors;
    for (std::size_t b = 0; b < 3; ++b) {
        if (evidence_[b]) posteriors[b] = evidence_[b]->posterior(without);
    }
    return std::make_unique<PriorMethod>(basis_, std::move(posteriors), commonRelative_);
}

}  // namespace gonio::proc
