#include "proc/estimate/study_materials.h"

#include <cmath>

#include "proc/models/spec.h"

namespace gonio::proc {
namespace {

/// A formula with an answer at every pair above the horizon.
template <class F>
class Formula final : public Scatterer {
public:
    explicit Formula(F f) : f_(std::move(f)) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
            return Answer::none({Flag::BelowHorizon}, Source::Analytic);
        }
        Answer answer;
        answer.f = f_(pair);
        return answer;
    }

private:
    F f_;
};

template <class F>
std::shared_ptr<const Scatterer> formula(F f) {
    return std::make_shared<const Formula<F>>(std::move(f));
}

StudyMaterial model(std::string name, std::string spec, bool inFamily) {
    auto made = makeModel(spec);
    std::shared_ptr<const Scatterer> truth = std::move(*made);  // the specs below are good
    return {std::move(name), std::move(spec), inFamily, true, std::move(truth)};
}

StudyMaterial abg() {
    constexpr double kA = 2e-3;
    constexpr double kB = 4e-3;
    constexpr double kG = 2.2;
    return {"ABg", "A = 2e-3, B = 4e-3, g = 2.2", false, false, formula([](const LightView& pair) {
                const double off =
                    std::hypot(pair.out.x() + pair.in.x(), pair.out.y() + pair.in.y());
                return LedBands::all(kA / (kB + std::pow(off, kG)));
            })};
}

StudyMaterial retroSheen() {
    auto made = makeModel("lambert,albedo=0.15+ggx,alpha=0.3,f0=0.04");
    std::shared_ptr<const Scatterer> base = std::move(*made);  // of the formula's copies
    return {
        "retro sheen",
        "lambert,albedo=0.15+ggx,alpha=0.3,f0=0.04 + 0.15 (wi.wo)^30 + 0.1 (1 - cos d)^5 / cos d",
        false,
        false,
        formula([base](const LightView& pair) {
            const double together = std::max(0.0, pair.in.vector().dot(pair.out.vector()));
            const double cosD = std::sqrt((1 + pair.in.vector().dot(pair.out.vector())) / 2);
            const double extra =
                0.15 * std::pow(together, 30) + 0.1 * std::pow(1 - cosD, 5) / (cosD + 1e-3);
            return base->answer(pair).f + LedBands::all(extra);
        })};
}

}  // namespace

std::vector<StudyMaterial> studyMaterials() {
    return {
        model("metal .05", "ggx,alpha=0.05,f0=0.9/0.7/0.4", true),
        model("metal .1", "ggx,alpha=0.1,f0=0.9/0.7/0.4", true),
        model("metal .3", "ggx,alpha=0.3,f0=0.9/0.7/0.4", true),
        model("plastic .1", "lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.1,f0=0.04", true),
        model("plastic .3", "lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.3,f0=0.04", true),
        model("black .2", "lambert,albedo=0.02+ggx,alpha=0.2,f0=0.04", true),
        model("Beckmann", "lambert,albedo=0.02+beckmann,alpha=0.2,f0=0.6", false),
        model("GTR 1.5", "lambert,albedo=0.05+gtr,alpha=0.12,gamma=1.5,f0=0.5", false),
        model(
            "coated metal", "clearcoat,strength=1,gloss=0.2+ggx,alpha=0.35,f0=0.8/0.6/0.3", false),
        model("Oren-Nayar + GGX", "oren-nayar,albedo=0.4,sigma=0.5+ggx,alpha=0.2,f0=0.04", false),
        abg(),
        retroSheen()};
}

}  // namespace gonio::proc
