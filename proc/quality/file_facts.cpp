#include "proc/quality/file_facts.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/open.h"
#include "proc/quality/file_counts.h"
#include "proc/quality/file_totals.h"

namespace gonio::proc {
namespace {

std::string symmetryOf(const BrdfFile& file) {
    if (const auto* sample = file.as<SampleSet>()) {
        const auto turned =
            std::any_of(sample->leds.begin(), sample->leds.end(), [&](const LedTable& led) {
                return led.rotation != sample->leds.front().rotation;
            });
        return turned ? "several rotations" : "one rotation";
    }
    if (const auto* table = file.as<SpecularTable>()) {
        if (table->symmetry == TableSymmetry::PlaneSymmetrical) return "plane-symmetrical";
        return table->rotationDeg.size() > 1 ? "several rotations" : "isotropic";
    }
    if (const auto* table = file.as<SphericalTable>()) {
        if (!table->isotropic()) return "several light azimuths";
        return table->planeSymmetrical ? "plane-symmetrical" : "isotropic";
    }
    if (const auto* table = file.as<TensorTable>()) {
        return table->isotropic() ? "isotropic" : "several light azimuths";
    }
    if (const auto* rows = file.as<BrdfRows>()) {
        return rows->isotropic ? "isotropic" : "several light azimuths";
    }
    return "isotropic";
}

std::optional<ReciprocityFacts> reciprocityOf(const Scatterer& surface,
                                              const std::vector<double>& incidencesDeg) {
    std::vector<double> asymmetries;
    for (std::size_t i = 0; i < incidencesDeg.size(); ++i) {
        for (std::size_t j = i + 1; j < incidencesDeg.size(); ++j) {
            for (int phi = 0; phi < 360; phi += 10) {
                const Direction a =
                    Direction::fromSpherical(Radians::fromDegrees(incidencesDeg[i]), Radians());
                const Direction b = Direction::fromSpherical(Radians::fromDegrees(incidencesDeg[j]),
                                                             Radians::fromDegrees(phi));
                const Answer there = surface.answer({.in = a, .out = b});
                const Answer back = surface.answer({.in = b, .out = a});
                const double f = there.f[Band::G];
                const double g = back.f[Band::G];
                const double mean = (std::abs(f) + std::abs(g)) / 2;
                if (mean > 0) asymmetries.push_back(std::abs(f - g) / mean);
            }
        }
    }
    if (asymmetries.empty()) return std::nullopt;
    std::sort(asymmetries.begin(), asymmetries.end());
    const auto quantile = [&](double share) {
        const double last = static_cast<double>(asymmetries.size() - 1);
        return asymmetries[static_cast<std::size_t>(share * last + 0.5)];
    };
    return ReciprocityFacts{asymmetries.size(), quantile(0.5), quantile(0.95)};
}

std::string place(const TotalFacts& total) {
    return "incidence " + shortest(total.incidenceDeg) +
           (total.channel.empty() ? "" : ", " + total.channel) +
           (total.transmission ? ", transmission" : "");
}

void warnOfTotals(FileFacts& facts) {
    std::size_t off = 0;
    double least = 1e300;
    double largest = 0;
    for (const TotalFacts& total : facts.totals) {
        if (total.recomputed > 1 + 1e-3) {
            facts.warnings.push_back("sends back " + perCent(total.recomputed) +
                                     " of the light at " + place(total));
        }
        if (!total.stated || !(total.recomputed > 0)) continue;
        const double ratio = *total.stated / total.recomputed;
        if (std::abs(ratio - 1) <= kTotalTolerance) continue;
        ++off;
        least = std::min(least, ratio);
        largest = std::max(largest, ratio);
    }
    if (off > 0) {
        facts.warnings.push_back("stated totals are " + fixed(least, 2) + " to " +
                                 fixed(largest, 2) + " of those of its values, at " +
                                 std::to_string(off) + " of " +
                                 std::to_string(facts.totals.size()) + " light directions");
    }
}

void warnOfValues(FileFacts& facts) {
    for (const ChannelFacts& channel : facts.channels) {
        if (channel.measured == 0) {
            facts.warnings.push_back("no values in channel " +
                                     (channel.channel.name.empty() ? "1" : channel.channel.name));
        }
        if (channel.negative * 100 > channel.measured) {
            facts.warnings.push_back(
                perCent(static_cast<double>(channel.negative) /
                        static_cast<double>(channel.measured)) +
                " of the values are negative" +
                (channel.channel.name.empty() ? "" : " in " + channel.channel.name));
        }
    }
    if (facts.reciprocity && facts.reciprocity->median > kReciprocityTolerance) {
        facts.warnings.push_back("not reciprocal: exchanged pairs differ by " +
                                 perCent(facts.reciprocity->median) + " (median)");
    }
}

}  // namespace

FileFacts fileFacts(const BrdfFile& file) {
    FileFacts facts;
    facts.symmetry = symmetryOf(file);
    for (const Radians incidence : incidencesOf(file)) {
        facts.incidencesDeg.push_back(fileDegrees(incidence));
    }
    const FileCounts counts = countsOf(file);
    facts.channels = counts.channels;
    facts.lights = counts.lights;
    facts.reflection = counts.reflection;
    facts.transmission = counts.transmission;
    facts.thetaOutDeg = counts.thetaOutDeg;
    facts.totals = totalsOf(file);
    facts.warnings = file.warnings;
    constexpr std::size_t kFew = 12;
    if (auto surface = lookupOver(file)) {
        std::vector<double> asked = facts.incidencesDeg;
        if (asked.empty()) asked = {0, 20, 40, 60};
        if (asked.size() <= kFew) facts.reciprocity = reciprocityOf(**surface, asked);
    }
    warnOfTotals(facts);
    warnOfValues(facts);
    return facts;
}

}  // namespace gonio::proc
