#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/core/parallel.h"
#include "proc/estimate/albedo.h"
#include "proc/solve/gauss_kronrod.h"

namespace gonio::proc {
namespace {

/// What adds linearly over incidences, of one band.
struct BandSum {
    double light = 0, errorBound = 0, random = 0, systematic = 0, answered = 0;

    void add(double weight, const BandSum& other) {
        light += weight * other.light;
        errorBound += weight * other.errorBound;
        random += weight * other.random;
        systematic += weight * other.systematic;
        answered += weight * other.answered;
    }
};

struct IncidenceSum {
    std::array<BandSum, 3> bands;

    void add(double weight, const IncidenceSum& other) {
        for (std::size_t band = 0; band < 3; ++band) bands[band].add(weight, other.bands[band]);
    }
};

/// An interval of cos(theta_i).
struct Belt {
    double low = 0, high = 1;
    IncidenceSum value;
    std::array<double, 3> error{};

    [[nodiscard]] double worst() const { return std::max({error[0], error[1], error[2]}); }
    bool operator<(const Belt& other) const { return worst() < other.worst(); }
};

class MeanSum {
public:
    MeanSum(const Scatterer& of, const MeanAlbedoOptions& options) : of_(of), options_(options) {
        belts_.push_back(integrated(0, 1));
    }

    void halveWorst() {
        std::pop_heap(belts_.begin(), belts_.end());
        const Belt worst = belts_.back();
        belts_.pop_back();
        const double middle = (worst.low + worst.high) / 2;
        for (const Belt& half : {integrated(worst.low, middle), integrated(middle, worst.high)}) {
            belts_.push_back(half);
            std::push_heap(belts_.begin(), belts_.end());
        }
    }

    [[nodiscard]] double error() const {
        std::array<double, 3> sum{};
        for (const Belt& belt : belts_) {
            for (std::size_t band = 0; band < 3; ++band) sum[band] += belt.error[band];
        }
        return std::max({sum[0], sum[1], sum[2]});
    }
    [[nodiscard]] std::size_t incidences() const { return incidences_; }

    [[nodiscard]] Albedo albedo() const {
        IncidenceSum total;
        std::array<double, 3> error{};
        for (const Belt& belt : belts_) {
            total.add(1, belt.value);
            for (std::size_t band = 0; band < 3; ++band) error[band] += belt.error[band];
        }
        Albedo mean;
        mean.converged = true;
        for (std::size_t band = 0; band < 3; ++band) {
            mean.bands[band] = bandOf(total.bands[band], error[band]);
            // That of both integrals. A band without an answer has none, and nothing to converge.
            if (mean.bands[band].errorBound > options_.tolerance) mean.converged = false;
        }
        mean.evaluations = evaluations_;
        return mean;
    }

private:
    [[nodiscard]] BandAlbedo bandOf(const BandSum& sum, double outer) const {
        BandAlbedo band;
        band.missing = std::clamp(1 - sum.answered, 0.0, 1.0);
        if (!(sum.answered > 0)) {
            band.value = band.errorBound = std::numeric_limits<double>::quiet_NaN();
            return band;
        }
        band.value = sum.light;
        band.errorBound = sum.errorBound + outer;
        if (randomKnown_) band.uRandom = sum.random;
        if (systematicKnown_) band.uSystematic = sum.systematic;
        return band;
    }

    void addOne(IncidenceSum& sum, double weight, const Albedo& one) {
        evaluations_ += one.evaluations;
        for (std::size_t band = 0; band < 3; ++band) {
            const BandAlbedo& from = one.bands[band];
            if (!std::isfinite(from.value)) continue;
            randomKnown_ = randomKnown_ && from.uRandom.has_value();
            systematicKnown_ = systematicKnown_ && from.uSystematic.has_value();
            sum.bands[band].add(weight,
                                {.light = from.value,
                                 .errorBound = from.errorBound,
                                 .random = from.uRandom.value_or(0),
                                 .systematic = from.uSystematic.value_or(0),
                                 .answered = 1 - from.missing});
        }
    }

    /// All azimuths of one cos(theta_i) after the other, on all cores: an answer may take a
    /// millisecond.
    [[nodiscard]] std::vector<Albedo> directional(const std::vector<double>& mus) const {
        const std::size_t azimuths = azimuthCount();
        std::vector<Albedo> all(mus.size() * azimuths);
        parallelFor(all.size(), [&](IndexRange range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const double mu = mus[i / azimuths];
                const Radians theta(std::atan2(std::sqrt((1 - mu) * (1 + mu)), mu));
                const double turn =
                    static_cast<double>(i % azimuths) / static_cast<double>(azimuths);
                const Direction wi = Direction::fromSpherical(theta, Radians(2 * kPi * turn));
                all[i] = directionalAlbedo(of_, wi, options_.directional);
            }
        });
        return all;
    }
    [[nodiscard]] std::size_t azimuthCount() const {
        return static_cast<std::size_t>(std::max(1, options_.azimuths));
    }

    /// (1 / pi) a cos dw over all azimuths is 2 a mu dmu.
    [[nodiscard]] Belt integrated(double low, double high) {
        Belt belt{low, high, {}, {}};
        IncidenceSum coarse;
        std::vector<double> mus;
        for (const KronrodNode& node : gaussKronrod()) mus.push_back(low + (high - low) * node.x);
        const std::vector<Albedo> all = directional(mus);
        const std::size_t azimuths = azimuthCount();
        incidences_ += mus.size();
        for (std::size_t i = 0; i < mus.size(); ++i) {
            const KronrodNode& node = gaussKronrod()[i];
            const double mu = mus[i];
            IncidenceSum here;
            for (std::size_t k = 0; k < azimuths; ++k) {
                addOne(here, 1.0 / static_cast<double>(azimuths), all[i * azimuths + k]);
            }
            belt.value.add(2 * mu * (high - low) * node.kronrod, here);
            coarse.add(2 * mu * (high - low) * node.gauss, here);
        }
        for (std::size_t band = 0; band < 3; ++band) {
            belt.error[band] = std::abs(belt.value.bands[band].light - coarse.bands[band].light);
        }
        return belt;
    }

    const Scatterer& of_;
    const MeanAlbedoOptions& options_;
    std::vector<Belt> belts_;
    std::size_t incidences_ = 0;
    std::size_t evaluations_ = 0;
    bool randomKnown_ = true;
    bool systematicKnown_ = true;
};

}  // namespace

Albedo meanAlbedo(const Scatterer& of, const MeanAlbedoOptions& options) {
    MeanSum sum(of, options);
    constexpr std::size_t kHalves = 30;  // two rules of 15
    while (sum.error() > options.tolerance &&
           sum.incidences() + kHalves <= options.mostIncidences) {
        sum.halveWorst();
    }
    return sum.albedo();
}

}  // namespace gonio::proc
