#pragma once
// Result<T>: a value or an Error. It keeps the names of std::expected so that it can become it.
// Everything that touches a device, a file or user text returns one; mathematics never does.

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace gonio {

/// What kind of thing went wrong. Kinds are what a program reacts to (exit codes, retries);
/// the message is what a person reads.
enum class ErrorKind {
    Internal,     ///< our own fault, or none of the others
    Usage,        ///< unknown name or option, a value out of its domain
    NoRig,        ///< no rig is there
    Busy,         ///< held by another, or no permission
    Device,       ///< the device failed during a run
    File,         ///< missing, unreadable or malformed
    Quality,      ///< the data were refused
    Interrupted,  ///< stopped, can be resumed
};

/// The program's exit code for a kind (DESIGN.md 7): 1..8.
[[nodiscard]] int exitCode(ErrorKind kind);

/// What was attempted, on what, what was seen and what was wanted:
/// "zemax: line 212: 35 values in block, header promised 36".
struct Error {
    ErrorKind kind = ErrorKind::Internal;
    std::string message;
    int deviceStatus = 0;  ///< the rig's status code (PROTOCOL.md 2) where one caused this, else 0

    /// The same error with "context: " put before the message.
    [[nodiscard]] Error in(const std::string& context) const {
        return {kind, context + ": " + message, deviceStatus};
    }
};

template <class T>
class [[nodiscard]] Result {
public:
    using value_type = T;

    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT(*explicit*)
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(*explicit*)

    [[nodiscard]] bool has_value() const { return state_.index() == 0; }
    explicit operator bool() const { return has_value(); }

    /// Precondition: has_value().
    [[nodiscard]] T& value() & { return *checked(); }
    [[nodiscard]] const T& value() const& { return *std::get_if<0>(&state_); }
    [[nodiscard]] T&& value() && { return std::move(*checked()); }
    [[nodiscard]] T& operator*() & { return value(); }
    [[nodiscard]] const T& operator*() const& { return value(); }
    [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
    [[nodiscard]] T* operator->() { return checked(); }
    [[nodiscard]] const T* operator->() const { return std::get_if<0>(&state_); }

    /// Precondition: !has_value().
    [[nodiscard]] const Error& error() const {
        assert(!has_value());
        return *std::get_if<1>(&state_);
    }

private:
    T* checked() {
        assert(has_value());
        return std::get_if<0>(&state_);
    }
    std::variant<T, Error> state_;
};

/// Success without a value: `return {};`.
template <>
class [[nodiscard]] Result<void> {
public:
    using value_type = void;

    Result() = default;
    Result(Error error) : error_(std::move(error)) {}  // NOLINT(*explicit*)

    [[nodiscard]] bool has_value() const { return !error_; }
    explicit operator bool() const { return has_value(); }
    [[nodiscard]] const Error& error() const {
        assert(error_);
        return *error_;
    }

private:
    std::optional<Error> error_;
};

}  // namespace gonio
