#include "proc/plan/systematic_floor.h"

#include <cmath>

#include "proc/core/units.h"

namespace gonio::proc {
namespace {

constexpr double kWhiteCommon = 0.005;
constexpr double kWhitePerDirection = 0.003;
constexpr double kDriftPerCapture = 0.002;
constexpr double kExposureRatio = 0.002;
constexpr double kLinearity = 0.003;
constexpr double kBlackReflectance = 0.001;
constexpr double kBlackRelative = 0.10;
constexpr double kTrapPerSteradian = 1e-5;

}  // namespace

SystematicFloor SystematicFloor::typical(Zero zero) {
    const double black =
        zero == Zero::ZeroReference ? kTrapPerSteradian : kBlackReflectance / kPi * kBlackRelative;
    return SystematicFloor({
        {"white reference, common", Correlation::Common, kWhiteCommon, 0},
        {"white reference, per direction", Correlation::PerCell, kWhitePerDirection, 0},
        {"LED drift", Correlation::PerState, std::sqrt(2.0) * kDriftPerCapture, 0},
        {"exposure ratio", Correlation::PerState, kExposureRatio, 0},
        {"linearity", Correlation::Common, kLinearity, 0},
        {zero == Zero::ZeroReference ? "zero reference" : "black reference",
         Correlation::Common,
         0,
         black},
    });
}

double SystematicFloor::at(double f) const {
    double sum = 0;
    for (const FloorComponent& component : components_) {
        const double scaled = component.relative * f;
        sum += scaled * scaled + component.absolute * component.absolute;
    }
    return std::sqrt(sum);
}

}  // namespace gonio::proc
