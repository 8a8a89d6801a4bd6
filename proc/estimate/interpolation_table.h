#pragma once
// Every estimator on every study material, in one run: the table that says what interpolation and
// extrapolation are worth, and what each method costs.

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "proc/core/stopwatch.h"
#include "proc/estimate/interpolation_study.h"

namespace gonio::proc {

/// Where an estimator is asked; the data are 0, 20, 40 and 60 degrees, theta_o to 75.
struct StudyRegion {
    std::string name;
    Asked asked;
};
/// 10/30/50; 70; 80; theta_o 75 to 80, 80 to 85 and 85 to 89 at 20 and 40.
[[nodiscard]] const std::vector<StudyRegion>& studyRegions();

struct InterpolationRow {
    std::string method;
    std::string material;
    bool inFamily = false;
    bool inLibrary = false;
    std::string chosen;               ///< what `auto` took between and beyond; empty for the others
    std::vector<RegionError> errors;  ///< by region
    double makeSeconds = 0;           ///< from the sample to the first answer
    /// Wall, per answer of the first region alone, on all cores; NaN where the method was refused.
    double microseconds = std::numeric_limits<double>::quiet_NaN();
};

struct InterpolationOptions {
    double relativeNoise = 0;
    bool quick = false;                  ///< four materials, every 37th cell instead of every 7th
    std::vector<std::string> methods{};  ///< empty: all
};

/// "same-direction", "shepard", "axis-linear", "grid-linear", methodNames() without carriers,
/// "carried:lambert+ggx", "prior" and "auto".
[[nodiscard]] std::vector<std::string> studyMethods();

/// `progress` is told the material and the method before each; the times are of `clock`.
[[nodiscard]] std::vector<InterpolationRow> interpolationTable(
    const InterpolationOptions& options,
    const Clock& clock,
    const std::function<void(const std::string&)>& progress);

/// f in the plane of incidence, band R.
struct LobeCurve {
    std::string name;
    std::vector<double> thetaDeg;  ///< signed, positive on the mirror's side
    std::vector<double> f;         ///< 1/sr; NaN where there is no answer
};
/// "truth", and what the methods make of the material between the incidences that were measured.
[[nodiscard]] std::vector<LobeCurve> lobeCurves(const StudyMaterial& material,
                                                Radians incidence,
                                                const std::vector<std::string>& methods);

/// Of a method over the materials in the family or outside: the median and the worst of a region.
struct InterpolationSummary {
    double median = std::numeric_limits<double>::quiet_NaN();
    double worst = std::numeric_limits<double>::quiet_NaN();
    std::size_t answered = 0;   ///< materials that the two are of: some methods refuse some
    std::size_t materials = 0;  ///< in all
};
enum class RegionPart {
    Hemisphere,
    Lobe
};
/// NaN where no row answers.
[[nodiscard]] InterpolationSummary summaryOf(const std::vector<InterpolationRow>& rows,
                                             const std::string& method,
                                             bool inFamily,
                                             std::size_t region,
                                             RegionPart part);

}  // namespace gonio::proc
