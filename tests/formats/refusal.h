#pragma once
// What a reader's refusal must be: a File error, one line, that says what it is asked to say.

#include <gtest/gtest.h>

#include <initializer_list>
#include <string_view>

#include "proc/core/result.h"

namespace gonio::test {

template <class T>
testing::AssertionResult refuses(const Result<T>& result,
                                 std::initializer_list<std::string_view> words = {}) {
    if (result) return testing::AssertionFailure() << "accepted";
    const Error& error = result.error();
    if (error.kind != ErrorKind::File) return testing::AssertionFailure() << "not a File error";
    if (error.message.empty() || error.message.find_first_of("\r\n") != std::string::npos) {
        return testing::AssertionFailure() << "not one line: '" << error.message << "'";
    }
    for (const std::string_view word : words) {
        if (error.message.find(word) == std::string::npos) {
            return testing::AssertionFailure()
                   << "no '" << word << "' in '" << error.message << "'";
        }
    }
    return testing::AssertionSuccess();
}

}  // namespace gonio::test
