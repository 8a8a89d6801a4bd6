#pragma once
// The share of the light that a file's values send back, beside what the file says itself.

#include "proc/quality/file_facts.h"

namespace gonio::proc {

/// For each light direction, channel and side of the surface that a table holds; of what holds all
/// directions, the bands at 0, 20, 40 and 60 degrees. Of scattered values: nothing.
[[nodiscard]] std::vector<TotalFacts> totalsOf(const BrdfFile& file);

}  // namespace gonio::proc
