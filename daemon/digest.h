#pragma once
// The name of a content: SHA-256 [FIPS180] of its bytes, as 64 hexadecimal digits.

#include <string>
#include <string_view>

namespace gonio::daemon {

[[nodiscard]] std::string digestOf(std::string_view bytes);

}  // namespace gonio::daemon
