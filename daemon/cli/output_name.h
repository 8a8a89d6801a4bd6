#pragma once
// What is written about a surface is called after it.

#include <string>

#include "daemon/material.h"

namespace gonio::daemon {

/// The sample's own name, the model, or the file's.
[[nodiscard]] std::string titleOf(const std::string& f, const Material& material);
/// Letters, digits and a few signs, at most 80 of them.
[[nodiscard]] std::string fileNameOf(std::string title);

}  // namespace gonio::daemon
