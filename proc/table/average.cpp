#include "proc/table/average.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "proc/core/median.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/budget_shares.h"
#include "proc/table/cell_mean.h"
#include "proc/table/merged_info.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

/// Of the cells. Where more contradict each other, what is common to the rest is no light: of a
/// sample that one rotation shows brighter on one side and darker on the other, half agree.
constexpr double kMostContradicting = 1.0 / 3;

/// One state as one capture has it.
struct Part {
    std::size_t capture = 0;
    const CellSamples* cells = nullptr;
    double shared = 0;  ///< relative part of u_systematic that the captures share
    double light = 0;   ///< relative part of one capture's light
    double scale = 1;
};

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
        result_.outliersOf.resize(captures.size());
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
    std::vector<Part> partsOf(Radians incidence, Band band) const {
        std::vector<Part> parts;
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

    /// The values of a cell that are there, and whose they are.
    struct Present {
        std::vector<CellValue> values;
        std::vector<const Part*> parts;
    };
    static Present presentIn(const std::vector<Part>& parts, std::size_t cell) {
        Present present;
        for (const Part& part : parts) {
            if (!canAverage(*part.cells, cell)) continue;
            const Measured<double> value = part.cells->at(cell);
            present.values.push_back({value, apartFrom(value, part.shared)});
            present.parts.push_back(&part);
        }
        return present;
    }

    /// In the median over the cells that all parts have: how much brighter each is than the first.
    /// What a speck of dust does not reach, however much the light changed.
    static void roughScales(std::vector<Part>& parts) {
        std::vector<std::vector<double>> ratios(parts.size());
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            const Present present = presentIn(parts, cell);
            if (present.values.size() < parts.size()) continue;
            const double first = present.values.front().value.value;
            if (!(first > 0)) continue;
            for (std::size_t i = 0; i < parts.size(); ++i)
                ratios[i].push_back(present.values[i].value.value / first);
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const double scale = ratios[i].empty() ? 1 : median(std::move(ratios[i]));
            parts[i].scale = scale > 0 ? scale : 1;
        }
    }

    /// Over each part's scale.
    static void unscale(Present& present) {
        for (std::size_t i = 0; i < present.values.size(); ++i) {
            const double scale = present.parts[i]->scale;
            present.values[i].value.value /= scale;
            present.values[i].value.uRandom /= scale;
            present.values[i].uApart /= scale;
        }
    }

    /// k_i of each part, from the cells that all of them have and agree on but for the light.
    void findScales(std::vector<Part>& parts, Radians incidence, Band band) {
        if (parts.size() < 2) return;
        roughScales(parts);
        std::vector<double> product(parts.size()), square(parts.size());
        std::size_t compared = 0, contradicting = 0;
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            const Present present = presentIn(parts, cell);
            if (present.values.size() < parts.size()) continue;
            ++compared;
            Present agreeing = present;
            unscale(agreeing);
            if (meanOf(agreeing.values).group.outliers > 0) {
                ++contradicting;  // dust is no change of light
                continue;
            }
            std::vector<double> weights;
            double m = 0, all = 0;
            for (const CellValue& one : present.values) {
                weights.push_back(1 / std::pow(std::max(one.uApart, 1e-30), 2));
                m += weights.back() * one.value.value;
                all += weights.back();
            }
            m /= all;
            for (std::size_t i = 0; i < parts.size(); ++i) {
                product[i] += weights[i] * present.values[i].value.value * m;
                square[i] += weights[i] * m * m;
            }
        }
        const auto isPositive = [](double x) { return x > 0; };
        if (static_cast<double>(contradicting) >
                kMostContradicting * static_cast<double>(compared) ||
            !std::all_of(square.begin(), square.end(), isPositive) ||
            !std::all_of(product.begin(), product.end(), isPositive)) {
            for (Part& part : parts) part.scale = 1;
            return;
        }
        std::vector<double> u;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            parts[i].scale = product[i] / square[i];
            u.push_back(std::hypot(1 / std::sqrt(square[i]), parts[i].light));
        }
        compareScales(parts, u, apartFromMean(u, square), {incidence, band});
    }

    /// u(k_i - 1): the mean that k_i is held against holds k_i itself.
    static std::vector<double> apartFromMean(const std::vector<double>& u,
                                             const std::vector<double>& weights) {
        double sum = 0, squares = 0;
        for (const double weight : weights) sum += weight;
        for (std::size_t i = 0; i < u.size(); ++i) squares += std::pow(weights[i] / sum * u[i], 2);
        std::vector<double> apart;
        for (std::size_t i = 0; i < u.size(); ++i) {
            const double own = weights[i] / sum;
            const double others = std::max(0.0, squares - std::pow(own * u[i], 2));
            apart.push_back(std::sqrt(std::pow((1 - own) * u[i], 2) + others));
        }
        return apart;
    }

    struct State {
        Radians incidence;
        Band band;
    };
    /// Chi-square is about the k's own mean, weighted by 1 / u_i^2: whatever m they are held
    /// against, it has n - 1 degrees of freedom.
    void compareScales(const std::vector<Part>& parts,
                       std::span<const double> u,
                       const std::vector<double>& apart,
                       const State& state) {
        ConsistencySum::Group group{.freedom = parts.size() - 1};
        double mean = 0, sum = 0, squares = 0;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            mean += parts[i].scale / (u[i] * u[i]);
            sum += 1 / (u[i] * u[i]);
        }
        mean /= sum;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const double away = (parts[i].scale - 1) / apart[i];
            group.chiSquare += std::pow((parts[i].scale - mean) / u[i], 2);
            if (std::abs(away) > kOutlier) ++group.outliers;
            squares += std::pow(parts[i].scale - 1, 2);
            result_.states.push_back(
                {parts[i].capture, state.incidence, state.band, parts[i].scale, u[i], away});
        }
        group.relative = std::sqrt(squares / static_cast<double>(group.freedom));
        scales_.add(group);
    }

    CellSamples meanState(Radians incidence, Band band) {
        std::vector<Part> parts = partsOf(incidence, band);
        if (parts.empty()) return {};
        findScales(parts, incidence, band);
        CellSamples mean = CellSamples::missing(CellGrid::count());
        for (std::size_t cell = 0; cell < mean.size(); ++cell) {
            for (const Part& part : parts) {
                mean.flags[cell] = mean.flags[cell] | part.cells->flags[cell];
                mean.flags[cell].clear(Flag::Measured);
                if (canAverage(*part.cells, cell)) mean.nEff[cell] += part.cells->nEff[cell];
            }
            Present present = presentIn(parts, cell);
            if (present.values.empty()) continue;
            const CellMean measured = meanOf(present.values);
            put(mean, cell, measured.mean);
            judge(present, {incidence, band, cell}, mean);
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
    void judge(Present& present, const Place& place, CellSamples& mean) {
        if (present.values.size() < 2) return;
        unscale(present);
        const CellMean same = meanOf(present.values);
        cells_.add(same.group);
        const double middle = same.mean.value;
        for (std::size_t i = 0; i < same.away.size(); ++i) {
            if (std::abs(same.away[i]) <= kOutlier) continue;
            const std::size_t capture = present.parts[i]->capture;
            ++result_.outliersOf[capture];
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
