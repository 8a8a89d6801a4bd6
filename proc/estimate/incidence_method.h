#pragma once
// A way to answer at any incidence from sheets measured at a few: everything that this library
// interpolates with, measured baselines and its own, comes as one of these.
//
// A method answers for every pair above the horizon. Within the incidences that were measured it
// interpolates, beyond the first and the last it stays at that sheet; how far an answer is from
// what was measured is the caller's to judge (coverage.h). The sample is isotropic.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "proc/core/bands.h"
#include "proc/core/direction.h"
#include "proc/estimate/incidence_frame.h"
#include "proc/estimate/sheet.h"
#include "proc/fit/brdf_data.h"
#include "proc/fit/family.h"

namespace gonio::proc {

/// f and its uncertainties in 1/sr; NaN in a band that was not measured. The method's own error is
/// not in them, except where `ownError` is true.
struct MethodAnswer {
    LedBands f;
    LedBands uRandom;
    LedBands uSystematic;
};

class IncidenceMethod {
public:
    virtual ~IncidenceMethod() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    /// The pair above the horizon, its light at phi = 0.
    [[nodiscard]] virtual MethodAnswer at(const LightView& pair) const = 0;
    /// Made of sheets: at an incidence that was measured it answers what was measured there. Else f
    /// comes from a function of all data, which is reciprocal.
    [[nodiscard]] virtual bool anchored() const { return true; }
    /// The random uncertainty holds the method's own error (of a posterior).
    [[nodiscard]] virtual bool ownError() const { return false; }
};

/// What is interpolated.
enum class SheetQuantity {
    F,            ///< f
    LogF,         ///< ln f, as asinh(f / (2 e)), e = 1e-5 / sr: noise about zero has a value
    LogFCosines,  ///< likewise of f cos(theta_i) cos(theta_o): the microfacet's cross-section is
                  ///< out
    RatioToModel  ///< (f + c) / (model + c), c = 1e-6 / sr, of a fitted model, which carries it
};

/// Along the incidence.
enum class IncidenceCurve {
    Linear,
    CatmullRom  ///< cubic through four incidences, by unequal steps; one-sided at the ends
};

/// A fitted model that carries an interpolation.
struct Carrier {
    const Family* family = nullptr;
    FamilyPoint point;
    /// By band, of the shared parameters and then the band's own; 0 where one is held.
    std::array<Eigen::MatrixXd, 3> covariance;
    std::array<double, 3> commonRelative{};  ///< systematic uncertainty of the data, by band

    [[nodiscard]] LedBands at(const LightView& pair) const;
    /// Standard uncertainty of at() by that covariance.
    [[nodiscard]] LedBands uAt(const LightView& pair) const;
};

struct SheetMethodOptions {
    std::string name;
    IncidenceFrame frame = IncidenceFrame::SpecularRelative;
    SheetQuantity quantity = SheetQuantity::F;
    IncidenceCurve curve = IncidenceCurve::Linear;
    Carrier carrier{};  ///< of RatioToModel
};

/// `groups`: which incidences of the data it may see.
[[nodiscard]] std::unique_ptr<const IncidenceMethod> sheetMethod(const BrdfData& data,
                                                                 const std::vector<bool>& groups,
                                                                 SheetMethodOptions options);
/// The model alone.
[[nodiscard]] std::unique_ptr<const IncidenceMethod> modelMethod(Carrier carrier);

}  // namespace gonio::proc
