#pragma once
// Work that takes long while a rig is claimed: it runs in a thread of its own, and the owner of the
// rig feeds the heartbeat meanwhile.

#include <chrono>
#include <future>
#include <utility>

#include "driver/rig.h"

namespace gonio::daemon {

/// What `work` answers. The rig stays the calling thread's, which says each time that it is
/// `alive`.
template <class Alive, class Work>
auto alongside(driver::Rig& rig, Alive alive, Work work) {
    constexpr auto kPause = std::chrono::milliseconds(200);
    auto answer = std::async(std::launch::async, std::move(work));
    // A rig that is lost meanwhile is found out by whoever needs it next.
    while (answer.wait_for(kPause) != std::future_status::ready) {
        alive();
        (void)rig.keepAlive();
    }
    return answer.get();
}

}  // namespace gonio::daemon
