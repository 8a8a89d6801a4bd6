#pragma once
// Work in another thread while the rig goes on: a merge beside the next state's captures, or a long
// phase during which nothing else feeds the rig's heartbeat. What goes in: a task that touches
// neither the rig nor anything that changes meanwhile. What comes out: its value, or its Error; an
// exception ends as an Internal Error. Only the caller's thread touches the rig. A rig that is lost
// meanwhile does not cost the task its value: the next call on the rig says so. Destruction waits
// for the task.

#include <chrono>
#include <future>
#include <type_traits>
#include <utility>

#include "daemon/guarded.h"
#include "driver/rig.h"

namespace gonio::daemon {

template <class Value>
class Alongside {
public:
    /// Begins `task`.
    template <class Task>
    explicit Alongside(Task task)
        // Either policy: where no thread can be had, the task runs in await().
        : answer_(std::async(std::launch::async | std::launch::deferred,
                             [task = std::move(task)]() mutable -> Result<Value> {
                                 return guarded("beside the rig", task);
                             })) {}

    /// Waits, keeps the rig alive meanwhile, and calls `waiting` as often. Once.
    template <class Waiting>
    Result<Value> await(driver::Rig& rig, Waiting waiting) {
        bool alive = true;
        while (answer_.wait_for(kFeeding) == std::future_status::timeout) {
            waiting();
            if (alive) alive = rig.keepAlive().has_value();
        }
        return answer_.get();
    }

private:
    // The rig wants a PING at least every heartbeat / 4, 500 ms as the link claims it.
    static constexpr std::chrono::milliseconds kFeeding{200};

    std::future<Result<Value>> answer_;
};

template <class Task>
Alongside(Task) -> Alongside<typename AsResult<std::invoke_result_t<Task&>>::Type::value_type>;

/// The task's value; until it is there the rig is kept alive, and `waiting` is called as often.
template <class Waiting, class Task>
[[nodiscard]] auto alongside(driver::Rig& rig, Waiting waiting, Task task) {
    return Alongside(std::move(task)).await(rig, std::move(waiting));
}

}  // namespace gonio::daemon
