#pragma once
// One surface as a file of another format: copied where both hold the same kind of table, listed or
// asked anew where they do not, with a report of all that is lost on the way.
//
// A table that is asked anew is read back and held against the source at the source's own cells:
// that is the resampling error of the report.

#include <memory>
#include <string>
#include <vector>

#include "proc/core/bands.h"
#include "proc/core/result.h"
#include "proc/core/scatterer.h"
#include "proc/export/target_grid.h"
#include "proc/formats/brdf_file.h"
#include "proc/formats/loss_report.h"

namespace gonio::proc {

/// What is converted.
struct ConversionSource {
    /// Answers between the values; null where nothing does.
    std::shared_ptr<const Scatterer> scatterer{};
    std::shared_ptr<const BrdfFile> file{};  ///< null of a formula
    std::vector<Band> bands{};               ///< that it has; empty: one value, of no known band
    std::vector<double> incidenceDeg{};      ///< at which a table is asked, unless the grid says
    std::vector<double> rotationDeg{0};
    Metadata about{};
    bool estimated = false;     ///< the scatterer is an estimator: nodes are answered, not copied
    std::string noScatterer{};  ///< why nothing answers, and what to do
    std::string noBands{};      ///< why the values are none of the bands
    std::size_t lightAzimuths = 1;  ///< of the file; of more than rotationDeg some are left out

    [[nodiscard]] bool monochrome() const { return bands.size() < 2; }
};

struct ConversionWish {
    Format to = Format::Gonio;
    TargetGrid grid{};
    bool half = false;  ///< 16-bit floats, where the format has them
    /// Speos: tables of anisotropy angles, as an .anisotropicbsdf holds them; else as a .brdf.
    bool anisotropic = false;
};

struct ConvertedFile {
    std::string suffix;  ///< of the file's stem: "_G" for one of several, else empty
    std::string bytes;
    LossReport loss;
};

/// One file, or several where a format holds one band or one light direction. Usage error where the
/// source is not enough for the format: it names the option that resolves it.
[[nodiscard]] Result<std::vector<ConvertedFile>> convertTo(const ConversionSource& source,
                                                           const ConversionWish& wish);

/// "_R", "_G", "_B".
[[nodiscard]] std::string bandSuffix(Band band);

}  // namespace gonio::proc
