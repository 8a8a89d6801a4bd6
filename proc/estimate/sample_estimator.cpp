#include "proc/estimate/sample_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/estimate/reciprocal_method.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kPriorMaterials = 2000;

Flags correctionsOf(const SampleSet& set) {
    Flags any;
    for (const LedTable& led : set.leds) {
        for (const CellSamples& cells : led.bands) {
            for (const Flags flags : cells.flags) any = any | flags;
        }
    }
    Flags corrections;
    for (const Flag flag : {Flag::GlareCorrected, Flag::TiltCorrected, Flag::DriftCorrected}) {
        if (any.has(flag)) corrections.set(flag);
    }
    return corrections;
}

enum class Kind {
    Sheets,
    Carried,
    Model,
    Prior
};

Kind kindOf(const IncidenceMethod& method) {
    if (method.ownError()) return Kind::Prior;
    if (!method.anchored()) return Kind::Model;
    return method.name().rfind("carried:", 0) == 0 ? Kind::Carried : Kind::Sheets;
}

/// Where an answer between the incidences comes from.
void labelBetween(Answer& answer, Kind kind, double exchanged) {
    if (kind == Kind::Prior) {
        answer.source = Source::Prior;
        answer.flags.set(Flag::Prior);
        return;
    }
    if (kind == Kind::Model || kind == Kind::Carried) answer.flags.set(Flag::Model);
    if (kind == Kind::Model) {
        answer.source = Source::Model;
        return;
    }
    answer.flags.set(Flag::Interpolated);
    const bool mostlyExchanged = exchanged > 0.5;
    if (mostlyExchanged) answer.flags.set(Flag::Reciprocity);
    answer.source = mostlyExchanged ? Source::Reciprocity : Source::Interpolated;
}

void labelBeyond(Answer& answer, Kind kind) {
    answer.flags.set(Flag::Extrapolated);
    switch (kind) {
        case Kind::Sheets: answer.source = Source::Extrapolated; break;
        case Kind::Carried:
        case Kind::Model:
            answer.source = Source::Model;
            answer.flags.set(Flag::Model);
            break;
        case Kind::Prior:
            answer.source = Source::Prior;
            answer.flags.set(Flag::Prior);
            break;
    }
}

/// One method's part of an answer.
struct Part {
    LedBands f, uRandom, uSystematic;
    std::array<BandWay, 3> ways;
    bool errorKnown = true;  ///< of the method, in all bands
};

/// Where a method answers what was measured.
bool isMeasured(const IncidenceMethod& method, const Reach& reach) {
    return method.anchored() && reach.within() && reach.between < 1e-4;
}

Part partOf(const ChosenMethod& chosen, const Coverage& coverage, const LightView& pair) {
    const IncidenceMethod& method = *chosen.method;
    const ReciprocalAnswer got = reciprocalAnswer(method, coverage, pair);
    Part part{got.value.f, got.value.uRandom, got.value.uSystematic, got.ways};
    const Radians away = angleBetween({.in = mirrorOf(pair.in), .out = pair.out});
    for (const Band band : kBands) {
        const Reach& reach = got.ways[index(band)].reach;
        double own = 0;
        if (chosen.errorsKnown && !method.ownError()) {
            own = chosen.errors.of(part.f[band], index(band), reach, away);
        }
        const bool known = method.ownError() || chosen.errorsKnown || isMeasured(method, reach);
        if (!std::isnan(part.f[band])) part.errorKnown = part.errorKnown && known;
        // What a function of all data is wrong by, it is wrong by everywhere alike.
        if (!method.anchored()) own = std::hypot(own, std::exchange(part.uRandom[band], 0.0));
        part.uSystematic[band] = std::hypot(part.uSystematic[band], own);
    }
    return part;
}

/// 0 to 1 with a slope of 0 at both ends.
double smooth(double x) { return x * x * (3 - 2 * x); }

}  // namespace

