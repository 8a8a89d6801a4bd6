#include "proc/report/estimate_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "proc/core/median.h"
#include "proc/core/parallel.h"
#include "proc/report/plot_request.h"
#include "proc/report/report_words.h"
#include "proc/report/sample_cells.h"

namespace gonio::proc {
namespace {

constexpr std::array<Source, 6> kSources{Source::Measured,
                                         Source::Reciprocity,
                                         Source::Interpolated,
                                         Source::Prior,
                                         Source::Model,
                                         Source::Extrapolated};
constexpr Radians kBeyond = 10_deg, kSteepest = 85_deg;

std::string nameOf(const ChosenMethod& chosen) {
    return chosen.method ? chosen.method->name() : "none";
}

/// Root mean square, from which the noise was taken off.
std::string errorText(double error) { return error > 0 ? relativeText(error) : "below the noise"; }

/// What was answered at one incidence.
struct Asked {
    std::array<double, kSources.size()> share{};
    double none = 0;
    std::vector<double> relative;
};

Asked askAt(const Scatterer& estimator,
            Radians incidence,
            const std::vector<Band>& bands,
            std::size_t every) {
    const Direction wi = Direction::fromSpherical(incidence, Radians(0));
    std::vector<Answer> answers((CellGrid::count() + every - 1) / every);
    parallelFor(answers.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i)
            answers[i] = estimator.answer({.in = wi, .out = CellGrid::centre(i * every)});
    });
    Asked asked;
    double whole = 0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const double omega = CellGrid::solidAngle(i * every);
        whole += omega;
        const Answer& answer = answers[i];
        const auto source = std::find(kSources.begin(), kSources.end(), answer.source);
        if (answer.present() && source != kSources.end()) {
            asked.share[static_cast<std::size_t>(source - kSources.begin())] += omega;
        } else {
            asked.none += omega;
        }
        for (const Band band : bands) {
            const auto u = answer.u(band);
            if (u && std::isfinite(*u) && answer.f[band] > 0)
                asked.relative.push_back(*u / answer.f[band]);
        }
    }
    for (double& share : asked.share) share /= whole;
    asked.none /= whole;
    return asked;
}

/// The sample's, the middles between them, and one beyond the last.
std::vector<Radians> askedIncidences(const SampleSet& sample) {
    std::vector<Radians> all = incidencesOf(sample);
    for (const Radians one : unmeasuredIncidences(sample)) all.push_back(one);
    std::sort(all.begin(), all.end());
    return all;
}

}  // namespace

HtmlTable methodTable(const MethodChoice& choice) {
    HtmlTable table{.caption =
                        "Methods, by what they err where parts of the sample are left out "
                        "(root mean square, less the noise)",
                    .head = {"method",
                             "between: hemisphere",
                             "between: lobe",
                             "beyond: last incidence and edge",
                             "taken"},
                    .rows = {}};
    const std::string between = nameOf(choice.between), beyond = nameOf(choice.beyond);
    for (const MethodScore& score : choice.scores) {
        const bool inside = score.name == between, outside = score.name == beyond;
        const std::string taken = inside && outside ? "between and beyond"
                                  : inside          ? "between"
                                  : outside         ? "beyond"
                                                    : "";
        table.rows.push_back({{score.name},
                              {errorText(score.hemisphere)},
                              {errorText(score.lobe)},
                              {score.beyond ? errorText(*score.beyond) : "not asked"},
                              {taken, taken.empty() ? CellTone::Plain : CellTone::Good}});
    }
    return table;
}

std::string methodSentence(const MethodChoice& choice) {
    const std::string between = nameOf(choice.between), beyond = nameOf(choice.beyond);
    std::string text = "Between the incidences: " + between + "; beyond them and beyond the " +
                       "measured view: " + beyond + ". ";
    return text + (choice.between.errorsKnown
                       ? "Each incidence in between, the last one and the outermost 15 degrees of "
                         "view were left out in turn and predicted from the rest; what a method "
                         "was wrong by there is in the uncertainty of its answers."
                       : "Too few incidences were measured to leave one out: the method's own "
                         "error is not in the uncertainty of its answers.");
}

std::string priorSentence(const SamplePrior* prior) {
    if (prior == nullptr) return "The statistical prior was not asked.";
    const std::string text =
        prior->passes() ? "The sample is like the materials of the statistical prior"
                        : "The sample is not surely like the materials of the statistical prior, "
                          "which therefore was not used";
    std::string bands;
    for (const Band band : kBands) {
        const auto& gate = prior->gates()[index(band)];
        if (!gate) continue;
        double worst = 0;
        for (const double one : gate->predicted)
            worst = std::isnan(one) ? one : std::max(worst, one);
        bands += (bands.empty() ? "" : "; ") + bandName(band) + " " +
                 significant(gate->chiSquare, 3) + " and " + significant(worst, 3);
    }
    if (bands.empty()) return text + ".";
    return text + " (chi-square, wanted at most " + significant(PriorGate::kMost, 3) +
           ", and the worst mean square of an incidence that it predicts from the others, wanted "
           "at most " +
           significant(PriorGate::kMostPredicted, 1) + ", of the first and the last " +
           significant(PriorGate::kMostPredictedAtEnd, 1) + ": " + bands + ").";
}

std::vector<Radians> unmeasuredIncidences(const SampleSet& sample) {
    std::vector<Radians> all;
    for (std::size_t i = 0; i + 1 < sample.leds.size(); ++i)
        all.push_back((sample.leds[i].incidence + sample.leds[i + 1].incidence) / 2);
    if (sample.leds.empty()) return all;
    const Radians beyond = sample.leds.back().incidence + kBeyond;
    if (beyond < kSteepest) all.push_back(beyond);
    return all;
}

HtmlTable sourceTable(const SampleSet& sample, const Scatterer& estimator, std::size_t every) {
    const std::vector<Band> bands = measuredBands(sample);
    std::vector<std::pair<Radians, Asked>> rows;
    std::array<bool, kSources.size()> used{};
    for (const Radians incidence : askedIncidences(sample)) {
        rows.emplace_back(incidence, askAt(estimator, incidence, bands, every));
        for (std::size_t s = 0; s < kSources.size(); ++s)
            used[s] = used[s] || rows.back().second.share[s] > 0;
    }
    HtmlTable table{.caption = "Where answers come from: shares of the hemisphere's solid angle",
                    .head = {"light at"},
                    .rows = {}};
    for (std::size_t s = 0; s < kSources.size(); ++s) {
        if (used[s]) table.head.emplace_back(name(kSources[s]));
    }
    table.head.insert(table.head.end(), {"no answer", "median u / f (k = 1)"});
    for (const auto& [incidence, asked] : rows) {
        std::vector<std::string> row{degreesLabel(incidence)};
        for (std::size_t s = 0; s < kSources.size(); ++s) {
            if (used[s]) row.push_back(shareText(asked.share[s]));
        }
        row.push_back(shareText(asked.none));
        row.push_back(relativeText(median(asked.relative)));
        table.add(row);
    }
    return table;
}

}  // namespace gonio::proc
