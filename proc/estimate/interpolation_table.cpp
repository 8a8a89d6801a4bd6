#include "proc/estimate/interpolation_table.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "proc/core/median.h"
#include "proc/estimate/coverage.h"
#include "proc/estimate/sample_estimator.h"
#include "proc/estimate/seed004.h"

namespace gonio::proc {
namespace {

using Made = std::shared_ptr<const Scatterer>;

/// A method as it is, without reciprocity: a baseline.
class Plain final : public Scatterer {
public:
    explicit Plain(std::shared_ptr<const IncidenceMethod> method) : method_(std::move(method)) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override {
        Answer answer;
        answer.f = method_->at(withLightAtZero(pair)).f;
        answer.source = Source::Interpolated;
        return answer;
    }

private:
    std::shared_ptr<const IncidenceMethod> method_;  ///< as methodNamed() gives it
};

/// One that needs neither a carrier nor a prior; null for the others.
Made plain(const SampleSet& set, const std::string& name) {
    const BrdfData data = fitDataOf(set);
    if (name == "same-direction") {
        return std::make_shared<const Plain>(
            sheetMethod(data,
                        std::vector<bool>(data.incidences.size(), true),
                        {.name = name, .frame = IncidenceFrame::SameDirection}));
    }
    auto method = methodNamed(name, data, {}, nullptr);
    return method ? std::make_shared<const Plain>(std::move(*method)) : nullptr;
}

/// The method, and what it chose.
struct Method {
    Made scatterer;
    std::string chosen;
};

Method make(const std::string& name, const SampleSet& set) {
    if (const auto seed = seed004Named(name)) {
        auto chain = makeSeed004(set, *seed);
        return {chain ? Made(std::move(*chain)) : nullptr, ""};
    }
    if (Made baseline = plain(set, name)) return {std::move(baseline), ""};
    auto made = SampleEstimator::over(set, {.method = name, .prior = standardPrior});
    if (!made) return {};
    const MethodChoice& choice = (*made)->choice();
    const std::string chosen =
        name == "auto" ? choice.between.method->name() + ", " + choice.beyond.method->name() : "";
    return {Made(std::move(*made)), chosen};
}

std::vector<StudyMaterial> materialsOf(const InterpolationOptions& options) {
    std::vector<StudyMaterial> all = studyMaterials();
    if (!options.quick) return all;
    std::erase_if(all, [](const StudyMaterial& one) {
        return one.name != "metal .1" && one.name != "plastic .3" && one.name != "GTR 1.5" &&
               one.name != "ABg";
    });
    return all;
}

InterpolationRow rowOf(const std::string& name,
                       const SampleSet& set,
                       const StudyMaterial& material,
                       const InterpolationOptions& options,
                       const Clock& clock) {
    InterpolationRow row{.method = name,
                         .material = material.name,
                         .inFamily = material.inFamily,
                         .inLibrary = material.inLibrary,
                         .chosen = {},
                         .errors = {}};
    const Stopwatch making(clock);
    const Method method = make(name, set);
    if (method.scatterer) {
        (void)method.scatterer->answer(
            {.in = Direction::fromSpherical(30_deg, Radians(0)), .out = Direction()});
    }
    row.makeSeconds = making.elapsed().count();
    row.chosen = method.chosen;
    for (const StudyRegion& region : studyRegions()) {
        Asked asked = region.asked;
        asked.stride = options.quick ? 37 : 7;
        if (!method.scatterer) {
            const double nan = std::numeric_limits<double>::quiet_NaN();
            row.errors.push_back({nan, nan, nan, 1});
            continue;
        }
        row.errors.push_back(errorOf(*method.scatterer, *material.truth, asked));
        if (row.errors.size() > 1) continue;
        row.microseconds = microsecondsPerAnswer(*method.scatterer, askedPairs(asked), clock);
    }
    return row;
}

}  // namespace

const std::vector<StudyRegion>& studyRegions() {
    static const std::vector<StudyRegion> regions{
        {"10/30/50", {.incidences = {10_deg, 30_deg, 50_deg}}},
        {"70", {.incidences = {70_deg}}},
        {"80", {.incidences = {80_deg}}},
        {"out 75-80", {.incidences = {20_deg, 40_deg}, .firstRow = 75, .lastRow = 80}},
        {"out 80-85", {.incidences = {20_deg, 40_deg}, .firstRow = 80, .lastRow = 85}},
        {"out 85-89", {.incidences = {20_deg, 40_deg}, .firstRow = 85, .lastRow = 89}}};
    return regions;
}

std::vector<std::string> studyMethods() {
    return {"same-direction",
            "shepard",
            "axis-linear",
            "grid-linear",
            "specular-linear",
            "specular-log",
            "direction-cosine",
            "half-vector",
            "catmull-rom",
            "carried:lambert+ggx",
            "prior",
            "auto"};
}

std::vector<InterpolationRow> interpolationTable(
    const InterpolationOptions& options,
    const Clock& clock,
    const std::function<void(const std::string&)>& progress) {
    const std::vector<std::string> methods =
        options.methods.empty() ? studyMethods() : options.methods;
    (void)standardPrior();  // once for all, and in no method's time
    std::vector<InterpolationRow> rows;
    for (const StudyMaterial& material : materialsOf(options)) {
        const SampleSet set =
            syntheticSample(*material.truth, {.relativeNoise = options.relativeNoise});
        for (const std::string& name : methods) {
            if (progress) progress(material.name + ", " + name);
            rows.push_back(rowOf(name, set, material, options, clock));
        }
    }
    return rows;
}

std::vector<LobeCurve> lobeCurves(const StudyMaterial& material,
                                  Radians incidence,
                                  const std::vector<std::string>& methods) {
    const SampleSet set = syntheticSample(*material.truth);
    const Direction wi = Direction::fromSpherical(incidence, Radians(0));
    const auto curveOf = [&](const std::string& name, const Scatterer& of) {
        LobeCurve curve{.name = name, .thetaDeg = {}, .f = {}};
        for (double theta = -75; theta <= 75; theta += 0.25) {
            const Direction wo = Direction::fromSpherical(Radians::fromDegrees(std::abs(theta)),
                                                          Radians(theta > 0 ? kPi : 0));
            curve.thetaDeg.push_back(theta);
            curve.f.push_back(of.answer({.in = wi, .out = wo}).f[Band::R]);
        }
        return curve;
    };
    std::vector<LobeCurve> curves{curveOf("truth", *material.truth)};
    for (const std::string& name : methods) {
        if (const Method method = make(name, set); method.scatterer) {
            curves.push_back(curveOf(name, *method.scatterer));
        }
    }
    return curves;
}

InterpolationSummary summaryOf(const std::vector<InterpolationRow>& rows,
                               const std::string& method,
                               bool inFamily,
                               std::size_t region,
                               RegionPart part) {
    InterpolationSummary summary;
    std::vector<double> errors;
    for (const InterpolationRow& row : rows) {
        if (row.method != method || row.inFamily != inFamily) continue;
        ++summary.materials;
        const RegionError& error = row.errors[region];
        const double value = part == RegionPart::Lobe ? error.lobe : error.hemisphere;
        if (!std::isnan(value)) errors.push_back(value);
    }
    summary.answered = errors.size();
    if (errors.empty()) return summary;
    summary.worst = *std::max_element(errors.begin(), errors.end());
    summary.median = median(errors);
    return summary;
}

}  // namespace gonio::proc