std::shared_ptr<const PriorBasis> standardPrior() {
    static const std::shared_ptr<const PriorBasis> basis = [] {
        auto made = PriorBasis::over(PriorLibrary::standard(kPriorMaterials));
        return made ? std::make_shared<const PriorBasis>(std::move(*made)) : nullptr;
    }();
    return basis;
}

SampleEstimator::SampleEstimator(std::shared_ptr<const Scatterer> measured,
                                 BrdfData data,
                                 SampleEstimatorOptions options)
    : measured_(std::move(measured)),
      sample_(dynamic_cast<const SampleLookup*>(measured_.get())),
      options_(std::move(options)),
      data_(std::move(data)),
      coverage_(data_, std::vector<bool>(data_.incidences.size(), true)) {
    if (sample_ != nullptr) corrections_ = correctionsOf(sample_->set());
}

Result<std::unique_ptr<const SampleEstimator>> SampleEstimator::over(
    SampleSet set, SampleEstimatorOptions options) {
    if (rotationsOf(set).size() > 1) {
        return Error{ErrorKind::Usage,
                     "estimate: a sample of several rotations is not taken as isotropic; look it "
                     "up, or average its rotations"};
    }
    set = unturned(std::move(set));
    BrdfData data = fitDataOf(set);
    auto lookup = std::make_shared<const SampleLookup>(std::move(set));  // the estimator's own
    return over(std::move(lookup), std::move(data), std::move(options));
}

Result<std::unique_ptr<const SampleEstimator>> SampleEstimator::over(
    std::shared_ptr<const Scatterer> measured, BrdfData data, SampleEstimatorOptions options) {
    std::unique_ptr<const SampleEstimator> made(
        new SampleEstimator(std::move(measured), std::move(data), std::move(options)));
    if (made->data_.rows.empty()) {
        return Error{ErrorKind::Quality,
                     "estimate: no value can be used: all are missing, saturated or blocked"};
    }
    const std::string& wanted = made->options_.method;
    if (wanted == "auto") return made;
    const std::vector<std::string> known = methodNames();
    if (std::find(known.begin(), known.end(), wanted) == known.end()) {
        return methodNamed(wanted, made->data_, {}, nullptr).error();
    }
    if (!made->choice().between.method) {
        return methodNamed(wanted, made->data_, made->choice_.carriers, made->prior()).error();
    }
    return made;
}

void SampleEstimator::choose() const {
    const std::vector<bool> all(data_.incidences.size(), true);
    const bool draft = options_.effort == Effort::Draft;
    const std::string& method = options_.method;
    if (options_.prior && (method == "prior" || (method == "auto" && !draft))) {
        samplePrior_ = std::make_unique<const SamplePrior>(options_.prior(), data_);
    }
    MethodChoiceOptions how;
    how.learn = !draft;
    how.only = method == "auto" ? "" : method;
    if (options_.effort == Effort::Reference) how.fit.rows = 6000;
    choice_ = chooseMethod(data_, samplePrior_.get(), how);
}

const MethodChoice& SampleEstimator::choice() const {
    std::call_once(chosen_, [this] { choose(); });
    return choice_;
}

const SamplePrior* SampleEstimator::prior() const {
    (void)choice();
    return samplePrior_.get();
}

Answer SampleEstimator::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Interpolated);
    }
    const std::array<bool, 3> usable = measuredBands(pair);
    const auto is = [](bool b) { return b; };
    if (std::none_of(usable.begin(), usable.end(), is)) return estimate(pair);
    const Answer measured = measured_->answer(pair);
    if (measured.source != Source::Measured) return estimate(pair);
    if (std::all_of(usable.begin(), usable.end(), is) && measured.present()) return measured;
    Answer answer = estimate(pair);
    for (const Band band : kBands) {
        if (!usable[index(band)] || std::isnan(measured.f[band])) continue;
        answer.f[band] = measured.f[band];
        const auto take = [band](std::optional<LedBands>& to, const std::optional<LedBands>& from) {
            if (to && from) (*to)[band] = (*from)[band];
        };
        take(answer.uRandom, measured.uRandom);
        take(answer.uSystematic, measured.uSystematic);
    }
    return answer;
}

