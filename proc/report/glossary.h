#pragma once
// What the words, letters and units of a report mean.

#include "proc/report/html_page.h"

namespace gonio::proc {

[[nodiscard]] Facts glossary();

}  // namespace gonio::proc
