#include "proc/models/sum.h"

namespace gonio::proc {

Answer Sum::answer(const LightView& pair) const {
    Answer total;
    for (const auto& part : parts_) {
        const Answer one = part->answer(pair);
        total.f = total.f + one.f;
        total.flags = total.flags | one.flags;
    }
    return total;
}

}  // namespace gonio::proc
