#include "proc/table/average.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "proc/core/median.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/budget_shares.h"
#include "proc/table/capture_light.h"
#include "proc/table/cell_mean.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

std::optional<std::size_t> tableAt(const SampleSet& set, Radians incidence) {
    for (std::size_t i = 0; i < set.leds.size(); ++i) {
        if (sameIncidence(set.leds[i].incidence, incidence)) return i;
    }
    return std::nullopt;
}

/// Of all captures, each once.
std::vector<Radians> incidencesOf(std::span<const SampleSet> captures) {
    std::vector<Radians> all;
    for (const SampleSet& set : captures) {
        for (const LedTable& led : set.leds) {
            const bool known = std::any_of(all.begin(), all.end(), [&](Radians one) {
                return sameIncidence(one, led.incidence);
            });
            if (!known) all.push_back(led.incidence);
        }
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Relative: what one capture's light may be off by where no budget says it.
double medianSystematic(const CellSamples& cells) {
    std::vector<double> relative;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        if (cells.present(cell) && cells.f[cell] > 0)
            relative.push_back(cells.uSystematic[cell] / cells.f[cell]);
    }
    return relative.empty() ? 0 : median(std::move(relative));
}

/// Merged captures of several calibrations do not say which is whose.
bool calibratedAlike(std::span<const SampleSet> captures) {
    return std::all_of(captures.begin(), captures.end(), [&](const SampleSet& set) {
        const std::string& id = set.info.calibrationId;
        return id == captures.front().info.calibrationId && !ofSeveral(id);
    });
}

class Averaging {
public:
    explicit Averaging(std::span<const SampleSet> captures)
        : captures_(captures), alike_(calibratedAlike(captures)) {
        for (const SampleSet& set : captures) shares_.push_back(budgetShares(set));
    }

    Averaged run() {
        result_.set.info = captures_.front().info;
        const Radians rotation =
            captures_.front().leds.empty() ? Radians() : captures_.front().leds.front().rotation;
        for (const Radians incidence : incidencesOf(captures_)) {
            LedTable led{.incidence = incidence, .rotation = rotation, .bands = {}};
            for (const Band band : kBands) led.bands[index(band)] = meanState(incidence, band);
            result_.set.leds.push_back(std::move(led));
        }
        std::stable_sort(
            result_.outliers.begin(),
            result_.outliers.end(),
            [](const Outlier& a, const Outlier& b) { return std::abs(a.away) > std::abs(b.away); });
        result_.cells = cells_.result();
        result_.scales = scales_.result();
        if (!weightSquares_.empty()) result_.weightSquares = median(std::move(weightSquares_));
        return std::move(result_);
    }

private:
    std::vector<CapturePart> partsOf(Radians incidence, Band band) const {
        std::vector<CapturePart> parts;
        for (std::size_t c = 0; c < captures_.size(); ++c) {
            const auto table = tableAt(captures_[c], incidence);
            if (!table) continue;
            const CellSamples& cells = captures_[c].leds[*table].bands[index(band)];
            if (cells.size() == 0) continue;
            const BudgetShare& share = shares_[c][*table][index(band)];
            const bool told = share.common > 0 || share.state > 0 || share.cell > 0;
            const double state = told ? share.state : medianSystematic(cells);
            const double light = alike_ ? state / std::sqrt(2.0) : state;
            const double tile = alike_ ? std::hypot(share.cell, share.patch) : 0;
            parts.push_back({.capture = c,
                             .cells = &cells,
                             .shared = std::hypot(share.common, tile, share.state),
                             .light = light});
        }
        return parts;
    }

    CellSamples meanState(Radians incidence, Band band) {
        std::vector<CapturePart> parts = partsOf(incidence, band);
        if (parts.empty()) return {};
        const CaptureLight light = lightOf(parts);
        scales_.add(light.group);
        for (std::size_t i = 0; i < light.scale.size(); ++i) {
            parts[i].scale = light.scale[i];
            result_.states.push_back(
                {parts[i].capture, incidence, band, light.scale[i], light.u[i], light.away[i]});
        }
        CellSamples mean = CellSamples::missing(CellGrid::count());
        for (std::size_t cell = 0; cell < mean.size(); ++cell) {
            for (const CapturePart& part : parts) {
                mean.flags[cell] = mean.flags[cell] | part.cells->flags[cell];
                mean.flags[cell].clear(Flag::Measured);
                if (canAverage(*part.cells, cell)) mean.nEff[cell] += part.cells->nEff[cell];
            }
            PresentValues present = presentIn(parts, cell);
            if (present.values.empty()) continue;
            const CellMean measured = meanOf(present.values);
            put(mean, cell, measured.mean);
            judge(std::move(present), {incidence, band, cell}, mean);
        }
        return mean;
    }

    static void put(CellSamples& cells, std::size_t cell, const Measured<double>& value) {
        cells.f[cell] = value.value;
        cells.uRandom[cell] = value.uRandom;
        cells.uSystematic[cell] = value.uSystematic;
        cells.flags[cell] = value.flags;
    }

    struct Place {
        Radians incidence;
        Band band;
        std::size_t cell;
    };
    /// Without what the light of each capture explains. Where the values still contradict each
    /// other, the mean's u_random is what they agree to.
    void judge(PresentValues present, const Place& place, CellSamples& mean) {
        if (present.values.size() < 2) return;
        present = withoutLight(std::move(present));
        const CellMean same = meanOf(present.values);
        cells_.add(same.group);
        const double middle = same.mean.value;
        for (std::size_t i = 0; i < same.away.size(); ++i) {
            if (std::abs(same.away[i]) <= kOutlier) continue;
            const std::size_t capture = present.captures[i];
            result_.outliers.push_back({capture,
                                        place.incidence,
                                        place.band,
                                        place.cell,
                                        same.away[i],
                                        present.values[i].value.value / middle - 1});
        }
        mean.uRandom[place.cell] = std::max(mean.uRandom[place.cell], same.uAgreed);
        if (same.group.outliers > 0) return;
        double squares = 0;
        for (const CellValue& one : present.values) squares += std::pow(one.value.uRandom, 2);
        const double each = std::sqrt(squares / static_cast<double>(present.values.size()));
        if (each > 0) weightSquares_.push_back(std::pow(mean.uRandom[place.cell] / each, 2));
    }

    std::span<const SampleSet> captures_;
    bool alike_;
    std::vector<BudgetShares> shares_;
    ConsistencySum cells_, scales_;
    std::vector<double> weightSquares_;
    Averaged result_;
};

}  // namespace

Averaged averageOf(std::span<const SampleSet> captures) { return Averaging(captures).run(); }

}  // namespace gonio::proc
