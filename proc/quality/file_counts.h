#pragma once
// How many directions of a file hold a value, and what values.

#include "proc/quality/file_facts.h"

namespace gonio::proc {

struct FileCounts {
    std::vector<ChannelFacts> channels;
    std::size_t lights = 0;  ///< 0: all of them
    bool reflection = false, transmission = false;
    std::optional<Range> thetaOutDeg;
};

[[nodiscard]] FileCounts countsOf(const BrdfFile& file);

}  // namespace gonio::proc
