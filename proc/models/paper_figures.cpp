#include "proc/models/paper_figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

/// The five that the paper compares.
constexpr std::array kCompared{
    PowerForm::Schlick, PowerForm::F8, PowerForm::Quadratic, PowerForm::Cubic, PowerForm::Bps};
constexpr std::size_t kBps = 4;

constexpr double PowerError::*kEpicentre = &PowerError::epicentre;
constexpr double PowerError::*kAbsolute = &PowerError::absolute;

/// What the paper says of a form's errors is a largest value, or how often it is the best.
struct Comparison {
    std::vector<PowerError> largest = std::vector<PowerError>(kCompared.size());
    std::vector<PowerError> atThousand;
    double bestInEpicentre = 0;  ///< share of the n at which bps is
    double bestAnywhere = 0;
};

Comparison compare(const PowerGrid& grid, const StudyProgress& progress) {
    Comparison all;
    const std::vector<double> powers = publishedPowers(grid);
    std::vector<PowerError> at;
    const auto isBest = [&](double PowerError::*error) {
        const auto least =
            std::min_element(at.begin(), at.end(), [&](const PowerError& a, const PowerError& b) {
                return a.*error < b.*error;
            });
        return least == at.begin() + kBps ? 1.0 / static_cast<double>(powers.size()) : 0.0;
    };
    for (std::size_t i = 0; i < powers.size(); ++i) {
        if (progress) progress(i, powers.size());
        at = powerErrorsAt(powers[i], kCompared, grid);
        for (std::size_t k = 0; k < at.size(); ++k) {
            PowerError& largest = all.largest[k];
            largest.epicentre = std::max(largest.epicentre, at[k].epicentre);
            largest.absolute = std::max(largest.absolute, at[k].absolute);
        }
        all.bestInEpicentre += isBest(kEpicentre);
        all.bestAnywhere += isBest(kAbsolute);
    }
    all.atThousand = at;
    return all;
}

/// `lastDigit`: one unit of the last that was printed.
PaperFigure figure(std::string what, double printed, double lastDigit, double here) {
    return {.what = std::move(what),
            .printed = shortest(printed),
            .here = here,
            .reproduces = std::round(here / lastDigit) == std::round(printed / lastDigit),
            .remark = ""};
}

PaperFigure mostOf(std::string what, double share) {
    return {.what = std::move(what),
            .printed = "most",
            .here = share,
            .reproduces = share > 0.5,
            .remark = ""};
}

/// A zone a little larger than the epicentre, n t = 0.53, explains three of the paper's figures.
double withinLargerZone(PowerForm form) {
    return relativeErrorWithin(form, 1000, Radians(2 * std::asin(std::sqrt(0.53 / 2000))));
}

}  // namespace

std::vector<PaperFigure> paperFigures(const SchlickRegression& regression,
                                      const PowerGrid& grid,
                                      const StudyProgress& progress) {
    const Comparison all = compare(grid, progress);
    std::vector<PaperFigure> figures{
        figure("regression a", -1.631, 1e-3, regression.a),
        figure("regression b", 2.995, 1e-3, regression.b),
        figure("regression c", -0.374, 1e-3, regression.c),
        figure("regression d", 2.737e-3, 1e-6, regression.d),
    };
    constexpr std::array kPrinted{11.0, 1.8, 3.0, 3.0, 1.1};
    constexpr std::array kDigit{1.0, 0.1, 1.0, 1.0, 0.1};
    for (std::size_t k = 0; k < kCompared.size(); ++k) {
        PaperFigure one = figure("epicentre, %: " + std::string(name(kCompared[k])),
                                 kPrinted[k],
                                 kDigit[k],
                                 100 * all.largest[k].epicentre);
        one.remark = fixed(100 * all.atThousand[k].epicentre, 2) + " at n = 1000; " +
                     fixed(100 * withinLargerZone(kCompared[k]), 2) + " out to n (1 - cos) = 0.53";
        figures.push_back(one);
    }
    const auto addRemarked = [&](PaperFigure one, const std::string& atThousand) {
        one.remark = atThousand + " at n = 1000";
        figures.push_back(std::move(one));
    };
    const auto ratio = [&](const std::vector<PowerError>& of, double PowerError::*error) {
        return of[0].*error / of[kBps].*error;
    };
    addRemarked(figure("absolute: bps", 0.02, 0.01, all.largest[kBps].absolute),
                fixed(all.atThousand[kBps].absolute, 4));
    addRemarked(figure("epicentre, schlick / bps", 10, 1, ratio(all.largest, kEpicentre)),
                fixed(ratio(all.atThousand, kEpicentre), 1));
    addRemarked(figure("absolute, schlick / bps", 10, 1, ratio(all.largest, kAbsolute)),
                fixed(ratio(all.atThousand, kAbsolute), 1));
    figures.push_back(
        mostOf("epicentre, share of n at which bps is the best", all.bestInEpicentre));
    figures.push_back(mostOf("absolute, share of n at which bps is the best", all.bestAnywhere));
    return figures;
}

}  // namespace gonio::proc
