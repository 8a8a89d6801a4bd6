#include "proc/formats/rt300s_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "proc/core/number_text.h"
#include "proc/core/units.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Angles closer than half a step of the finest scan are within the arm.
constexpr double kArmDeg = 2.5;

/// Angles in millionths of a degree: equal where files say so.
using Angles = std::array<long long, 3>;
Angles anglesOf(const Rt300sReading& r) {
    const auto whole = [](double degrees) { return std::llround(degrees * 1e6); };
    return {whole(r.azimuthDeg), whole(r.incidenceDeg), whole(r.receiveDeg)};
}

/// From the light, in [0, 360); 0 at the normal.
double viewAzimuth(const Rt300sReading& r) {
    if (r.receiveDeg == 0) return 0;
    const double azimuth = r.azimuthDeg + (r.receiveDeg > 0 ? 270 : 90);
    const double turned = azimuth - 360 * std::floor(azimuth / 360);
    return turned >= 360 ? 0 : turned;
}

bool inShadow(const Rt300sReading& r) {
    const double azimuth = viewAzimuth(r);
    const bool plane = std::min(azimuth, 360 - azimuth) < kArmDeg;
    const bool near = std::abs(std::abs(r.receiveDeg) - r.incidenceDeg) < kArmDeg;
    return r.receiveDeg != 0 && plane && near;
}

/// A node's number on the axes of its incidence.
struct Node {
    double azimuth = 0, theta = 0;
    auto operator<=>(const Node&) const = default;
};
Node nodeOf(const Rt300sReading& r, bool folded) {
    double azimuth = viewAzimuth(r);
    if (folded && azimuth > 180) azimuth = 360 - azimuth;
    return {azimuth, std::abs(r.receiveDeg)};
}

struct Mean {
    double sum = 0;
    std::size_t count = 0;
    void add(double value) {
        sum += value;
        ++count;
    }
    [[nodiscard]] double value() const {
        return count == 0 ? kNan : sum / static_cast<double>(count);
    }
};
using Nodes = std::map<Node, Mean>;

/// The mean is of the pole where any azimuth has it.
SphericalBlock blockOf(double incidence, const Nodes& nodes) {
    std::set<double> azimuths, thetas;
    for (const auto& [node, mean] : nodes) {
        if (node.theta > 0) azimuths.insert(node.azimuth);
        thetas.insert(node.theta);
    }
    if (azimuths.empty()) azimuths.insert(0);
    SphericalBlock block{.incidenceDeg = incidence};
    block.azimuthDeg.assign(azimuths.begin(), azimuths.end());
    block.thetaDeg.assign(thetas.begin(), thetas.end());
    for (const double azimuth : block.azimuthDeg) {
        for (const double theta : block.thetaDeg) {
            const auto found = nodes.find({theta == 0 ? 0 : azimuth, theta});
            block.f.push_back(found == nodes.end() ? kNan : found->second.value());
        }
    }
    return block;
}

double deviationOf(const Rt300sScan& scan) {
    Mean mean, squares;
    for (const Rt300sReading& r : scan.readings) mean.add(r.value);
    for (const Rt300sReading& r : scan.readings) {
        squares.add((r.value - mean.value()) * (r.value - mean.value()));
    }
    return std::sqrt(squares.value());
}

/// What is left of samples in the shadow, by incidence.
using ShadowMeans = std::map<double, Mean>;

}  // namespace

