#include "proc/estimate/error_scale.h"

#include <vector>

namespace gonio::proc {
namespace {

struct Mean {
    double sum = 0;
    double weight = 0;
};

}  // namespace

ErrorScale::ErrorScale(const BrdfData& data) : ErrorScale() {
    for (std::size_t b = 0; b < data.bandsUsed(); ++b) {
        std::vector<Mean> means(data.incidences.size());
        for (const FitRow& row : data.rows) {
            if (std::isnan(row.f[b])) continue;
            const double weight = row.solidAngle * row.cosThetaO;
            means[row.group].sum += weight * row.f[b];
            means[row.group].weight += weight;
        }
        Mean all;
        for (const Mean& mean : means) {
            if (mean.weight <= 0) continue;
            all.sum += mean.sum / mean.weight;
            all.weight += 1;
        }
        if (all.weight > 0) mean_[b] = std::max(0.0, all.sum / all.weight);
    }
}

}  // namespace gonio::proc
