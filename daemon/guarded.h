#pragma once
// Where exceptions end: those of a library, of the file system, or of a memory that is full. What
// goes in: work that answers a value, a Result or nothing. What comes out: its Result, or an
// Internal Error that says where it happened.

#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include "proc/core/result.h"

namespace gonio::daemon {

/// Result<T> for work that answers T or Result<T>.
template <class Answer>
struct AsResult {
    using Type = Result<Answer>;
};
template <class Value>
struct AsResult<Result<Value>> {
    using Type = Result<Value>;
};

template <class Work>
[[nodiscard]] auto guarded(const std::string& where, Work&& work) ->
    typename AsResult<std::invoke_result_t<Work&>>::Type {
    try {
        if constexpr (std::is_void_v<std::invoke_result_t<Work&>>) {
            work();
            return {};
        } else {
            return work();
        }
    } catch (const std::exception& e) {
        return Error{ErrorKind::Internal, where + ": " + e.what()};
    }
}

}  // namespace gonio::daemon