Result<Rt300sBrdf> rt300sBrdf(std::span<const Rt300sScan> samples,
                              const Rt300sScan& black,
                              const Rt300sOptions& options) {
    std::map<Angles, double> dark;
    for (const Rt300sReading& r : black.readings) dark.emplace(anglesOf(r), r.value);
    Rt300sBrdf made;
    made.blackDeviation = deviationOf(black);
    std::map<double, Nodes> incidences;
    Mean shadow;
    for (const Rt300sScan& sample : samples) {
        ShadowMeans left;
        for (const Rt300sReading& r : sample.readings) {
            const auto found = dark.find(anglesOf(r));
            if (found == dark.end() || !inShadow(r)) continue;
            left[r.incidenceDeg].add(r.value - found->second);
            shadow.add(r.value - found->second);
        }
        for (const Rt300sReading& r : sample.readings) {
            const auto found = dark.find(anglesOf(r));
            if (found == dark.end()) {
                ++made.unmatched;
                continue;
            }
            if (inShadow(r)) {
                ++made.shadowed;
                continue;
            }
            double net = r.value - found->second;
            const auto rest = left.find(r.incidenceDeg);
            if (options.zeroAtShadow && rest != left.end()) net -= rest->second.value();
            const double cosine = cos(Radians::fromDegrees(r.receiveDeg));
            incidences[r.incidenceDeg][nodeOf(r, options.planeSymmetrical)].add(net /
                                                                                (kPi * cosine));
        }
    }
    made.shadowNet = shadow.value();
    if (incidences.empty()) {
        return Error{ErrorKind::File,
                     "rt300s: no reading of the sample has one of black at the same angles"};
    }
    made.table.channels = {Channel{}};
    made.table.planeSymmetrical = options.planeSymmetrical;
    for (const auto& [incidence, nodes] : incidences) {
        made.table.blocks.push_back(blockOf(incidence, nodes));
        for (const auto& [node, mean] : nodes) made.negative += mean.value() < 0 ? 1U : 0U;
    }
    return made;
}

std::vector<std::string> warningsOf(const Rt300sBrdf& made) {
    std::vector<std::string> warnings;
    const auto warn = [&](std::size_t count, const std::string& what) {
        if (count > 0) warnings.push_back(std::to_string(count) + what);
    };
    warn(made.unmatched, " readings without one of black at their angles, left out");
    warn(made.shadowed, " readings in the shadow of the light's arm, masked");
    warn(made.negative, " negative values");
    // Three standard deviations of black, which itself differs by as much over the angles.
    if (std::abs(made.shadowNet) > 3 * made.blackDeviation) {
        warnings.push_back("in the arm's shadow " + shortest(made.shadowNet) +
                           " is left, more than 3 standard deviations of black (" +
                           shortest(made.blackDeviation) +
                           "): black is of another state of the instrument");
    }
    return warnings;
}

SphericalTable tableOfJdv(std::span<const JdvBlock> blocks) {
    SphericalTable table;
    std::map<double, std::size_t> times;
    for (const JdvBlock& one : blocks) {
        if (one.scan.readings.empty()) continue;
        const double incidence = one.scan.readings.front().incidenceDeg;
        Nodes nodes;
        for (const Rt300sReading& r : one.scan.readings) {
            if (!inShadow(r)) nodes[nodeOf(r, false)].add(r.value);
        }
        SphericalBlock block = blockOf(incidence, nodes);
        block.channel = times[incidence]++;
        table.blocks.push_back(std::move(block));
    }
    std::size_t channels = 1;
    for (const auto& [incidence, count] : times) channels = std::max(channels, count);
    for (std::size_t i = 0; i < channels; ++i) {
        table.channels.push_back(
            {channels == 1 ? "" : "run " + std::to_string(i + 1), std::nullopt});
    }
    return table;
}

Result<FileRead<SphericalTable>> parseRt300sTable(std::string_view text, std::string_view name) {
    if (!isJdv(text)) {
        const auto readings = parseRt300sCsv(text, name);
        if (!readings) return readings.error();
        return Error{ErrorKind::Usage,
                     "rt300s: " + std::string(name) +
                         ": raw readings are no BRDF without those of the empty stage: --black "
                         "BLANK.csv"};
    }
    auto read = parseJdv(text, name);
    if (!read) return read.error();
    FileRead<SphericalTable> table{.content = tableOfJdv(read->content),
                                   .about = std::move(read->about),
                                   .warnings = std::move(read->warnings)};
    if (!read->content.empty()) {
        table.about.set(key::kSample, read->content.front().sampleId);
        table.about.set(key::kDate, read->content.front().date);
    }
    return table;
}

}  // namespace gonio::proc
