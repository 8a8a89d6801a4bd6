#include "daemon/cli/fit_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "proc/core/number_text.h"
#include "proc/fit/residual_map.h"

namespace gonio::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json orNull(const std::optional<double>& value) { return value ? orNull(*value) : Json(nullptr); }

Json matrixJson(const Eigen::MatrixXd& matrix) {
    Json rows = Json::array();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        Json row = Json::array();
        for (Eigen::Index k = 0; k < matrix.cols(); ++k) row.push_back(orNull(matrix(i, k)));
        rows.push_back(row);
    }
    return rows;
}

Json parametersJson(const proc::ModelFit& fit) {
    Json all = Json::array();
    for (const proc::FittedParameter& p : fit.parameters) {
        const char* bound = p.atLower ? "lower" : "upper";
        all.push_back({{"name", p.name},
                       {"band", p.band ? Json(std::string(letter(*p.band))) : Json(nullptr)},
                       {"unit", p.unit},
                       {"value", orNull(p.value)},
                       {"u_random", orNull(p.uRandom)},
                       {"u_systematic", orNull(p.uSystematic)},
                       {"lower", p.lower},
                       {"upper", p.upper},
                       {"at_bound", p.atLower || p.atUpper ? Json(bound) : Json(nullptr)}});
    }
    return all;
}

Json heldOutJson(const proc::ModelFit& fit) {
    Json all = Json::array();
    for (const proc::HeldOut& one : fit.heldOut) {
        all.push_back({{"incidence_deg", one.incidence.degrees()},
                       {"rms", orNull(one.rms)},
                       {"energy_rms", orNull(one.energyRms)},
                       {"chi_square_mean", orNull(one.chiSquare)}});
    }
    return all;
}

Json residualsJson(const proc::ModelFit& fit, const proc::BrdfData& data) {
    Json all = Json::array();
    const auto rms = proc::residualRms(fit, data);
    for (std::size_t g = 0; g < rms.size(); ++g) {
        Json bands = Json::array();
        for (std::size_t b = 0; b < data.bandsUsed(); ++b) bands.push_back(orNull(rms[g][b]));
        all.push_back({{"incidence_deg", data.incidences[g].degrees()}, {"normalised_rms", bands}});
    }
    return all;
}

Json modelJson(const proc::RankedFit& one, const proc::BrdfData& data) {
    const proc::ModelFit& fit = one.fit;
    const bool usable = fit.usable();
    const auto ifUsable = [&](double value) { return usable ? orNull(value) : Json(nullptr); };
    return {{"model", fit.family->name()},
            {"spec", fit.spec},
            {"status", std::string(name(fit.status))},
            {"message", fit.message},
            {"iterations", fit.iterations},
            {"starts", fit.starts},
            {"parameters", parametersJson(fit)},
            {"covariance", matrixJson(fit.covariance)},
            {"correlation", matrixJson(fit.correlation)},
            {"condition", orNull(fit.condition)},
            {"warnings", fit.warnings},
            {"chi_square", ifUsable(fit.chiSquare)},
            {"values", fit.values},
            {"chi_square_per_dof", ifUsable(fit.chiSquarePerDof())},
            {"aic", ifUsable(fit.aic())},
            {"bic", ifUsable(fit.bic())},
            {"rest_rms", ifUsable(one.restRms)},
            {"held_out", heldOutJson(fit)},
            {"held_out_rms", orNull(fit.heldOutRms())},
            {"held_out_energy_rms", orNull(fit.heldOutEnergyRms())},
            {"residuals", usable ? residualsJson(fit, data) : Json::array()},
            {"evaluation_ns", orNull(one.nanoseconds)},
            {"pareto", one.pareto},
            {"rejected", one.rejected},
            {"probability", ifUsable(one.probability)},
            {"apart_in_u_systematic", ifUsable(one.apart)}};
}

std::string cell(std::optional<double> value) { return value ? perCent(*value) : ""; }

}  // namespace

Json fitJson(const proc::Selection& selection, const proc::BrdfData& data) {
    Json models = Json::array();
    for (const proc::RankedFit& one : selection.ranked) models.push_back(modelJson(one, data));
    Json worst = Json::array();
    for (const proc::Misfit& one : selection.worst) {
        worst.push_back({{"incidence_deg", one.incidence.degrees()},
                         {"region", one.region},
                         {"chi_square_mean", orNull(one.chiSquare)},
                         {"mean_ratio", orNull(one.meanRatio)},
                         {"values", one.values}});
    }
    const auto named = [&](const std::optional<std::size_t>& at) {
        return at ? Json(selection.ranked[*at].fit.family->name()) : Json(nullptr);
    };
    Json incidences = Json::array();
    for (const Radians incidence : data.incidences) incidences.push_back(incidence.degrees());
    return {{"schema", "gonio/fit/1"},
            {"incidences_deg", incidences},
            {"values", data.valueCount()},
            {"left_out", data.leftOut},
            {"assumed_relative_u", data.uKnown ? Json(nullptr) : Json(data.assumedRelative)},
            {"models", models},
            {"chosen", named(selection.chosen)},
            {"best", named(selection.best)},
            {"gate", selection.gate},
            {"misfit_in_u_systematic", orNull(selection.misfit)},
            {"worst", worst},
            {"verdict", selection.verdict}};
}

std::string fitMarkdown(const proc::Selection& selection) {
    std::string text = selection.verdict + "\n\n";
    text +=
        "| model | parameters | held-out rms | energy rms | chi2/dof | AIC | BIC | ns | Pareto | "
        "spec |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for (const proc::RankedFit& one : selection.ranked) {
        const proc::ModelFit& fit = one.fit;
        if (!fit.usable()) {
            text += "| " + fit.family->name() + " | " + std::to_string(fit.parameterCount()) +
                    " | | | | | | | | " + fit.message + " |\n";
            continue;
        }
        text += "| " + fit.family->name() + " | " + std::to_string(fit.parameterCount()) + " | " +
                cell(fit.heldOutRms()) + " | " + cell(fit.heldOutEnergyRms()) + " | " +
                fixed(fit.chiSquarePerDof(), 3) + " | " + fixed(fit.aic(), 0) + " | " +
                fixed(fit.bic(), 0) + " | " + (one.nanoseconds ? fixed(*one.nanoseconds, 1) : "") +
                " | " + (one.pareto ? "yes" : "") + " | `" + fit.spec + "` |\n";
    }
    if (!selection.worst.empty()) {
        text +=
            "\n| incidence | region | mean (f - model)^2 / u^2 | f / model | values |\n"
            "|---|---|---|---|---|\n";
    }
    for (const proc::Misfit& one : selection.worst) {
        text += "| " + fixed(one.incidence.degrees(), 1) + " deg | " + one.region + " | " +
                fixed(one.chiSquare, 2) + " | " +
                (std::isfinite(one.meanRatio) ? fixed(one.meanRatio, 3) : "the model is 0") +
                " | " + std::to_string(one.values) + " |\n";
    }
    return text;
}

}  // namespace gonio::daemon
