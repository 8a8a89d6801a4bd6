#include "proc/radiance/frame_residuals.h"

#include <algorithm>
#include <cmath>

#include "proc/radiance/group_noise.h"

namespace gonio::proc {
namespace {

constexpr double kLeastSignificance = 5;

/// What all frames saw at one pixel: rates in electrons per second at full level.
struct PixelSamples {
    std::vector<double> rate;
    std::vector<bool> usable;
};

class Witnesses {
public:
    explicit Witnesses(const BracketSums& sums) : sums_(sums) {
        for (const GroupSums& group : sums.groups) figures_.push_back(figuresOf(group, sums));
    }

    /// Of witness pixel `at`, which is pixel (x, y).
    [[nodiscard]] PixelSamples samples(std::size_t at, int x, int y) const {
        const std::size_t count = sums_.witnesses.size();
        PixelSamples samples{std::vector<double>(count), std::vector<bool>(count)};
        for (std::size_t i = 0; i < count; ++i) {
            const Witness& witness = sums_.witnesses[i];
            if (witness.dn[at] == Witness::kMasked) continue;
            const GroupSums& group = sums_.groups[witness.group];
            const double seen = sums_.linearity.corrected(witness.dn[at]);
            const double dark =
                sums_.linearity.corrected(static_cast<double>(group.dark->mean.at(x, y)));
            samples.rate[i] = (seen - dark) * sums_.noise.electronsPerDn / group.tau;
            samples.usable[i] = true;
        }
        return samples;
    }

    /// 1 / variance of each sample where the light is `light`; 0 of those that are not usable.
    [[nodiscard]] std::vector<double> weights(const PixelSamples& samples, double light) const {
        std::vector<double> weights(samples.rate.size());
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (!samples.usable[i]) continue;
            const GroupFigures& f = figures_[sums_.witnesses[i].group];
            weights[i] = f.tau * f.tau /
                         (light * f.tau / sums_.members() + f.floorVariance + f.darkVariance);
        }
        return weights;
    }

private:
    const BracketSums& sums_;
    std::vector<GroupFigures> figures_;
};

struct Mean {
    double weight = 0, rate = 0;
    int count = 0;
};

Mean meanOf(const PixelSamples& samples, const std::vector<double>& weights) {
    Mean mean;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        mean.weight += weights[i];
        mean.rate += weights[i] * samples.rate[i];
        mean.count += weights[i] > 0 ? 1 : 0;
    }
    if (mean.count > 0) mean.rate /= mean.weight;
    return mean;
}

/// Adds each sample's squared distance from the mean, over its variance: that of the sample less
/// that of the mean.
void addDistances(const PixelSamples& samples,
                  const std::vector<double>& weights,
                  std::vector<FrameResidual>& frames) {
    const Mean mean = meanOf(samples, weights);
    if (mean.count < 2) return;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i] == 0) continue;
        const double distance = samples.rate[i] - mean.rate;
        frames[i].chiSquare += distance * distance / (1 / weights[i] - 1 / mean.weight);
        ++frames[i].freedom;
    }
}

/// 1 for the frames first .. last, 0 for the others.
Eigen::VectorXd pattern(std::size_t frames, std::size_t first, std::size_t last) {
    Eigen::VectorXd ones = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(frames));
    for (std::size_t i = first; i <= last; ++i) ones(static_cast<Eigen::Index>(i)) = 1;
    return ones;
}

/// The most significant step or single frame that is worth a report.
std::optional<LightChange> changeIn(const ScaleSystem& system,
                                    std::size_t frames,
                                    double smallest) {
    std::optional<LightChange> best;
    const auto consider = [&](std::size_t first, std::size_t last) {
        const auto offset = system.along(pattern(frames, first, last));
        if (!offset) return;
        const double significance = std::abs(offset->significance());
        const double toBeat = best ? std::abs(best->offset.significance()) : kLeastSignificance;
        if (significance > toBeat) best = {.first = first, .last = last, .offset = *offset};
    };
    for (std::size_t first = 1; first < frames; ++first) consider(first, frames - 1);
    // The first and the last one alone are steps as well.
    for (std::size_t frame = 1; frame + 1 < frames; ++frame) consider(frame, frame);
    if (best && std::abs(best->offset.size) < smallest) return std::nullopt;
    return best;
}

}  // namespace

FrameReport frameResiduals(const BracketSums& sums, const MergedState& state, double smallest) {
    const std::size_t count = sums.witnesses.size();
    FrameReport report;
    for (const Witness& witness : sums.witnesses)
        report.frames.push_back({witness.number, {}, 0, 0});
    const Witnesses witnesses(sums);
    ScaleSystem system(count);
    for (int j = 0; j < sums.grid.size.height; ++j) {
        for (int i = 0; i < sums.grid.size.width; ++i) {
            const int x = sums.grid.at(i), y = sums.grid.at(j);
            const auto at = static_cast<std::size_t>(j * sums.grid.size.width + i);
            const PixelSamples samples = witnesses.samples(at, x, y);
            const auto own = static_cast<double>(state.radiance.at(x, y));
            if (std::isfinite(own))
                addDistances(
                    samples, witnesses.weights(samples, std::max(own, 0.0)), report.frames);
            if (const auto light = lightAround(state.radiance, x, y))
                system.add(*light, samples.rate, witnesses.weights(samples, *light));
        }
    }
    for (std::size_t frame = 0; frame < count; ++frame)
        report.frames[frame].offset = system.along(pattern(count, frame, frame));
    report.change = changeIn(system, count, smallest);
    return report;
}

}  // namespace gonio::proc
