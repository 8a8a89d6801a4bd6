#include "proc/radiance/frame_residuals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proc/radiance/group_noise.h"

namespace gonio::proc {
namespace {

constexpr double kLeastSignificance = 5;
constexpr double kNominalErrors = 1.96;  // standard uncertainties of scales and zeros: 95 %

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

    /// 1 / variance of what is each sample's own where the light is `light`; 0 of those that are
    /// not usable.
    [[nodiscard]] std::vector<double> weights(const PixelSamples& samples, double light) const {
        std::vector<double> weights(samples.rate.size());
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (!samples.usable[i]) continue;
            const GroupFigures& f = figures_[sums_.witnesses[i].group];
            weights[i] = f.tau * f.tau / (light * f.tau / sums_.members() + f.floorVariance);
        }
        return weights;
    }

    /// What the frames of one exposure share: their dark frame's noise.
    [[nodiscard]] std::vector<SharedNoise> shared() const {
        std::vector<SharedNoise> shared;
        for (const Witness& witness : sums_.witnesses) {
            const GroupFigures& f = figures_[witness.group];
            shared.push_back({.source = firstWithDarkOf(witness.group),
                              .sigma = std::sqrt(f.darkVariance) / f.tau});
        }
        return shared;
    }

    /// 1 for the frames of a group, 0 for the others.
    [[nodiscard]] Eigen::VectorXd framesOf(std::size_t group) const {
        Eigen::VectorXd ones =
            Eigen::VectorXd::Zero(static_cast<Eigen::Index>(sums_.witnesses.size()));
        for (std::size_t i = 0; i < sums_.witnesses.size(); ++i)
            ones(static_cast<Eigen::Index>(i)) = sums_.witnesses[i].group == group ? 1 : 0;
        return ones;
    }

    /// Of a pixel without light in one frame of a group, as a rate.
    [[nodiscard]] double noiseOf(std::size_t group) const {
        return std::sqrt(figures_[group].floorVariance) / figures_[group].tau;
    }
    /// What rounding adds to a whole frame of a group and to its dark frame, as a rate.
    [[nodiscard]] double roundingOf(std::size_t group) const {
        const GroupSums& of = sums_.groups[group];
        const double k = sums_.noise.electronsPerDn;
        const double sigma = std::sqrt(sums_.noise.analogueVariance(of.seconds) / sums_.members());
        return std::numbers::sqrt2 * roundingErrorDn(sigma / k) * k / of.tau;
    }

private:
    [[nodiscard]] std::size_t firstWithDarkOf(std::size_t group) const {
        std::size_t first = 0;
        while (sums_.groups[first].dark != sums_.groups[group].dark) ++first;
        return first;
    }

    const BracketSums& sums_;
    std::vector<GroupFigures> figures_;
};

/// Adds each sample's squared distance from the mean, over its variance: that of the sample less
/// that of the mean.
void addDistances(const PixelSamples& samples,
                  const SharedWeights& weights,
                  std::vector<FrameResidual>& frames) {
    double sum = 0, sumRate = 0;
    int count = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights.inMean(i);
        sumRate += weights.inMean(i) * samples.rate[i];
        count += weights.present(i) ? 1 : 0;
    }
    if (count < 2) return;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (!weights.present(i)) continue;
        const double distance = samples.rate[i] - sumRate / sum;
        frames[i].chiSquare += distance * distance / (weights.variance(i) - 1 / sum);
        ++frames[i].freedom;
    }
}

/// 1 for the frames first .. last, 0 for the others.
Eigen::VectorXd pattern(std::size_t frames, std::size_t first, std::size_t last) {
    Eigen::VectorXd ones = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(frames));
    for (std::size_t i = first; i <= last; ++i) ones(static_cast<Eigen::Index>(i)) = 1;
    return ones;
}

