#include "proc/table/rows_of.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// cos(90 deg) is 6e-17 in double; a node this close to the horizon is on it.
constexpr double kHorizon = 1e-12;

std::vector<Band> bandsOf(const SampleSet& set) {
    std::vector<Band> bands;
    for (const Band band : kBands) {
        const bool any = std::any_of(set.leds.begin(), set.leds.end(), [&](const LedTable& led) {
            return led.bands[index(band)].size() > 0;
        });
        if (any) bands.push_back(band);
    }
    return bands;
}

void addCell(BrdfRows& rows, const CellSamples& cells, std::size_t cell) {
    const Measured<double> at = cell < cells.size() ? cells.at(cell) : Measured<double>::missing();
    rows.f.push_back(at.value);
    rows.uRandom.push_back(at.uRandom);
    rows.uSystematic.push_back(at.uSystematic);
    rows.flags.push_back(at.flags);
}

void addNode(BrdfRows& rows, const SpecularTable& table, TableNode node) {
    bool any = false;
    for (std::size_t plane = 0; plane < table.planes.size(); ++plane) {
        any = any || table.hasData(plane, node);
    }
    if (!any || table.repeatsDirection(node)) return;
    rows.pairs.push_back(table.pairAt(node));
    for (std::size_t plane = 0; plane < table.planes.size(); ++plane) {
        const bool has = table.hasData(plane, node);
        rows.f.push_back(has ? table.planes[plane].f[table.index(node)] : kNan);
    }
}

/// The blocks of one light, side and pair of axes: theirs are the same rows.
struct SameRows {
    bool operator()(const SphericalBlock* a, const SphericalBlock* b) const {
        const auto of = [](const SphericalBlock& block) {
            return std::tie(block.lightAzimuthDeg,
                            block.incidenceDeg,
                            block.transmission,
                            block.azimuthDeg,
                            block.thetaDeg);
        };
        return of(*a) < of(*b);
    }
};

using Group = std::vector<const SphericalBlock*>;

/// Blocks of the same rows and of different channels, wherever files have them: one has its
/// channels outermost, another innermost. A channel that comes again begins another group.
std::vector<Group> groupsOf(const std::vector<SphericalBlock>& blocks) {
    struct Places {
        std::map<std::size_t, std::size_t> times;  ///< that a channel was there
        std::vector<std::size_t> groups;
    };
    std::map<const SphericalBlock*, Places, SameRows> known;
    std::vector<Group> groups;
    for (const SphericalBlock& block : blocks) {
        Places& places = known[&block];
        const std::size_t time = places.times[block.channel]++;
        if (time == places.groups.size()) {
            places.groups.push_back(groups.size());
            groups.emplace_back();
        }
        groups[places.groups[time]].push_back(&block);
    }
    return groups;
}

/// The pole at another azimuth than the first, or the first azimuth after a full turn.
bool repeatsDirection(const SphericalBlock& block, std::size_t azimuth, std::size_t theta) {
    const bool pole = block.thetaDeg[theta] == 0 || block.thetaDeg[theta] == 180;
    return (pole && azimuth > 0) || block.azimuthDeg[azimuth] - block.azimuthDeg.front() >= 360;
}

void addGroup(BrdfRows& rows, const SphericalTable& table, const Group& group) {
    const SphericalBlock& shared = *group.front();
    for (std::size_t a = 0; a < shared.azimuthDeg.size(); ++a) {
        for (std::size_t t = 0; t < shared.thetaDeg.size(); ++t) {
            std::vector<double> f(table.channels.size(), kNan);
            bool any = false;
            for (const SphericalBlock* block : group) {
                const double value = block->f[shared.index(a, t)];
                f[block->channel] = value;
                any = any || !std::isnan(value);
            }
            if (!any || repeatsDirection(shared, a, t)) continue;
            const LightView pair = table.pairAt(shared, a, t);
            if (std::abs(pair.out.z()) <= kHorizon) continue;
            rows.pairs.push_back(pair);
            rows.f.insert(rows.f.end(), f.begin(), f.end());
        }
    }
}

}  // namespace

BrdfRows rowsOf(const SampleSet& set) {
    const std::vector<Band> bands = bandsOf(set);
    BrdfRows rows;
    rows.isotropic = rotationsOf(set).size() <= 1;
    for (const Band band : bands) rows.channels.push_back(Channel::of(band));
    const std::size_t pairs = set.leds.size() * CellGrid::count();
    rows.pairs.reserve(pairs);
    for (auto* column : {&rows.f, &rows.uRandom, &rows.uSystematic}) {
        column->reserve(pairs * bands.size());
    }
    rows.flags.reserve(pairs * bands.size());
    for (const LedTable& led : set.leds) {
        for (std::size_t cell = 0; cell < CellGrid::count(); ++cell) {
            rows.pairs.push_back(pairInSample(led, CellGrid::centre(cell)));
            for (const Band band : bands) addCell(rows, led.bands[index(band)], cell);
        }
    }
    const auto unknown = [](double u) { return std::isnan(u); };
    for (auto* column : {&rows.uRandom, &rows.uSystematic}) {
        if (std::all_of(column->begin(), column->end(), unknown)) column->clear();
    }
    return rows;
}

BrdfRows rowsOf(const SpecularTable& table, const Channel& channel) {
    BrdfRows rows;
    rows.isotropic = table.rotationDeg.size() <= 1;
    if (table.colour == TableColour::Xyz) {
        rows.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}};
    } else {
        rows.channels = {channel};
    }
    for (TableNode n; n.rotation < table.rotationDeg.size(); ++n.rotation) {
        for (n.incidence = 0; n.incidence < table.incidenceDeg.size(); ++n.incidence) {
            for (n.azimuth = 0; n.azimuth < table.azimuthDeg.size(); ++n.azimuth) {
                for (n.radial = 0; n.radial < table.radialDeg.size(); ++n.radial) {
                    addNode(rows, table, n);
                }
            }
        }
    }
    return rows;
}

BrdfRows rowsOf(const SphericalTable& table) {
    BrdfRows rows;
    rows.channels = table.channels;
    rows.isotropic = table.isotropic();
    for (const Group& group : groupsOf(table.blocks)) addGroup(rows, table, group);
    return rows;
}

}  // namespace gonio::proc
