#include "proc/estimate/comparison.h"

#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/parallel.h"
#include "proc/optics/cell_grid.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Sums {
    double relative = 0, relativeWeight = 0;
    double difference = 0, reference = 0;
    double logs = 0, logWeight = 0;
    double cosine = 0, cosineReference = 0;
    double within = 0, overU = 0;
    std::size_t values = 0, stated = 0, oneOnly = 0;

    void add(double a, double b, double weightOfCell, double cosThetaO, std::optional<double> u) {
        const double off = a - b;
        ++values;
        if (b != 0) {
            relative += weightOfCell * (off / b) * (off / b);
            relativeWeight += weightOfCell;
        }
        difference += weightOfCell * off;
        reference += weightOfCell * b;
        cosine += weightOfCell * off * off * cosThetaO * cosThetaO;
        cosineReference += weightOfCell * b * b * cosThetaO * cosThetaO;
        if (a > 0 && b > 0) {
            const double log = std::log(a / b);
            logs += weightOfCell * log * log;
            logWeight += weightOfCell;
        }
        if (!u || !(*u > 0)) return;
        ++stated;
        if (std::abs(off) <= 2 * *u) ++within;
        overU += off * off / (*u * *u);
    }
};

/// Combined; empty where neither surface has one.
std::optional<double> combinedU(const Answer& a, const Answer& b, Band band) {
    const auto one = a.u(band);
    const auto other = b.u(band);
    if (!one && !other) return std::nullopt;
    return std::hypot(one.value_or(0), other.value_or(0));
}

/// NaN over 0.
double over(double sum, double weight) { return weight != 0 ? sum / weight : kNan; }

Difference differenceOf(const Sums& sums) {
    const auto stated = static_cast<double>(sums.stated);
    return {.incidence = {},
            .region = {},
            .values = sums.values,
            .oneOnly = sums.oneOnly,
            .stated = sums.stated,
            .relativeRms = std::sqrt(over(sums.relative, sums.relativeWeight)),
            .relativeMean = over(sums.difference, sums.reference),
            .logRms = std::sqrt(over(sums.logs, sums.logWeight)),
            .cosineRms = std::sqrt(over(sums.cosine, sums.cosineReference)),
            .within2u = over(sums.within, stated),
            .meanSquareOverU = over(sums.overU, stated)};
}

/// Both surfaces at every cell of one incidence.
struct Answers {
    std::vector<Answer> a, b;

    Answers(const Scatterer& first, const Scatterer& second, const Direction& wi)
        : a(CellGrid::count()), b(CellGrid::count()) {
        parallelFor(a.size(), [&](IndexRange range) {
            for (std::size_t cell = range.begin; cell < range.end; ++cell) {
                const LightView pair{.in = wi, .out = CellGrid::centre(cell)};
                a[cell] = first.answer(pair);
                b[cell] = second.answer(pair);
            }
        });
    }
};

Sums sumsOf(const Answers& answers, const Direction& wi, const CompareRegion& region, Band band) {
    Sums sums;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const Direction wo = CellGrid::centre(cell);
        const double away = angleBetween({.in = mirrorOf(wi), .out = wo}).degrees();
        if (away < region.fromDeg || away >= region.toDeg) continue;
        const double a = answers.a[cell].f[band];
        const double b = answers.b[cell].f[band];
        if (std::isnan(a) != std::isnan(b)) ++sums.oneOnly;
        if (std::isnan(a) || std::isnan(b)) continue;
        sums.add(a,
                 b,
                 CellGrid::solidAngle(cell),
                 wo.z(),
                 combinedU(answers.a[cell], answers.b[cell], band));
    }
    return sums;
}

}  // namespace

const std::vector<CompareRegion>& compareRegions() {
    static const std::vector<CompareRegion> regions{
        {"all", 0, 181}, {"lobe", 0, 10}, {"flank", 10, 30}, {"rest", 30, 181}};
    return regions;
}

std::vector<Difference> compareSurfaces(const Scatterer& a,
                                        const Scatterer& b,
                                        const std::vector<Radians>& incidences) {
    const bool mono = a.bandCount() == BandCount::One && b.bandCount() == BandCount::One;
    std::vector<Difference> rows;
    for (const Radians incidence : incidences) {
        const Direction wi = Direction::fromSpherical(incidence, Radians(0));
        const Answers answers(a, b, wi);
        for (const CompareRegion& region : compareRegions()) {
            for (const Band band : kBands) {
                if (mono && band != Band::R) continue;
                const Sums sums = sumsOf(answers, wi, region, band);
                if (sums.values == 0) continue;
                rows.push_back(differenceOf(sums));
                rows.back().incidence = incidence;
                rows.back().region = region.name;
                rows.back().band = band;
            }
        }
    }
    return rows;
}

Agreement agreementOf(const std::vector<Difference>& differences) {
    constexpr double kShare = 0.9;
    double values = 0;
    double stated = 0;
    double within = 0;
    for (const Difference& row : differences) {
        if (row.region != compareRegions().front().name) continue;
        values += static_cast<double>(row.values);
        if (row.stated == 0) continue;
        stated += static_cast<double>(row.stated);
        within += static_cast<double>(row.stated) * row.within2u;
    }
    if (stated < values / 2 || values == 0) return Agreement::Unknown;
    return within >= kShare * stated ? Agreement::Agree : Agreement::Disagree;
}

std::string_view name(Agreement agreement) {
    switch (agreement) {
        case Agreement::Agree: return "agree";
        case Agreement::Disagree: return "disagree";
        case Agreement::Unknown: break;
    }
    return "unknown";
}

}  // namespace gonio::proc
