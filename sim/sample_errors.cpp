#include "sim/sample_errors.h"

#include <cmath>
#include <string>

#include "proc/core/number_text.h"

namespace gonio::sim {
namespace {

constexpr Radians kWaviest = 10_deg;
constexpr LedBands kDepth{{1, 0.6, 0.4}};
constexpr double kWhiteBacking = 0.9;
constexpr double kBlackBacking = 0.03;
constexpr double kRelaxationSeconds = 1;
constexpr Radians kLobeWidth = 10_deg;

Result<void> within(const std::string& what, double size, double most) {
    if (size >= 0 && size <= most) return {};
    return Error{ErrorKind::Usage, what + " " + shortest(size) + ": wanted 0.." + shortest(most)};
}

}  // namespace

LedBands subsurface(const SampleErrors& errors) {
    const double backing = errors.backing == Backing::White ? kWhiteBacking : kBlackBacking;
    return kDepth * (errors.translucency * backing / kPi);
}

double pressed(const SampleErrors& errors, Nanoseconds sincePlaced) {
    const double seconds = static_cast<double>(sincePlaced.count()) * 1e-9;
    return errors.softness * std::exp(-seconds / kRelaxationSeconds);
}

double lobeShape(Radians fromMirror) {
    const double widths = fromMirror.value() / kLobeWidth.value();
    return std::exp(-widths * widths / 2);
}

Result<void> check(const SampleErrors& errors) {
    if (!(errors.waviness >= Radians() && errors.waviness <= kWaviest)) {
        return Error{ErrorKind::Usage,
                     "waviness " + shortest(errors.waviness.degrees()) + ": wanted 0..10 degrees"};
    }
    for (const Result<void>& good : {within("translucency", errors.translucency, 1),
                                     within("softness", errors.softness, 1),
                                     within("ambient light", errors.ambient, 1)}) {
        if (!good) return good;
    }
    return {};
}

}  // namespace gonio::sim
