#include "proc/models/power_study.h"

#include <Eigen/QR>
#include <array>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr std::array kForms{PowerForm::Full75,
                            PowerForm::Full54,
                            PowerForm::Lite,
                            PowerForm::Sq8d3,
                            PowerForm::Sq8,
                            PowerForm::Rec3m4,
                            PowerForm::Rec2m4,
                            PowerForm::Schlick,
                            PowerForm::Bps,
                            PowerForm::F8,
                            PowerForm::Quadratic,
                            PowerForm::Cubic,
                            PowerForm::Gauss,
                            PowerForm::Lagarde,
                            PowerForm::Pow};

template <std::floating_point T>
using Evaluation = T (*)(T n, const NearOne<T>& x);

template <std::floating_point T>
Evaluation<T> evaluation(PowerForm form) {
    switch (form) {
        case PowerForm::Pow: return power<PowerForm::Pow, T>;
        case PowerForm::Full75: return power<PowerForm::Full75, T>;
        case PowerForm::Full54: return power<PowerForm::Full54, T>;
        case PowerForm::Lite: return power<PowerForm::Lite, T>;
        case PowerForm::Sq8d3: return power<PowerForm::Sq8d3, T>;
        case PowerForm::Sq8: return power<PowerForm::Sq8, T>;
        case PowerForm::Rec3m4: return power<PowerForm::Rec3m4, T>;
        case PowerForm::Rec2m4: return power<PowerForm::Rec2m4, T>;
        case PowerForm::Schlick: return power<PowerForm::Schlick, T>;
        case PowerForm::Bps: return power<PowerForm::Bps, T>;
        case PowerForm::F8: return power<PowerForm::F8, T>;
        case PowerForm::Quadratic: return power<PowerForm::Quadratic, T>;
        case PowerForm::Cubic: return power<PowerForm::Cubic, T>;
        case PowerForm::Gauss: return power<PowerForm::Gauss, T>;
        case PowerForm::Lagarde: return power<PowerForm::Lagarde, T>;
    }
    return power<PowerForm::Pow, T>;
}

/// Cosines of one n, as a form is given them, and the truth.
template <std::floating_point T>
struct PowerPoints {
    T n{};
    std::vector<NearOne<T>> x;
    std::vector<double> exact;
    std::size_t epicentre = 0;  ///< how many of them, at the front, lie in it

    void add(double theta) {
        const double half = std::sin(theta / 2);
        const NearOne<T> point{.c = static_cast<T>(std::max(0.0, std::cos(theta))),
                               .t = static_cast<T>(2 * half * half)};
        const auto power = static_cast<long double>(n);
        const long double value =
            point.c > T(0.5) ? std::exp(power * std::log1p(-static_cast<long double>(point.t)))
                             : std::pow(static_cast<long double>(point.c), power);
        x.push_back(point);
        exact.push_back(static_cast<double>(value));
    }

    void addEvenly(double from, double to, int count) {
        for (int i = 1; i <= count; ++i) add(from + (to - from) * i / count);
    }
};

template <std::floating_point T>
PowerPoints<T> pointsOf(double n, const PowerGrid& grid) {
    PowerPoints<T> points;
    points.n = static_cast<T>(n);
    points.add(0);
    if (n > 1) points.addEvenly(0, std::atan(1 / std::sqrt(n - 1)), grid.epicentre);
    points.epicentre = points.x.size();
    const double edge = 2 * std::asin(std::sqrt(std::min(0.5, 20 / n)));  // n t = 40
    points.addEvenly(0, edge, grid.lobe);
    points.addEvenly(edge, kPi / 2, grid.rest);
    return points;
}

struct ValuesAt {
    PowerError error;
    double peak = 1;
    double least = 1;
    double residue = 0;
};

