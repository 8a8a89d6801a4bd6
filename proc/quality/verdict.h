#pragma once
// What a check of a measured sample found: its grade, the figure that was measured and the limit
// that it was held against, one sentence of evidence, and what to do next. A sample carries its
// verdicts as JSON text in SampleInfo::qcVerdicts, an array of objects
//     {"name", "grade", "value", "u", "unit", "limit", "evidence", "next"}
// with null for what is not known. Fractions have the unit "1", angles are in degrees.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::proc {

enum class Grade {
    Ok,
    Warned,
    Refused,
    NotDetermined
};
/// "ok", "warned", "refused", "not determined".
[[nodiscard]] std::string_view name(Grade grade);

struct Figure {
    double value = 0;
    std::optional<double> u;  ///< standard uncertainty (k = 1); empty: not known
    std::string unit;         ///< "1" for a fraction, else "degrees", ...
    double limit = 0;         ///< the one that it is beyond, or that it would pass first
};

struct Verdict {
    std::string name;  ///< "tilt", "waviness", "light", ...
    Grade grade = Grade::NotDetermined;
    std::optional<Figure> figure;
    std::string evidence;
    std::string next;  ///< what to do; empty when nothing is to be done
};

/// A figure against two limits: refused above one, warned above the other, which is lower.
struct Limits {
    double warned = 0, refused = 0;
};
/// Sets the figure's limit.
[[nodiscard]] Grade graded(Figure& figure, const Limits& limits);

/// "tilt: warned, 1.52 degrees (u 0.01 degrees, limit 1 degrees): ...; seat it again".
[[nodiscard]] std::string described(const Verdict& verdict);
/// "12.3 %" of a fraction, else the value with its unit; three significant digits.
[[nodiscard]] std::string amount(double value, const std::string& unit);

/// JSON text, as a sample carries it.
[[nodiscard]] std::string verdictsText(std::span<const Verdict> verdicts);
/// What a sample carries. Free text, as older files have it, is one verdict that was not determined
/// with the text as evidence; empty text is none.
[[nodiscard]] std::vector<Verdict> readVerdicts(std::string_view text);

/// In the place of the one of its name, or behind all.
void put(std::vector<Verdict>& verdicts, Verdict verdict);

}  // namespace gonio::proc
