#pragma once
// Ctrl-C, once asked for: a command notices and ends what it began; a second Ctrl-C ends the
// program at once.

namespace gonio::daemon {

/// From now on the first SIGINT only sets the flag.
void catchInterrupt();
[[nodiscard]] bool interrupted();

}  // namespace gonio::daemon
