#include "proc/models/power_errors.h"

#include <algorithm>
#include <cmath>

namespace gonio::proc {
namespace {

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

/// To `value` where that is larger or none.
void raise(double& worst, double value) {
    if (!(value <= worst)) worst = value;
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
        raise(values.error.absolute, error);
        if (i < points.epicentre) raise(values.error.epicentre, error / exact);
        values.least = std::min(values.least, value);
        if (exact < 1e-6) raise(values.residue, error);
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

std::vector<double> allPowers(const PowerGrid& grid) {
    std::vector<double> powers = geometric(1, std::nextafter(8.0F, 0.0F), grid.otherPowers);
    for (const double n : publishedPowers(grid)) powers.push_back(n);
    for (const double n : geometric(1001, 1e6, grid.otherPowers)) powers.push_back(n);
    return powers;
}

void take(PowerErrors& errors, double n, const ValuesAt& values) {
    if (n < 8) return raise(errors.belowEight, values.error.absolute);
    if (n > 1000) return raise(errors.aboveThousand, values.error.absolute);
    raise(errors.absolute, values.error.absolute);
    raise(errors.epicentre, values.error.epicentre);
    if (std::abs(values.peak - 1) > std::abs(errors.peak - 1)) errors.peak = values.peak;
    errors.least = std::min(errors.least, values.least);
    raise(errors.residue, values.residue);
}

template <std::floating_point T>
void takeAll(std::span<PowerErrors> errors, double n, const PowerGrid& grid) {
    const PowerPoints<T> points = pointsOf<T>(n, grid);
    for (PowerErrors& one : errors) {
        take(one, static_cast<double>(points.n), valuesOf(one.form, points));
    }
}

}  // namespace

PowerGrid PowerGrid::quick() {
    return {.powerStep = 16, .otherPowers = 20, .epicentre = 60, .lobe = 200, .rest = 30};
}

std::vector<double> publishedPowers(const PowerGrid& grid) {
    std::vector<double> powers;
    for (int n = 8; n < 1000; n += grid.powerStep) powers.push_back(n);
    powers.push_back(1000);
    return powers;
}

std::vector<PowerError> powerErrorsAt(double n,
                                      std::span<const PowerForm> forms,
                                      const PowerGrid& grid) {
    const PowerPoints<double> points = pointsOf<double>(n, grid);
    std::vector<PowerError> errors;
    for (const PowerForm form : forms) errors.push_back(valuesOf(form, points).error);
    return errors;
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
    for (const PowerForm form : kPowerForms) {
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

}  // namespace gonio::proc
