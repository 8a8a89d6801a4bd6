#include "proc/core/scatterer.h"

#include <cmath>
#include <limits>

namespace gonio {

Answer Answer::none(Flags why, Source source) {
    Answer answer;
    answer.f = LedBands::all(std::numeric_limits<double>::quiet_NaN());
    answer.flags = why;
    answer.source = source;
    return answer;
}

std::optional<double> Answer::u(Band band) const {
    if (!uRandom && !uSystematic) return std::nullopt;
    return std::hypot(uRandom ? (*uRandom)[band] : 0, uSystematic ? (*uSystematic)[band] : 0);
}

bool Answer::present() const {
    return !std::isnan(f.value[0]) && !std::isnan(f.value[1]) && !std::isnan(f.value[2]);
}

}  // namespace gonio
