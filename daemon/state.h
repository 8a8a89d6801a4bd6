#pragma once
// What a bracket is of: one band of one LED.

#include <optional>
#include <string>

#include "proc/core/bands.h"

namespace gonio::daemon {

struct State {
    int led = 0;
    Band band = Band::R;
    bool operator==(const State&) const = default;
};

/// "LED 2 g".
[[nodiscard]] std::string stateName(State state);
/// The same; "dark" where nothing is lit.
[[nodiscard]] std::string bracketName(std::optional<State> state);

}  // namespace gonio::daemon