template <std::floating_point T>
ValuesAt valuesOf(PowerForm form, const PowerPoints<T>& points) {
    const Evaluation<T> f = evaluation<T>(form);
    ValuesAt values;
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        const double exact = points.exact[i];
        const auto value = static_cast<double>(f(points.n, points.x[i]));
        const double error = std::abs(value - exact);
        values.error.absolute = std::max(values.error.absolute, error);
        if (i < points.epicentre) {
            values.error.epicentre = std::max(values.error.epicentre, error / exact);
        }
        values.least = std::min(values.least, value);
        if (exact < 1e-6) values.residue = std::max(values.residue, error);
    }
    values.peak = static_cast<double>(f(points.n, points.x.front()));
    return values;
}

/// Ends included.
std::vector<double> geometric(double from, double to, int count) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        values.push_back(from * std::pow(to / from, static_cast<double>(i) / (count - 1)));
    }
    return values;
}

std::vector<double> publishedPowers(const PowerGrid& grid) {
    std::vector<double> powers;
    for (int n = 8; n < 1000; n += grid.powerStep) powers.push_back(n);
    powers.push_back(1000);
    return powers;
}

std::vector<double> allPowers(const PowerGrid& grid) {
    std::vector<double> powers = geometric(1, std::nextafter(8.0F, 0.0F), grid.otherPowers);
    for (const double n : publishedPowers(grid)) powers.push_back(n);
    for (const double n : geometric(1001, 1e6, grid.otherPowers)) powers.push_back(n);
    return powers;
}

void take(PowerErrors& errors, double n, const ValuesAt& values) {
    const auto grow = [&](double& worst) { worst = std::max(worst, values.error.absolute); };
    if (n < 8) return grow(errors.belowEight);
    if (n > 1000) return grow(errors.aboveThousand);
    grow(errors.absolute);
    errors.epicentre = std::max(errors.epicentre, values.error.epicentre);
    if (std::abs(values.peak - 1) > std::abs(errors.peak - 1)) errors.peak = values.peak;
    errors.least = std::min(errors.least, values.least);
    errors.residue = std::max(errors.residue, values.residue);
}

template <std::floating_point T>
void takeAll(std::span<PowerErrors> errors, double n, const PowerGrid& grid) {
    const PowerPoints<T> points = pointsOf<T>(n, grid);
    for (PowerErrors& one : errors) {
        take(one, static_cast<double>(points.n), valuesOf(one.form, points));
    }
}

/// The five that the paper compares.
constexpr std::array kCompared{
    PowerForm::Schlick, PowerForm::F8, PowerForm::Quadratic, PowerForm::Cubic, PowerForm::Bps};
constexpr std::size_t kBps = 4;

constexpr double PowerError::*kEpicentre = &PowerError::epicentre;
constexpr double PowerError::*kAbsolute = &PowerError::absolute;

/// What the paper says of a form's errors is a largest value, or how often it is the best.
struct Comparison {
    std::array<PowerError, kCompared.size()> largest;
    std::array<PowerError, kCompared.size()> atThousand;
    double bestInEpicentre = 0;  ///< share of the n at which bps is
    double bestAnywhere = 0;
};

