#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/band_channels.h"
#include "proc/table/rotations.h"
#include "proc/table/rows_of.h"

namespace gonio::proc {
namespace {

/// To a billionth of a degree, so that 20 degrees that went through a vector are 20 again.
Radians rounded(Radians angle) {
    return Radians::fromDegrees(std::round(angle.degrees() * 1e9) / 1e9);
}

bool isNormal(const Direction& wi) { return std::hypot(wi.x(), wi.y()) <= kSameLightDistance; }

double distance(const Direction& a, const Direction& b) { return (a.vector() - b.vector()).norm(); }

/// Which channels make each band; a band without any is not measured.
struct BandSources {
    std::array<std::optional<ChannelBlend>, 3> bands;
    bool resampled = false;
};

Result<BandSources> sourcesOf(const std::vector<Channel>& channels) {
    const Result<BandChannels> all = bandChannels(channels);
    // Two bands of the three are no error here: the third was not measured.
    BandSources sources;
    bool named = !channels.empty();
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const auto band = std::find_if(kBands.begin(), kBands.end(), [&](Band b) {
            return channels[i].name == Channel::of(b).name;
        });
        named = named && band != kBands.end();
        if (band != kBands.end()) sources.bands[index(*band)] = ChannelBlend{i, i, 0};
    }
    if (named) return sources;
    if (!all) return all.error();
    for (const Band band : kBands) sources.bands[index(band)] = all->bands[index(band)];
    sources.resampled = all->resampled;
    return sources;
}

/// The value of a row in one band.
Measured<double> valueOf(const BrdfRows& rows, std::size_t pair, const ChannelBlend& blend) {
    const auto of = [&](const std::vector<double>& column, double unknown) {
        if (column.empty()) return unknown;
        return blend.of([&](std::size_t c) { return column[rows.index(pair, c)]; });
    };
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    Flags flags = rows.flagsAt(pair, blend.low);
    if (blend.t != 0) flags = flags | rows.flagsAt(pair, blend.high);
    Measured<double> value{.value = of(rows.f, kNan),
                           .uRandom = of(rows.uRandom, kNan),
                           .uSystematic = of(rows.uSystematic, rows.uRandom.empty() ? kNan : 0.0),
                           .flags = flags};
    if (blend.t != 0 && !rows.uRandom.empty()) {
        value.uRandom = std::hypot((1 - blend.t) * rows.uRandom[rows.index(pair, blend.low)],
                                   blend.t * rows.uRandom[rows.index(pair, blend.high)]);
    }
    return value;
}

class Gatherer {
public:
    Gatherer(const BrdfRows& rows, const BandSources& sources) : rows_(rows), sources_(sources) {}

    Result<SampleOfRows> gather(const Metadata& about) {
        if (!findLights()) {
            return Error{
                ErrorKind::Usage,
                "rows at more than " + std::to_string(kMostTables) +
                    " light directions: a sample has a table for each, which are too many"};
        }
        for (std::size_t pair = 0; pair < rows_.pairs.size(); ++pair) addRow(pair);
        finish();
        made_.bandsResampled = sources_.resampled;
        made_.set.info = infoOf(about);
        sortTables(made_.set);
        return std::move(made_);
    }

private:
    /// The number of the light in `lights_`; none: of the others there is none such.
    [[nodiscard]] std::optional<std::size_t> lightAt(const Direction& wi) {
        if (last_ < lights_.size() && distance(lights_[last_], wi) <= kSameLightDistance) {
            return last_;
        }
        const auto found = std::find_if(lights_.begin(), lights_.end(), [&](const Direction& one) {
            return distance(one, wi) <= kSameLightDistance;
        });
        if (found == lights_.end()) return std::nullopt;
        last_ = static_cast<std::size_t>(found - lights_.begin());
        return last_;
    }

    /// The light of a row in the frame of the table that it goes to.
    [[nodiscard]] Direction framed(const Direction& wi) const {
        if (!turnToZero_ || isNormal(wi)) return isNormal(wi) ? Direction() : wi;
        return Direction::fromSpherical(wi.theta(), Radians());
    }

    bool findLights() {
        // Isotropic rows keep the azimuth of their light as the rotation where it is but one.
        std::optional<Radians> only;
        for (const LightView& pair : rows_.pairs) {
            if (!pair.in.aboveHorizon() || isNormal(pair.in)) continue;
            const Radians rotation = rotationOf(-pair.in.phi().degrees());
            if (only && *only != rotation) turnToZero_ = rows_.isotropic;
            if (!only) only = rotation;
            if (turnToZero_) break;
        }
        for (const LightView& pair : rows_.pairs) {
            if (!pair.in.aboveHorizon()) continue;
            const Direction wi = framed(pair.in);
            if (lightAt(wi)) continue;
            if (lights_.size() >= kMostTables) return false;
            last_ = lights_.size();
            lights_.push_back(wi);
        }
        return makeTables();
    }

