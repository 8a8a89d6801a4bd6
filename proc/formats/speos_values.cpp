#include "proc/formats/speos_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proc/core/number_text.h"
#include "proc/core/units.h"
#include "proc/formats/spherical_warnings.h"
#include "proc/table/block_integral.h"
#include "proc/table/peak_quarter.h"

namespace gonio::proc {
namespace {

constexpr double kSmallestCosine = 1e-9;

bool halfCircles(const SphericalTable& table) {
    return std::all_of(table.blocks.begin(), table.blocks.end(), [](const SphericalBlock& block) {
        return block.azimuthDeg.size() > 1 && block.azimuthDeg.front() == 0 &&
               block.azimuthDeg.back() == 180;
    });
}

void settleMirror(FileRead<SphericalTable>& read, SpeosOrigin origin) {
    SphericalTable& table = read.content;
    table.mirrorAzimuthDeg =
        origin == SpeosOrigin::Binary ? kSpeosBinaryMirrorDeg : kSpeosTextMirrorDeg;
    if (origin == SpeosOrigin::OwnText) return;
    const auto quarters = peakQuarters(table);
    if (quarters[2] <= quarters[0]) return;
    table.mirrorAzimuthDeg = 180 - table.mirrorAzimuthDeg;
    read.warnings.push_back("the mirror direction is taken at phi " +
                            shortest(table.mirrorAzimuthDeg) + ", where the peaks of " +
                            std::to_string(quarters[2]) + " of " +
                            std::to_string(table.blocks.size()) + " tables lie");
}

void compareTotals(FileRead<SphericalTable>& read) {
    std::size_t differing = 0;
    double worst = 1;
    for (const SphericalBlock& block : read.content.blocks) {
        const double own = blockIntegral(read.content, block);
        if (!(own > 0) || !(block.tis > 0)) continue;
        const double ratio = block.tis / own;
        if (std::abs(ratio - 1) > kSpeosTotalDiffers) ++differing;
        if (std::abs(std::log(ratio)) > std::abs(std::log(worst))) worst = ratio;
    }
    if (differing == 0) return;
    read.warnings.push_back("totals of " + std::to_string(differing) +
                            " tables differ from their own integral, at most " + fixed(worst, 3) +
                            " of it: Speos would scale them, here they stand");
}

}  // namespace

double lightAzimuthOf(double anisotropyDeg) {
    const double azimuth = -anisotropyDeg - 360 * std::floor(-anisotropyDeg / 360);
    return azimuth >= 360 ? 0 : azimuth;  // of a tiny angle by rounding
}

void divideByCosine(SphericalBlock& block) {
    for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
        const double cosine = std::abs(cos(Radians::fromDegrees(block.thetaDeg[t])));
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            double& f = block.f[block.index(a, t)];
            f = cosine > kSmallestCosine ? f / cosine : std::numeric_limits<double>::quiet_NaN();
        }
    }
}

void settle(FileRead<SphericalTable>& read, SpeosOrigin origin) {
    if (halfCircles(read.content)) {
        read.content.planeSymmetrical = true;
        read.warnings.emplace_back("azimuths end at 180: the other side is taken for its mirror");
    }
    settleMirror(read, origin);
    for (std::string& warning : sphericalWarnings(read.content)) {
        read.warnings.push_back(std::move(warning));
    }
    compareTotals(read);
}

}  // namespace gonio::proc
