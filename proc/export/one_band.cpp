#include "proc/export/one_band.h"

namespace gonio::proc {

Answer OneBand::answer(const LightView& pair) const {
    Answer answer = all_->answer(pair);
    answer.f = LedBands::all(answer.f[band_]);
    if (answer.uRandom) answer.uRandom = LedBands::all((*answer.uRandom)[band_]);
    if (answer.uSystematic) answer.uSystematic = LedBands::all((*answer.uSystematic)[band_]);
    return answer;
}

}  // namespace gonio::proc
