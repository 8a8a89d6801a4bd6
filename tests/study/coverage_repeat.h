#pragma once
// One repeat of the coverage study: a laboratory of its own calibrates its lens, takes its white
// and its black, and measures each material once, on a tilt. What comes out is compared with the
// truth, cell by cell.

#include <memory>
#include <vector>

#include "tests/study/coverage_rows.h"
#include "tests/study/study_rig.h"

namespace gonio::study {

struct Material {
    std::string name;
    std::string spec;     ///< as on the command line
    bool glossy = false;  ///< its bracket needs the short exposures and the dim LEDs
};

/// f from 1e-4 to 1e3 1/sr.
[[nodiscard]] const std::vector<Material>& materials();

/// From the normal to the rim, where the mirror directions are: 16 windows under each of two LEDs.
inline constexpr sim::View kStrip{.x = 144, .y = 496, .size = {512, 32}};

class CoverageStudy {
public:
    explicit CoverageStudy(const sim::View& strip);
    /// Repeats first .. first + count - 1, on all cores; the result does not depend on how many.
    [[nodiscard]] CoverageRows run(std::uint64_t first, std::uint64_t count) const;
    [[nodiscard]] std::vector<Verdict> repeat(std::uint64_t seed) const;

private:
    struct Truth {
        double f = 0;  ///< mean over the cell; NaN: there is none
        double slopePerDegree = 0;
    };
    using Truths = std::vector<Truth>;  // by cell

    [[nodiscard]] Truths truthOf(const Scatterer& surface, int led) const;

    StudyRig rig_;
    std::shared_ptr<const proc::ReferenceTable> white_, black_;
    std::vector<std::shared_ptr<const Scatterer>> surfaces_;  // by material
    std::vector<std::vector<Truths>> truths_;                 // by material and LED
};

}  // namespace gonio::study
