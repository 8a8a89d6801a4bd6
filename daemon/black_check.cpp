#include "daemon/black_check.h"

#include <cmath>
#include <cstdio>

#include "proc/core/log.h"
#include "proc/core/median.h"

namespace gonio::daemon {
namespace {

constexpr double kCoverage = 2;  // k

std::string perSteradian(double f) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", f);
    return std::string(text) + " / sr";
}

}  // namespace

bool BlackCheck::agrees() const { return std::abs(measured - certified) <= kCoverage * u; }

std::string BlackCheck::described() const {
    return "black shows f = " + perSteradian(measured) + ", its certificate says " +
           perSteradian(certified) + ", u of the difference " + perSteradian(u);
}

std::optional<BlackCheck> checkBlack(const RigReferences& references,
                                     const std::vector<Radians>& ledAngles) {
    if (references.zero == nullptr) return std::nullopt;
    const proc::ReferenceTable& black = *references.certified.black;
    std::vector<double> measured, certified;
    const std::vector<DirectionSpread> exact(proc::CellGrid::count());
    for (std::size_t led = 0; led < references.black.signals.size(); ++led) {
        const Direction wi = Direction::fromSpherical(ledAngles[led], Radians(0));
        // One band is enough: a dirty tile or trap is so in all.
        constexpr Band band = Band::G;
        const proc::Calibrated seen =
            proc::calibrate(references.black.signals[led][index(band)],
                            referencesOf(references, {static_cast<int>(led), band}),
                            wi,
                            band,
                            {.angle = exact});
        for (std::size_t cell = 0; cell < seen.samples.size(); ++cell) {
            if (!seen.samples.present(cell)) continue;
            measured.push_back(seen.samples.f[cell]);
            const LightView pair{.in = wi, .out = proc::CellGrid::centre(cell)};
            certified.push_back(black.answer(pair).f[band]);
        }
    }
    if (measured.empty()) return std::nullopt;
    BlackCheck check{.measured = median(std::move(measured)),
                     .certified = median(std::move(certified))};
    check.u = std::hypot(check.certified * black.certificate().uCommon,
                         references.certified.zero->certificate().uAbsolute);
    return check;
}

void noteBlackCheck(const std::optional<BlackCheck>& check, proc::SampleInfo& info) {
    constexpr const char* kKey = "black_check";
    info.extra.erase(kKey);
    if (!check) return;
    info.extra[kKey] = check->described();
    if (check->agrees()) return;
    info.extra[kKey] += ": they do not agree";
    log::warning(check->described() +
                 ": the black or the zero reference is not what it was; clean both, and run: gonio "
                 "calibrate black, zero");
}

}  // namespace gonio::daemon
