#include "proc/calibrate/reference.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"

namespace gonio::proc {
namespace {

constexpr Radians kSameIncidence = 0.6_deg;

/// Between which nodes a value lies: node, node + 1 (or the same at the ends) and the share of the
/// second.
struct Between {
    std::size_t low = 0;
    std::size_t high = 0;
    double share = 0;
};

Between locate(const std::vector<Radians>& nodes, Radians at) {
    const auto behind = std::upper_bound(nodes.begin(), nodes.end(), at);
    if (behind == nodes.begin()) return {0, 0, 0};
    const auto high = static_cast<std::size_t>(behind - nodes.begin());
    if (behind == nodes.end()) return {high - 1, high - 1, 0};
    const Radians width = nodes[high] - nodes[high - 1];
    return {high - 1, high, (at - nodes[high - 1]).value() / width.value()};
}

LedBands mixed(const LedBands& low, const LedBands& high, double share) {
    return low * (1 - share) + high * share;
}

LedBands lookUp(const ReferencePlane& plane, Radians theta, Radians phi) {
    const Between row = locate(plane.theta, theta);
    const Between column = locate(plane.phi, phi);
    const auto at = [&](std::size_t i) {
        const std::size_t first = i * plane.phi.size();
        return mixed(plane.f[first + column.low], plane.f[first + column.high], column.share);
    };
    return mixed(at(row.low), at(row.high), row.share);
}

bool ascending(const std::vector<Radians>& nodes) {
    return !nodes.empty() &&
           std::adjacent_find(nodes.begin(), nodes.end(), [](Radians a, Radians b) {
               return !(a < b);
           }) == nodes.end();
}

bool positive(const LedBands& f) {
    return std::all_of(
        f.value.begin(), f.value.end(), [](double v) { return std::isfinite(v) && v > 0; });
}

}  // namespace

Result<ReferenceTable> ReferenceTable::make(Certificate certificate,
                                            std::vector<ReferencePlane> planes) {
    const auto bad = [&](const std::string& what) {
        return Error{ErrorKind::File, "reference " + certificate.name + ": " + what};
    };
    if (planes.empty()) return bad("no values");
    std::sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) {
        return a.incidence < b.incidence;
    });
    for (const ReferencePlane& plane : planes) {
        const std::string where = "incidence " + fixed(plane.incidence.degrees(), 2) + ": ";
        if (!ascending(plane.theta) || !ascending(plane.phi) ||
            plane.f.size() != plane.theta.size() * plane.phi.size()) {
            return bad(where + "the directions are not a full ascending grid");
        }
        if (!std::all_of(plane.f.begin(), plane.f.end(), positive)) {
            return bad(where + "f must be above 0 everywhere");
        }
    }
    return ReferenceTable(std::move(certificate), std::move(planes));
}

ReferenceTable ReferenceTable::lambertian(const std::string& name,
                                          double reflectance,
                                          double relativeUncertainty) {
    ReferenceTable table(
        {.name = name,
         .citation = "f = " + shortest(reflectance) + " / pi in every direction, without a table",
         .licence = {},
         .uCommon = relativeUncertainty,
         .uPerDirection = 0},
        {{.incidence = 0_deg,
          .theta = {0_deg},
          .phi = {0_deg},
          .f = {LedBands::all(reflectance / kPi)}}});
    table.everywhere_ = true;
    return table;
}

ReferenceTable ReferenceTable::lightTrap(const std::string& name, double uAbsolute) {
    ReferenceTable table(
        {.name = name,
         .citation = "f = 0 in every direction, to " + shortest(uAbsolute) + " / sr",
         .licence = {},
         .uAbsolute = uAbsolute},
        {{.incidence = 0_deg, .theta = {0_deg}, .phi = {0_deg}, .f = {LedBands{}}}});
    table.everywhere_ = true;
    return table;
}

Answer ReferenceTable::answer(const LightView& pair) const {
    if (!pair.in.aboveHorizon() || !pair.out.aboveHorizon()) {
        return Answer::none({Flag::BelowHorizon}, Source::Measured);
    }
    const Radians incidence = pair.in.theta();
    const Radians theta = pair.out.theta();
    const double across = std::remainder((pair.out.phi() - pair.in.phi()).value(), 2 * kPi);
    const Radians phi(std::abs(across));

    // The planes on both sides, or the one that is near enough.
    const auto above = std::find_if(planes_.begin(), planes_.end(), [&](const auto& plane) {
        return plane.incidence + kSameIncidence >= incidence;
    });
    Answer answer;
    answer.flags = {Flag::Measured};
    answer.source = Source::Measured;
    if (everywhere_) {
        answer.f = lookUp(planes_.front(), theta, phi);
    } else if (above == planes_.end()) {
        return Answer::none({}, Source::Measured);
    } else if (above->incidence - kSameIncidence <= incidence) {
        answer.f = lookUp(*above, theta, phi);
    } else if (above == planes_.begin()) {
        return Answer::none({}, Source::Measured);
    } else {
        const ReferencePlane& below = *(above - 1);
        const double share =
            (incidence - below.incidence).value() / (above->incidence - below.incidence).value();
        answer.f = mixed(lookUp(below, theta, phi), lookUp(*above, theta, phi), share);
        answer.flags = {Flag::Interpolated};
        answer.source = Source::Interpolated;
    }
    answer.uRandom = answer.f * certificate_.uPerDirection;
    answer.uSystematic = LedBands{};
    for (Band b : kBands) {
        (*answer.uSystematic)[b] =
            std::hypot(answer.f[b] * certificate_.uCommon, certificate_.uAbsolute);
    }
    return answer;
}

}  // namespace gonio::proc
