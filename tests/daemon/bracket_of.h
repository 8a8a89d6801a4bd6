#pragma once
// A bracket's frames in one list.

#include <vector>

#include "daemon/sequencer.h"

namespace gonio::daemon::test {

inline Result<std::vector<Frame>> bracketOf(Sequencer& sequencer,
                                            State state,
                                            const BracketPlan& plan,
                                            std::optional<State> then = {}) {
    std::vector<Frame> frames;
    const Result<void> taken = sequencer.bracket(state,
                                                 plan,
                                                 {.frame = [&](Frame frame) -> Result<void> {
                                                      frames.push_back(std::move(frame));
                                                      return {};
                                                  },
                                                  .begin = [&]() -> Result<void> {
                                                      frames.clear();
                                                      return {};
                                                  }},
                                                 then);
    if (!taken) return taken.error();
    return frames;
}

}  // namespace gonio::daemon::test
