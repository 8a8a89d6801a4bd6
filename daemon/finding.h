#pragma once
// What the doctor says: one thing looked at, what was seen, and what to do about it.

#include <optional>
#include <string>
#include <string_view>

namespace gonio::daemon {

enum class Verdict {
    Ok,
    Note,  ///< nothing to judge, or not needed here
    Warn,  ///< works, and will be missed sooner or later
    Fail   ///< nothing can be measured like this
};
/// "ok", "note", "warn", "fail".
[[nodiscard]] std::string_view name(Verdict verdict);
/// Empty: none of these.
[[nodiscard]] std::optional<Verdict> parseVerdict(std::string_view name);

struct Finding {
    std::string subject;  ///< "udev-rule"
    Verdict verdict = Verdict::Ok;
    std::string seen;
    std::string cure;   ///< empty: nothing to do
    std::string rig{};  ///< the serial number; empty: of the computer
};

}  // namespace gonio::daemon
