#include "daemon/state.h"

namespace gonio::daemon {

std::string stateName(State state) {
    return "LED " + std::to_string(state.led) + " " + std::string(letter(state.band));
}

std::string bracketName(std::optional<State> state) { return state ? stateName(*state) : "dark"; }

}  // namespace gonio::daemon
