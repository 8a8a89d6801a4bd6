#include "proc/estimate/carrier_fit.h"

#include <algorithm>
#include <cmath>

#include "proc/core/parallel.h"
#include "proc/fit/common_uncertainty.h"
#include "proc/fit/model_fit.h"
#include "proc/fit/thinned_rows.h"

namespace gonio::proc {
namespace {

/// Of the shared parameters and the band's own, 0 where one is held or not determined.
Eigen::MatrixXd bandCovariance(const ModelFit& fit, std::size_t band, std::size_t bands) {
    const std::size_t shared = fit.family->sharedCount();
    std::vector<Eigen::Index> places;
    for (std::size_t i = 0; i < shared; ++i) places.push_back(static_cast<Eigen::Index>(i));
    for (std::size_t k = 0; k < fit.family->perBandCount(); ++k) {
        places.push_back(static_cast<Eigen::Index>(shared + k * bands + std::min(band, bands - 1)));
    }
    const Eigen::MatrixXd own = fit.covariance(places, places);
    return own.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

std::optional<Carrier> fitOne(const std::string& name,
                              const BrdfData& data,
                              const CarrierFitOptions& options) {
    const Result<const Family*> family = familyNamed(name);
    if (!family) return std::nullopt;
    ModelFitOptions how{.startRows = 200,
                        .heldOutRows = 0,
                        .maxIterations = options.maxIterations,
                        .tolerance = options.tolerance};
    if (options.startedAt != nullptr) {
        const auto start = options.startedAt->find(name);
        if (start != options.startedAt->end()) how.start = start->second.point;
    }
    const ModelFit fit = fitModel(**family, data, how);
    if (!fit.usable()) return std::nullopt;
    Carrier carrier{*family, fit.point, {}};
    for (std::size_t b = 0; b < 3; ++b) {
        carrier.commonRelative[b] = commonRelative(data, std::min(b, data.bandsUsed() - 1));
        carrier.covariance[b] = bandCovariance(fit, b, data.bandsUsed());
    }
    return carrier;
}

}  // namespace

const std::vector<std::string>& carrierFamilies() {
    static const std::vector<std::string> names{"lambert+ggx",
                                                "lambert+beckmann",
                                                "lambert+gtr",
                                                "oren-nayar+ggx",
                                                "lambert+ggx+ggx",
                                                "lambert+ggx+retro"};
    return names;
}

Carriers fitCarriers(const BrdfData& data,
                     const std::vector<bool>& groups,
                     const CarrierFitOptions& options) {
    const BrdfData few = withRows(data, thinnedRows(data, groups, options.rows));
    const std::vector<std::string>& names =
        options.families.empty() ? carrierFamilies() : options.families;
    std::vector<std::optional<Carrier>> fits(names.size());
    parallelFor(names.size(), [&](IndexRange range) {
        for (std::size_t i = range.begin; i < range.end; ++i) {
            fits[i] = fitOne(names[i], few, options);
        }
    });
    Carriers carriers;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (fits[i]) carriers[names[i]] = std::move(*fits[i]);
    }
    return carriers;
}

std::optional<std::string> bestByChiSquare(const BrdfData& data, const Carriers& carriers) {
    std::optional<std::string> best;
    double least = 0;
    for (const auto& [name, carrier] : carriers) {
        double sum = 0;
        for (const FitRow& row : data.rows) {
            const LedBands model = carrier.family->f(carrier.point, data.nodesOf(row));
            for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
                const double z = (row.f[b] - model.value[b]) / data.uOf(row, b);
                if (!std::isnan(z)) sum += z * z;
            }
        }
        if (best && sum >= least) continue;
        best = name;
        least = sum;
    }
    return best;
}

}  // namespace gonio::proc