/// What makes frames brighter than they say, without any change of the light: wrong scales of whole
/// groups, the wandering zero of each frame, and where binned pixels have too little noise to hide
/// it, the rounding of all frames of a group.
class NominalErrors {
public:
    NominalErrors(const BracketSums& sums,
                  const Witnesses& witnesses,
                  const NominalUncertainty& nominal) {
        for (std::size_t g = 0; g < sums.groups.size(); ++g) {
            const Eigen::VectorXd frames = witnesses.framesOf(g);
            scales_.emplace_back(nominal.of(sums.groups[g]) * frames);
            zeros_.emplace_back(witnesses.roundingOf(g) * frames);
        }
        for (std::size_t i = 0; i < sums.witnesses.size(); ++i) {
            const double u = nominal.zero * witnesses.noiseOf(sums.witnesses[i].group);
            zeros_.emplace_back(u * pattern(sums.witnesses.size(), i, i));
        }
    }
    /// The standard deviation of what they show along a pattern.
    [[nodiscard]] double along(const ScaleSystem& system, const Eigen::VectorXd& pattern) const {
        double squares = 0;
        for (const Eigen::VectorXd& scale : scales_)
            squares += std::pow(system.seenAlong(pattern, scale), 2);
        for (const Eigen::VectorXd& zero : zeros_)
            squares += std::pow(system.addedAlong(pattern, zero), 2);
        return std::sqrt(squares);
    }

private:
    std::vector<Eigen::VectorXd> scales_;  // of each group: its u, in its frames
    std::vector<Eigen::VectorXd> zeros_;   // of each frame, and of each group's
};

/// The most significant step or single frame that is worth a report.
std::optional<LightChange> changeIn(const ScaleSystem& system,
                                    const NominalErrors& errors,
                                    std::size_t frames,
                                    double smallest) {
    std::optional<LightChange> best;
    const auto consider = [&](std::size_t first, std::size_t last) {
        const Eigen::VectorXd ones = pattern(frames, first, last);
        const auto offset = system.along(ones);
        if (!offset || std::abs(offset->size) < smallest) return;
        const double significance = std::abs(offset->significance());
        const double toBeat = best ? std::abs(best->offset.significance()) : kLeastSignificance;
        if (significance <= toBeat) return;
        const double uNominal = errors.along(system, ones);
        if (std::abs(offset->size) < kNominalErrors * uNominal) return;
        best = {.first = first, .last = last, .offset = *offset, .uNominal = uNominal};
    };
    for (std::size_t first = 1; first < frames; ++first) consider(first, frames - 1);
    // The first and the last one alone are steps as well.
    for (std::size_t frame = 1; frame + 1 < frames; ++frame) consider(frame, frame);
    return best;
}

}  // namespace

FrameReport frameResiduals(const BracketSums& sums,
                           const MergedState& state,
                           double smallest,
                           const NominalUncertainty& nominal) {
    const std::size_t count = sums.witnesses.size();
    FrameReport report;
    for (const Witness& witness : sums.witnesses)
        report.frames.push_back({witness.number, {}, 0, 0});
    const Witnesses witnesses(sums);
    const std::vector<SharedNoise> shared = witnesses.shared();
    ScaleSystem system(count);
    for (int j = 0; j < sums.grid.size.height; ++j) {
        for (int i = 0; i < sums.grid.size.width; ++i) {
            const int x = sums.grid.at(i), y = sums.grid.at(j);
            const auto at = static_cast<std::size_t>(j * sums.grid.size.width + i);
            const PixelSamples samples = witnesses.samples(at, x, y);
            const auto own = static_cast<double>(state.radiance.at(x, y));
            if (std::isfinite(own)) {
                const auto weights = witnesses.weights(samples, std::max(own, 0.0));
                addDistances(samples, {weights, shared}, report.frames);
            }
            if (const auto light = lightAround(state.radiance, x, y)) {
                const auto weights = witnesses.weights(samples, *light);
                system.add(*light, samples.rate, SharedWeights(weights, shared));
            }
        }
    }
    for (std::size_t frame = 0; frame < count; ++frame)
        report.frames[frame].offset = system.along(pattern(count, frame, frame));
    report.change = changeIn(system, {sums, witnesses, nominal}, count, smallest);
    return report;
}

}  // namespace gonio::proc
