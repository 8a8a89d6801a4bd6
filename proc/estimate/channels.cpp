#include "proc/estimate/channels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "proc/estimate/sheet.h"
#include "proc/estimate/shepard.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Radians kPartner = 0.1_deg;
constexpr Radians kNear = 3_deg;
constexpr std::size_t kNearest = 4;
constexpr std::size_t kFewestNeighbours = 3;

/// The table of this LED at this rotation; null where there is none with the band.
const LedTable* tableLike(const SampleSet& set, const LedTable& led, Band band) {
    for (const LedTable& one : set.leds) {
        if (sameLight(one, led) && one.bands[index(band)].size() > 0) return &one;
    }
    return nullptr;
}

/// Every LED and rotation that any of the bands has, with what each has of it.
std::vector<LedTable> tablesOf(const std::array<const SampleSet*, 3>& bands) {
    SampleSet all;
    for (const SampleSet* const set : bands) {
        for (const LedTable& led : set->leds) {
            const bool known = std::any_of(all.leds.begin(), all.leds.end(), [&](const auto& one) {
                return sameLight(one, led);
            });
            if (!known)
                all.leds.push_back(
                    {.incidence = led.incidence, .rotation = led.rotation, .bands = {}});
        }
    }
    sortTables(all);
    for (LedTable& led : all.leds) {
        for (const Band band : kBands) {
            const LedTable* const own = tableLike(*bands[index(band)], led, band);
            if (own != nullptr) led.bands[index(band)] = own->bands[index(band)];
        }
    }
    return std::move(all.leds);
}

/// Empty where too few of the cells around it were measured.
std::optional<Measured<double>> aroundCell(const CellSamples& cells, std::size_t cell) {
    Measured<double> mean{.value = 0, .uRandom = 0, .uSystematic = 0, .flags = {}};
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, count = 0;
    for (const std::uint32_t near : neighboursOf(cell)) {
        if (!cells.usable(near)) continue;
        count += 1;
        mean.value += cells.f[near];
        mean.uRandom += cells.uRandom[near];
        mean.uSystematic += cells.uSystematic[near];
        lowest = std::min(lowest, cells.f[near]);
        highest = std::max(highest, cells.f[near]);
    }
    if (count < kFewestNeighbours) return std::nullopt;
    mean.value /= count;
    mean.uSystematic /= count;
    mean.uRandom = std::max(mean.uRandom / count, (highest - lowest) / 2);
    mean.flags.set(Flag::Interpolated);
    return mean;
}

void fillTable(LedTable& led, std::array<ChannelCount, 3>& counts) {
    const std::array<CellSamples, 3> before = led.bands;
    for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
        const bool any = std::any_of(before.begin(), before.end(), [&](const CellSamples& cells) {
            return cells.size() > 0 && cells.present(cell);
        });
        if (!any) continue;
        for (std::size_t b = 0; b < 3; ++b) {
            if (before[b].size() == 0) {
                ++counts[b].missing;
                continue;
            }
            if (before[b].present(cell)) {
                ++counts[b].partners;
                continue;
            }
            const auto estimate = aroundCell(before[b], cell);
            if (!estimate) {
                ++counts[b].missing;
                continue;
            }
            ++counts[b].estimated;
            CellSamples& cells = led.bands[b];
            cells.f[cell] = estimate->value;
            cells.uRandom[cell] = estimate->uRandom;
            cells.uSystematic[cell] = estimate->uSystematic;
            cells.flags[cell] = cells.flags[cell] | estimate->flags;
        }
    }
}

/// f of one band at a pair, with what is known of it.
class Channel {
public:
    explicit Channel(const ScatteredSet& set) : set_(set) {}

    static Result<Channel> over(const ScatteredSet& set) {
        Channel channel(set);
        auto made = makeShepard(
            set, {.fewest = 1, .most = kNearest, .maxDistance = 2 * std::sin(kNear.value() / 2)});
        if (!made) return made.error();
        channel.estimate_ = std::move(*made);
        return channel;
    }

    [[nodiscard]] std::optional<SampleId> partner(const LightView& pair) const {
        const auto near =
            set_.nearest(pair, {.count = 1, .maxDistance = 2 * std::sin(kPartner.value() / 2)});
        if (near.empty()) return std::nullopt;
        return near.front().id;
    }

    /// Whether the value stands in a row.
    [[nodiscard]] bool isUsed(SampleId id) const { return used_.count(id) > 0; }

    void take(SampleId id, ChannelRow& row, std::size_t band, ChannelCount& count) {
        const ScatteredSample* const one = set_.find(id);
        used_.insert(id);
        ++count.partners;
        row.f[band] = one->f[Band::R];
        row.flags[band] = one->flags;
        if (one->uRandom || one->uSystematic) {
            row.u[band] = std::hypot(one->uRandom ? (*one->uRandom)[Band::R] : 0,
                                     one->uSystematic ? (*one->uSystematic)[Band::R] : 0);
        }
    }

    /// What the set has near the row's pair, estimated where it has nothing.
    void put(ChannelRow& row, std::size_t band, ChannelCount& count) {
        if (const std::optional<SampleId> id = partner(row.pair)) {
            take(*id, row, band, count);
            return;
        }
        const Answer answer = estimate_->answer(row.pair);
        if (!std::isfinite(answer.f[Band::R])) {
            ++count.missing;
            return;
        }
        ++count.estimated;
        row.f[band] = answer.f[Band::R];
        row.u[band] = answer.u(Band::R).value_or(kNan);
        row.flags[band] = answer.flags;
        row.flags[band].clear(Flag::Measured).set(Flag::Interpolated);
    }

private:
    const ScatteredSet& set_;
    std::unique_ptr<Scatterer> estimate_;
    std::set<SampleId> used_;
};

}  // namespace

MergedSample mergedChannels(const std::array<const SampleSet*, 3>& bands) {
    MergedSample merged;
    merged.set.leds = tablesOf(bands);
    for (LedTable& led : merged.set.leds) fillTable(led, merged.counts);
    return merged;
}

Result<MergedScattered> mergedChannels(const std::array<const ScatteredSet*, 3>& bands) {
    std::vector<Channel> channels;
    for (const ScatteredSet* const set : bands) {
        if (set->symmetry() != bands.front()->symmetry()) {
            return Error{ErrorKind::Usage,
                         "the bands have other symmetries: give all three as one kind of file"};
        }
        Result<Channel> channel = Channel::over(*set);
        if (!channel) return channel.error();
        channels.push_back(std::move(*channel));
    }
    MergedScattered merged;
    for (std::size_t b = 0; b < 3; ++b) {
        for (const SampleId id : bands[b]->ids()) {
            // Two values of one band may be near one of another: each has a row.
            if (channels[b].isUsed(id)) continue;
            const LightView& pair = bands[b]->find(id)->pair;
            ChannelRow row{.pair = pair, .f = {kNan, kNan, kNan}, .u = {kNan, kNan, kNan}};
            for (std::size_t i = 0; i < 3; ++i) {
                if (i == b) {
                    channels[i].take(id, row, i, merged.counts[i]);
                } else {
                    channels[i].put(row, i, merged.counts[i]);
                }
            }
            merged.rows.push_back(row);
        }
    }
    return merged;
}

}  // namespace gonio::proc