    /// A table for each light; for the normal one at each rotation that the others have.
    bool makeTables() {
        std::vector<Radians> rotations;
        for (const Direction& wi : lights_) {
            if (!isNormal(wi)) addRotation(rotations, rotationOf(-wi.phi().degrees()));
        }
        if (rotations.empty()) rotations.push_back(Radians());
        for (const Direction& wi : lights_) {
            tablesOf_.emplace_back();
            if (!isNormal(wi)) {
                addTable(rounded(wi.theta()), rotationOf(-wi.phi().degrees()));
                continue;
            }
            for (const Radians rotation : rotations) addTable(Radians(), rotation);
        }
        return made_.set.leds.size() <= kMostTables;
    }
    static void addRotation(std::vector<Radians>& all, Radians rotation) {
        const bool known = std::any_of(
            all.begin(), all.end(), [&](Radians one) { return sameRotation(one, rotation); });
        if (!known) all.push_back(rotation);
    }
    void addTable(Radians incidence, Radians rotation) {
        tablesOf_.back().push_back(made_.set.leds.size());
        LedTable led{.incidence = incidence, .rotation = rotation, .bands = {}};
        for (const Band band : kBands) {
            if (sources_.bands[index(band)]) {
                led.bands[index(band)] = CellSamples::missing(CellGrid::count());
            }
        }
        made_.set.leds.push_back(std::move(led));
    }

    void addRow(std::size_t pair) {
        const LightView& at = rows_.pairs[pair];
        std::array<Measured<double>, 3> values;
        std::size_t present = 0;
        for (const Band band : kBands) {
            const auto& source = sources_.bands[index(band)];
            if (!source) continue;
            values[index(band)] = valueOf(rows_, pair, *source);
            if (!std::isnan(values[index(band)].value)) ++present;
        }
        made_.values += present;
        const bool lit = at.in.aboveHorizon();
        const Direction wo = turnToZero_ && !isNormal(at.in) ? at.out.turned(-at.in.phi()) : at.out;
        if (!lit || !wo.aboveHorizon()) {
            made_.leftOut += present;
            return;
        }
        bool first = true;
        for (const std::size_t table : tablesOf_[*lightAt(framed(at.in))]) {
            LedTable& led = made_.set.leds[table];
            const bool turned = led.rotation != Radians();
            const Direction inRig = turned ? wo.turned(led.rotation) : wo;
            const auto cell = CellGrid::cellAt(inRig);
            if (!cell) {
                if (first) made_.leftOut += present;
                break;
            }
            for (const Band band : kBands) {
                if (sources_.bands[index(band)]) {
                    addValue(led.bands[index(band)], *cell, values[index(band)]);
                }
            }
            const bool off = distance(CellGrid::centre(*cell), inRig) > kSameLightDistance;
            if (first && off) made_.offCentre += present;
            first = false;
        }
    }

    /// nEff counts the values until all are in; u_random holds the sum of squares of several.
    void addValue(CellSamples& cells, std::size_t cell, const Measured<double>& value) {
        double& count = cells.nEff[cell];
        if (std::isnan(value.value)) {
            if (count == 0) cells.flags[cell] = cells.flags[cell] | value.flags;
            return;
        }
        if (count == 0) {
            cells.f[cell] = value.value;
            cells.uRandom[cell] = value.uRandom;
            cells.uSystematic[cell] = value.uSystematic;
            cells.flags[cell] = value.flags;
        } else {
            made_.averaged += count == 1 ? 2 : 1;
            cells.f[cell] += value.value;
            cells.uRandom[cell] = std::hypot(cells.uRandom[cell], value.uRandom);
            cells.uSystematic[cell] += value.uSystematic;
            cells.flags[cell] = cells.flags[cell] | value.flags;
        }
        ++count;
    }

    void finish() {
        for (LedTable& led : made_.set.leds) {
            for (CellSamples& cells : led.bands) {
                for (std::size_t cell = 0; cell < cells.size(); ++cell) {
                    const double count = cells.nEff[cell];
                    if (count <= 1) continue;
                    for (auto* column : {&cells.f, &cells.uRandom, &cells.uSystematic}) {
                        (*column)[cell] /= count;
                    }
                }
            }
        }
    }

    const BrdfRows& rows_;
    const BandSources& sources_;
    bool turnToZero_ = false;
    std::vector<Direction> lights_;
    std::vector<std::vector<std::size_t>> tablesOf_;  ///< of each light
    std::size_t last_ = 0;
    SampleOfRows made_;
};

}  // namespace

Result<SampleOfRows> sampleOf(const BrdfRows& rows, const Metadata& about) {
    const Result<BandSources> sources = sourcesOf(rows.channels);
    if (!sources) return sources.error();
    return Gatherer(rows, *sources).gather(about);
}

}  // namespace gonio::proc