std::array<bool, 3> SampleEstimator::measuredBands(const LightView& pair) const {
    constexpr double kSame = 1e-4;  // degrees
    const auto at = [&](Radians incidence) {
        return std::abs((incidence - pair.in.theta()).degrees()) < kSame;
    };
    if (sample_ == nullptr) {
        const bool any = std::any_of(data_.incidences.begin(), data_.incidences.end(), at);
        return {any, any, any};
    }
    std::array<bool, 3> usable{};
    const auto cell = CellGrid::cellAt(pair.out.turned(-pair.in.phi()));
    for (const LedTable& led : sample_->set().leds) {
        if (!cell || !at(led.incidence)) continue;
        for (std::size_t b = 0; b < 3; ++b) usable[b] = led.bands[b].usable(*cell);
    }
    return usable;
}

const ChosenMethod& SampleEstimator::methodBetween(const LightView& pair) const {
    const MethodChoice& chosen = choice();
    if (!chosen.anchored.method || chosen.between.method->anchored()) return chosen.between;
    const auto reach = coverage_.at(withLightAtZero(pair));
    const bool measured =
        std::all_of(reach.begin(),
                    reach.begin() + static_cast<std::ptrdiff_t>(data_.bandsUsed()),
                    [&](const Reach& one) { return isMeasured(*chosen.anchored.method, one); });
    return measured ? chosen.anchored : chosen.between;
}

Answer SampleEstimator::estimate(const LightView& pair) const {
    const MethodChoice& chosen = choice();
    const ChosenMethod& between = methodBetween(pair);
    const Part inside = partOf(between, coverage_, pair);
    LedBands share;  // of the method beyond
    double least = 1;
    double most = 0;
    double exchanged = 1;
    for (std::size_t b = 0; b < data_.bandsUsed(); ++b) {
        share.value[b] = smooth(std::min(1.0, inside.ways[b].off));
        least = std::min(least, share.value[b]);
        most = std::max(most, share.value[b]);
        exchanged = std::min(exchanged, inside.ways[b].exchanged);
    }
    Answer answer;
    answer.flags = corrections_;
    answer.f = inside.f;
    LedBands uRandom = inside.uRandom;
    LedBands uSystematic = inside.uSystematic;
    bool errorKnown = least >= 1 || inside.errorKnown;
    // Of three bands, the one that is farthest from what was measured says where the answer is
    // from.
    if (most < 0.5) labelBetween(answer, kindOf(*between.method), exchanged);
    if (most > 0) {
        const Part outside = partOf(chosen.beyond, coverage_, pair);
        for (const Band band : kBands) {
            const auto blend = [t = share[band]](double& to, double other) {
                to = (1 - t) * to + t * other;
            };
            blend(answer.f[band], outside.f[band]);
            blend(uRandom[band], outside.uRandom[band]);
            blend(uSystematic[band], outside.uSystematic[band]);
        }
        errorKnown = errorKnown && outside.errorKnown;
        if (most >= 0.5) labelBeyond(answer, kindOf(*chosen.beyond.method));
        if (most < 0.5) answer.flags.set(Flag::Extrapolated);
    }
    if (errorKnown) {
        if (data_.uKnown) answer.uRandom = uRandom;
        answer.uSystematic = uSystematic;
    }
    if (data_.bands == BandCount::One) {
        answer.f = LedBands::all(answer.f[Band::R]);
        if (answer.uRandom) answer.uRandom = LedBands::all(uRandom[Band::R]);
        if (answer.uSystematic) answer.uSystematic = LedBands::all(uSystematic[Band::R]);
    }
    return answer;
}

}  // namespace gonio::proc
