#include "proc/radiance/merge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "proc/core/parallel.h"
#include "proc/radiance/exposure_groups.h"
#include "proc/radiance/saturation.h"

namespace gonio::proc {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// One row of one group: for each pixel the sum of its usable samples and how many they are.
struct RowSums {
    std::vector<double> dn;  ///< dark subtracted
    std::vector<int> count;
    std::vector<std::uint8_t> usable;  ///< of the frame at hand
    std::vector<double> excess;        ///< of a hot pixel: more variance, electrons^2; mostly 0
};

/// What does not depend on the pixel, worked out once.
struct GroupConstants {
    double tau = 0;
    double floorVariance = 0;  ///< electrons^2, one sample in the dark
    double darkVariance = 0;   ///< electrons^2, of the dark frame
    double excessInDark = 0;   ///< share of a sample's excess that the dark frame has
};

struct Tally {
    std::size_t allSaturated = 0;
    std::size_t freedom = 0;
    double chiSquare = 0;
};

class Merger {
public:
    Merger(const std::vector<ExposureGroup>& groups, const SensorNoise& noise, MergedState& out)
        : groups_(groups),
          k_(noise.electronsPerDn),
          noise_(noise),
          members_(out.window.binning * out.window.binning),
          out_(out) {
        for (const ExposureGroup& group : groups) {
            const double rounding = k_ * k_ / 12;
            const double analogue = noise.darkVariance(group.seconds) - rounding;
            constants_.push_back({.tau = group.tau,
                                  .floorVariance = analogue / members_ + rounding,
                                  .darkVariance = group.dark->varianceOfMean * k_ * k_,
                                  .excessInDark = 1.0 / std::max(1, group.dark->frames)});
            frames_ += group.frames.size();
        }
    }

    Tally rows(IndexRange range) const {
        const auto width = static_cast<std::size_t>(out_.radiance.width());
        std::vector<RowSums> sums(groups_.size(),
                                  {std::vector<double>(width),
                                   std::vector<int>(width),
                                   std::vector<std::uint8_t>(width),
                                   std::vector<double>(width)});
        Tally tally;
        for (std::size_t y = range.begin; y < range.end; ++y) {
            for (std::size_t g = 0; g < groups_.size(); ++g)
                accumulate(groups_[g], static_cast<int>(y), sums[g]);
            estimate(sums, static_cast<int>(y), tally);
        }
        return tally;
    }

private:
    void accumulate(const ExposureGroup& group, int y, RowSums& sums) const {
        std::fill(sums.dn.begin(), sums.dn.end(), 0.0);
        std::fill(sums.count.begin(), sums.count.end(), 0);
        std::fill(sums.excess.begin(), sums.excess.end(), 0.0);
        const auto dark = group.dark->mean.row(y);
        const auto hot = group.dark->hotInRow(y);
        for (const HotPixel& h : hot)
            sums.excess[static_cast<std::size_t>(h.x)] = h.excessDn * k_ / members_;
        for (const Frame* frame : group.frames) {
            const auto row = frame->pixels.row(y);
            markUsable(frame->pixels, y, noise_, sums.usable);
            for (const HotPixel& h : hot) {
                sums.usable[static_cast<std::size_t>(h.x)] =
                    usableReference(frame->pixels, h.x, y, noise_, h.excessDn) ? 1 : 0;
            }
            for (std::size_t x = 0; x < row.size(); ++x) {
                const int usable = sums.usable[x];
                sums.dn[x] += usable * (row[x] - static_cast<double>(dark[x]));
                sums.count[x] += usable;
            }
        }
    }

    void estimate(const std::vector<RowSums>& sums, int y, Tally& tally) const {
        for (int x = 0; x < out_.radiance.width(); ++x) pixel(sums, x, y, tally);
    }

    void pixel(const std::vector<RowSums>& sums, int x, int y, Tally& tally) const {
        const auto i = static_cast<std::size_t>(x);
        double electrons = 0;
        double tau = 0;
        int used = 0;
        for (std::size_t g = 0; g < sums.size(); ++g) {
            electrons += sums[g].dn[i] * k_;
            tau += sums[g].count[i] * constants_[g].tau;
            used += sums[g].count[i];
        }
        out_.used.at(x, y) = static_cast<std::uint8_t>(std::min(used, 255));
        const int masked = static_cast<int>(frames_) - used;
        out_.saturated.at(x, y) = static_cast<std::uint8_t>(std::min(masked, 255));
        if (used == 0) {
            out_.radiance.at(x, y) = out_.variance.at(x, y) = kNan;
            ++tally.allSaturated;
            return;
        }
        // Inverse variance with weights from the pooled estimate; chi^2 by its moments.
        const double pooled = std::max(electrons / tau, 0.0);
        double w = 0, wx = 0, wxx = 0;
        std::size_t groups = 0;
        for (std::size_t g = 0; g < sums.size(); ++g) {
            const int n = sums[g].count[i];
            if (n == 0) continue;
            const GroupConstants& c = constants_[g];
            const double excess = sums[g].excess[i];
            const double single = pooled * c.tau / members_ + c.floorVariance + excess;
            const double variance = single / n + (c.darkVariance + excess * c.excessInDark);
            const double weight = c.tau * c.tau / variance;
            const double value = sums[g].dn[i] * k_ / (n * c.tau);
            w += weight;
            wx += weight * value;
            wxx += weight * value * value;
            ++groups;
        }
        out_.radiance.at(x, y) = static_cast<float>(wx / w);
        out_.variance.at(x, y) = static_cast<float>(1 / w);
        tally.freedom += groups - 1;
        if (groups > 1) tally.chiSquare += std::max(0.0, wxx - wx * wx / w);
    }

    const std::vector<ExposureGroup>& groups_;
    std::vector<GroupConstants> constants_;
    std::size_t frames_ = 0;
    double k_;
    const SensorNoise& noise_;
    double members_;  ///< sensor pixels that one pixel is the mean of
    MergedState& out_;
};

MergedState blank(const Frame& first, Band band) {
    const Size size = first.pixels.size();
    MergedState state;
    state.radiance = Image<float>(size, kNan);
    state.variance = Image<float>(size, kNan);
    state.used = Image<std::uint8_t>(size);
    state.saturated = Image<std::uint8_t>(size);
    state.window = first.window;
    state.led = first.led.value_or(0);
    state.band = band;
    return state;
}

}  // namespace

Result<MergedState> merge(std::span<const Frame> bracket,
                          Band band,
                          const DarkLibrary& darks,
                          const SensorNoise& noise) {
    Result<std::vector<ExposureGroup>> groups = exposureGroups(bracket, band, darks);
    if (!groups) return groups.error();
    MergedState state = blank(bracket.front(), band);
    const Merger merger(*groups, noise, state);
    const auto height = static_cast<std::size_t>(state.radiance.height());
    std::vector<Tally> tallies(height);  // by row, added in order: the sum is the same on any cores
    parallelFor(height, [&](IndexRange range) {
        for (std::size_t y = range.begin; y < range.end; ++y) tallies[y] = merger.rows({y, y + 1});
    });
    for (const Tally& tally : tallies) {
        state.allSaturatedPixels += tally.allSaturated;
        state.freedom += tally.freedom;
        state.chiSquare += tally.chiSquare;
    }
    return state;
}

}  // namespace gonio::proc