Comparison compare(const PowerGrid& grid, const StudyProgress& progress) {
    Comparison all;
    const std::vector<double> powers = publishedPowers(grid);
    std::array<PowerError, kCompared.size()> at;
    const auto isBest = [&](double PowerError::*error) {
        const auto least =
            std::min_element(at.begin(), at.end(), [&](const PowerError& a, const PowerError& b) {
                return a.*error < b.*error;
            });
        return least == at.begin() + kBps ? 1.0 / static_cast<double>(powers.size()) : 0.0;
    };
    for (std::size_t i = 0; i < powers.size(); ++i) {
        if (progress) progress(i, powers.size());
        const PowerPoints<double> points = pointsOf<double>(powers[i], grid);
        for (std::size_t k = 0; k < at.size(); ++k) {
            at[k] = valuesOf(kCompared[k], points).error;
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

std::span<const PowerForm> powerForms() { return kForms; }

std::string_view name(PowerForm form) {
    switch (form) {
        case PowerForm::Pow: return "pow";
        case PowerForm::Full75: return "full75";
        case PowerForm::Full54: return "full54";
        case PowerForm::Lite: return "lite";
        case PowerForm::Sq8d3: return "sq8d3";
        case PowerForm::Sq8: return "sq8";
        case PowerForm::Rec3m4: return "rec3m4";
        case PowerForm::Rec2m4: return "rec2m4";
        case PowerForm::Schlick: return "schlick";
        case PowerForm::Bps: return "bps";
        case PowerForm::F8: return "f8";
        case PowerForm::Quadratic: return "quadratic";
        case PowerForm::Cubic: return "cubic";
        case PowerForm::Gauss: return "gauss";
        case PowerForm::Lagarde: return "lagarde";
    }
    return "";
}

bool isOurs(PowerForm form) {
    const auto* first = std::find(kForms.begin(), kForms.end(), form);
    return first < std::find(kForms.begin(), kForms.end(), PowerForm::Schlick);
}

SchlickRegression regressSchlick(const RegressionGrid& grid) {
    constexpr Eigen::Index kColumns = 5;  // 1, s, s^2, s^3 and the truth
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(kColumns + grid.angles, kColumns);
    for (int n = 1; n <= grid.powers; ++n) {
        for (int i = 0; i < grid.angles; ++i) {
            const double c = std::cos(grid.thetaStep * i);
            const double s = c / (n - n * c + c);
            block.row(kColumns + i) << 1, s, s * s, s * s * s, std::pow(c, n);
        }
        const Eigen::HouseholderQR<Eigen::MatrixXd> qr(block);
        block.topRows(kColumns) = qr.matrixQR().topRows(kColumns).triangularView<Eigen::Upper>();
    }
    const Eigen::Matrix<double, kColumns, kColumns> r = block.topRows(kColumns);
    const Eigen::Vector4d k =
        r.topLeftCorner<4, 4>().triangularView<Eigen::Upper>().solve(r.col(4).head<4>());
    const auto rows = static_cast<std::size_t>(grid.powers) * static_cast<std::size_t>(grid.angles);
    return {.a = k[3],
            .b = k[2],
            .c = k[1],
            .d = k[0],
            .rms = std::abs(r(4, 4)) / std::sqrt(static_cast<double>(rows)),
            .rows = rows};
}

PowerGrid PowerGrid::quick() {
    return {.powerStep = 16, .otherPowers = 20, .epicentre = 60, .lobe = 200, .rest = 30};
}

PowerError powerError(PowerForm form, double n, const PowerGrid& grid) {
    return valuesOf(form, pointsOf<double>(n, grid)).error;
}

double relativeErrorWithin(PowerForm form, double n, Radians theta) {
    PowerPoints<double> points;
    points.n = n;
    points.addEvenly(0, theta.value(), 1000);
    points.epicentre = points.x.size();
    return valuesOf(form, points).error.epicentre;
}

double PowerErrors::fromEight() const { return std::max(absolute, aboveThousand); }
double PowerErrors::anyPower() const { return std::max(fromEight(), belowEight); }

std::vector<PowerErrors> powerErrors(const PowerGrid& grid, const StudyProgress& progress) {
    std::vector<PowerErrors> exact;
    std::vector<PowerErrors> narrow;
    for (const PowerForm form : kForms) {
        exact.push_back({.form = form, .precision = Precision::Double});
        narrow.push_back({.form = form, .precision = Precision::Float});
    }
    const std::vector<double> powers = allPowers(grid);
    for (std::size_t i = 0; i < powers.size(); ++i) {
        if (progress) progress(i, powers.size());
        takeAll<double>(exact, powers[i], grid);
        takeAll<float>(narrow, powers[i], grid);
    }
    exact.insert(exact.end(), narrow.begin(), narrow.end());
    return exact;
}

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
    const auto ratio = [&](const std::array<PowerError, kCompared.size()>& of,
                           double PowerError::*error) { return of[0].*error / of[kBps].*error; };
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
