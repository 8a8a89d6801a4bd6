#include "daemon/cli/interrupt.h"

#include <csignal>

namespace gonio::daemon {
namespace {

volatile std::sig_atomic_t caught = 0;

}  // namespace

void catchInterrupt() {
    struct sigaction action {};
    action.sa_handler = [](int) { caught = 1; };
    action.sa_flags =
        static_cast<int>(SA_RESETHAND);  // without SA_RESTART: a read at a prompt ends
    sigaction(SIGINT, &action, nullptr);
}

bool interrupted() { return caught != 0; }

}  // namespace gonio::daemon
