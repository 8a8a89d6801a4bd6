#pragma once
// What a reader gives back: the numbers, what the file says about them, and what its user should
// know before believing them.

#include <string>
#include <vector>

#include "proc/table/metadata.h"

namespace gonio::proc {

template <class T>
struct FileRead {
    T content;
    Metadata about;
    /// One sentence each: "12 negative values", "TIS of incidence 20 is 0.69 of the table's own".
    std::vector<std::string> warnings{};
};

}  // namespace gonio::proc
