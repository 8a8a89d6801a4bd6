#include "proc/formats/speos_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "proc/core/number_text.h"
#include "proc/formats/shown.h"
#include "proc/formats/speos.h"
#include "proc/formats/speos_values.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

/// Lines and words of a text in turn.
class Cursor {
public:
    explicit Cursor(std::string_view text) : text_(text) {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    }
    [[nodiscard]] int line() const { return line_; }
    [[nodiscard]] std::size_t bytesLeft() const { return text_.size() - at_; }

    /// The next word; empty at the end.
    [[nodiscard]] std::string_view peek() {
        while (at_ < text_.size() && isSpace(text_[at_])) step();
        const std::size_t end = std::min(text_.find_first_of(" \t\r\n\f\v", at_), text_.size());
        return text_.substr(at_, end - at_);
    }
    std::string_view take() {
        const std::string_view word = peek();
        at_ += word.size();
        return word;
    }
    /// What is left of this line, and its end.
    std::string_view restOfLine() {
        const std::size_t start = at_;
        while (at_ < text_.size() && text_[at_] != '\r' && text_[at_] != '\n') ++at_;
        const std::string_view rest = text_.substr(start, at_ - start);
        if (text_.substr(at_).starts_with("\r\n")) ++at_;
        if (at_ < text_.size()) step();
        return rest;
    }
    std::string_view characters(std::size_t count) {
        const std::string_view taken = text_.substr(at_, count);
        for (std::size_t i = 0; i < taken.size(); ++i) step();
        return taken;
    }

private:
    static bool isSpace(char c) {
        return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
    }
    void step() {
        const char c = text_[at_++];
        if (c == '\n' || (c == '\r' && !text_.substr(at_).starts_with("\n"))) ++line_;
    }
    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
};

constexpr double kMost = std::numeric_limits<double>::max();

/// Of a description: bounds what an empty line costs in memory.
constexpr std::ptrdiff_t kMostLines = 10'000;

bool blank(std::string_view text) {
    return text.find_first_not_of(" \t\f\v") == std::string_view::npos;
}

std::vector<std::string> linesOf(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(
            std::min(text.size(), end + (text.substr(end).starts_with("\r\n") ? 2 : 1)));
    }
    return lines;
}

/// Reads one text. The first complaint stops it: each step answers false once there is an error.
class Reader {
public:
    Reader(std::string_view text, std::string_view name) : at_(text), name_(name) {}

    Result<FileRead<SphericalTable>> read(SpeosKind kind) {
        const bool whole = title() && (kind == SpeosKind::Brdf ? brdf() : anisotropic()) && end();
        if (!whole) return *error_;
        if (!bsdf_) out_.about.set(key::kCosine, "yes");
        settle(out_, own_ ? SpeosOrigin::OwnText : SpeosOrigin::Text);
        return std::move(out_);
    }

private:
    bool fail(const std::string& what) {
        if (!error_) {
            error_ = Error{ErrorKind::File,
                           "speos: " + std::string(name_) + ": line " + std::to_string(at_.line()) +
                               ": " + what};
        }
        return false;
    }
    bool failSeen(const std::string& wanted) {
        if (at_.peek().empty()) return fail("the text ends, wanted " + wanted);
        return fail(shown(at_.peek()) + ", wanted " + wanted);
    }

    bool number(double& into, const std::string& what, double low, double high) {
        const auto value = parseDouble(at_.peek());
        if (!value) return failSeen("the number of " + what);
        if (*value < low || *value > high) {
            return failSeen(what + " in [" + shortest(low) + ", " + shortest(high) + "]");
        }
        at_.take();
        into = *value;
        return true;
    }
    bool truth(bool& into, const std::string& what) {
        const std::string_view word = at_.peek();
        if (word != "0" && word != "1") return failSeen("0 or 1 for " + what);
        into = at_.take() == "1";
        return true;
    }
    /// A count whose things take at least two bytes each.
    bool count(std::size_t& into, const std::string& what) {
        const auto value = parseInteger(at_.peek());
        if (!value || *value < 1) return failSeen("the number of " + what);
        at_.take();
        if (static_cast<std::uint64_t>(*value) > at_.bytesLeft() / 2 + 1) {
            return fail(std::to_string(*value) + " " + what + " are promised, " +
                        std::to_string(at_.bytesLeft()) + " bytes are left");
        }
        into = static_cast<std::size_t>(*value);
        return true;
    }
    bool list(std::vector<double>& into,
              std::size_t size,
              const std::string& what,
              double low,
              double high) {
        into.clear();
        for (std::size_t i = 0; i < size; ++i) {
            double value = 0;
            if (!number(value, what, low, high)) return false;
            into.push_back(value);
        }
        return true;
    }
    bool ascends(const std::vector<double>& axis, const std::string& what) {
        for (std::size_t i = 1; i < axis.size(); ++i) {
            if (axis[i] < axis[i - 1] + kFinestStepDeg) {
                return fail(shortest(axis[i]) + " after " + shortest(axis[i - 1]) + ": " + what +
                            " must ascend");
            }
        }
        return true;
    }

    bool title() {
        at_.restOfLine();  // its kind is known already
        if (at_.peek() != "0") return failSeen("mode 0, text");
        at_.take();
        at_.restOfLine();
        const std::string comment = printable(at_.restOfLine());
        own_ = comment == kSpeosOwnComment;
        const auto characters = parseInteger(at_.peek());
        if (!characters || *characters < 0) return failSeen("the length of the description");
        at_.take();
        if (static_cast<std::uint64_t>(*characters) > at_.bytesLeft()) {
            return fail("a description of " + std::to_string(*characters) + " characters, " +
                        std::to_string(at_.bytesLeft()) + " bytes are left");
        }
        at_.restOfLine();
        const auto text = at_.characters(static_cast<std::size_t>(*characters));
        if (std::count(text.begin(), text.end(), '\n') > kMostLines ||
            std::count(text.begin(), text.end(), '\r') > kMostLines) {
            return fail("a description of more than " + std::to_string(kMostLines) + " lines");
        }
        if (!blank(at_.restOfLine())) {
            return fail("the description is longer than its " + std::to_string(*characters) +
                        " characters");
        }
        out_.about = metadataOfLines(linesOf(text));
        if (!own_ && !blank(comment)) {
            out_.about.comments.insert(out_.about.comments.begin(), comment);
        }
        return true;
    }

    bool flags() {
        return truth(reflection_, "reflection") && truth(transmission_, "transmission") &&
               truth(bsdf_, "the kind of values") &&
               (reflection_ || transmission_ || fail("neither reflection nor transmission"));
    }

    bool brdf() {
        std::size_t incidences = 0;
        std::size_t wavelengths = 0;
        std::vector<double> incidenceDeg;
        std::vector<double> nanometres;
        if (!flags() || !count(incidences, "incidences") || !count(wavelengths, "wavelengths") ||
            !list(incidenceDeg, incidences, "incidence", 0, 89.999999) ||
            !ascends(incidenceDeg, "incidences") ||
            !list(nanometres, wavelengths, "wavelength", 1e-3, 1e9) ||
            !distinct(nanometres, "wavelengths")) {
            return false;
        }
        for (const double nm : nanometres) out_.content.channels.push_back(Channel::at(nm));
        for (const bool transmission : sides()) {
            for (const double incidence : incidenceDeg) {
                for (std::size_t channel = 0; channel < wavelengths; ++channel) {
                    SphericalBlock block{.channel = channel,
                                         .incidenceDeg = incidence,
                                         .transmission = transmission};
                    if (!number(block.tis, "total per cent", 0, kMost)) return false;
                    block.tis /= 100;
                    if (!table(std::move(block))) return false;
                }
            }
        }
        return true;
    }

    bool distinct(std::vector<double> values, const std::string& what) {
        std::sort(values.begin(), values.end());
        return std::adjacent_find(values.begin(), values.end()) == values.end() ||
               fail("two equal " + what);
    }
    bool distinctOnCircle(std::vector<double> angles) {
        for (double& angle : angles) angle -= 360 * std::floor(angle / 360);
        std::sort(angles.begin(), angles.end());
        for (std::size_t i = 0; i < angles.size(); ++i) {
            const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + 360;
            if (next - angles[i] < kFinestStepDeg) return fail("two equal anisotropy angles");
        }
        return true;
    }
    [[nodiscard]] std::vector<bool> sides() const {
        std::vector<bool> sides;
        if (reflection_) sides.push_back(false);
        if (transmission_) sides.push_back(true);
        return sides;
    }

    /// The incidences of each anisotropy angle of one side.
    struct Turn {
        double angleDeg = 0;
        std::vector<double> incidenceDeg;
    };
    bool turns(std::vector<Turn>& into) {
        std::size_t angles = 0;
        std::vector<double> angleDeg;
        if (!count(angles, "anisotropy angles") ||
            !list(angleDeg, angles, "anisotropy angle", -360, 360) || !distinctOnCircle(angleDeg)) {
            return false;
        }
        for (const double angle : angleDeg) {
            Turn turn{.angleDeg = angle, .incidenceDeg = {}};
            std::size_t incidences = 0;
            if (!count(incidences, "incidences") ||
                !list(turn.incidenceDeg, incidences, "incidence", 0, 89.999999) ||
                !ascends(turn.incidenceDeg, "incidences")) {
                return false;
            }
            into.push_back(std::move(turn));
        }
        return true;
    }

    bool anisotropic() {
        std::vector<double> vector;
        if (!list(vector, 3, "anisotropy vector", -1e9, 1e9) || !flags()) return false;
        std::vector<std::vector<Turn>> perSide;
        for (std::size_t i = 0; i < sides().size(); ++i) {
            if (!turns(perSide.emplace_back())) return false;
        }
        std::vector<double> reference;
        if (!list(reference, 2, "reference direction", -360, 360)) return false;
        at_.restOfLine();
        const std::string comment = printable(at_.restOfLine());
        if (!blank(comment)) out_.about.comments.push_back(comment);
        if (!spectrum()) return false;
        const auto side = sides();
        for (std::size_t i = 0; i < perSide.size(); ++i) {
            for (const Turn& turn : perSide[i]) {
                for (const double incidence : turn.incidenceDeg) {
                    SphericalBlock block{.incidenceDeg = incidence, .transmission = side[i]};
                    block.lightAzimuthDeg = lightAzimuthOf(turn.angleDeg);
                    if (!table(std::move(block))) return false;
                }
            }
        }
        return true;
    }

    /// Wavelengths with the total per cent of each side; several have one shape for all.
    bool spectrum() {
        std::size_t rows = 0;
        if (!count(rows, "wavelengths")) return false;
        std::string text;
        double nm = 0;
        for (std::size_t i = 0; i < rows * sides().size(); ++i) {
            double percent = 0;
            if (!number(nm, "wavelength", 1e-3, 1e9) || !number(percent, "per cent", 0, kMost)) {
                return false;
            }
            text += (text.empty() ? "" : ", ") + shortest(nm) + " " + shortest(percent);
        }
        out_.content.channels = {rows == 1 ? Channel::at(nm) : Channel{}};
        out_.about.set(kSpeosSpectrum, text);
        return true;
    }

    bool table(SphericalBlock block) {
        std::size_t thetas = 0;
        std::size_t phis = 0;
        if (!count(thetas, "thetas") || !count(phis, "phis")) return false;
        std::size_t promised = 0;
        if (__builtin_mul_overflow(thetas, phis, &promised) || promised > at_.bytesLeft() / 2 + 1) {
            return fail("a table of " + std::to_string(thetas) + " x " + std::to_string(phis) +
                        " values, " + std::to_string(at_.bytesLeft()) + " bytes are left");
        }
        if (!list(block.azimuthDeg, phis, "phi", 0, 360) || !ascends(block.azimuthDeg, "phis")) {
            return false;
        }
        block.f.assign(promised, 0);
        block.thetaDeg.assign(thetas, 0);
        for (std::size_t t = 0; t < thetas; ++t) {
            if (!number(block.thetaDeg[t], "theta", 0, 180)) return false;
            for (std::size_t a = 0; a < phis; ++a) {
                if (!number(block.f[block.index(a, t)], "value", -kMost, kMost)) return false;
            }
        }
        return placed(std::move(block));
    }

    bool placed(SphericalBlock block) {
        if (!ascends(block.thetaDeg, "thetas")) return false;
        if (!block.transmission && block.thetaDeg.back() > 90) {
            return fail("theta " + shortest(block.thetaDeg.back()) + " in reflection, at most 90");
        }
        if (block.transmission && block.thetaDeg.front() < 90) {
            return fail("theta " + shortest(block.thetaDeg.front()) +
                        " in transmission, wanted 90 to 180");
        }
        if (!bsdf_) divideByCosine(block);
        out_.content.blocks.push_back(std::move(block));
        return true;
    }

    /// "End of file" may follow.
    bool end() {
        for (const char* word : {"end", "of", "file"}) {
            if (at_.peek().empty()) return true;
            if (lower(at_.peek()) != word) return failSeen("nothing after the last table");
            at_.take();
        }
        return at_.peek().empty() || failSeen("nothing after the last table");
    }

    Cursor at_;
    std::string_view name_;
    FileRead<SphericalTable> out_{.content = {}, .about = {}};
    bool own_ = false, reflection_ = false, transmission_ = false, bsdf_ = false;
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<SphericalTable>> parseSpeosText(std::string_view text,
                                                std::string_view name,
                                                SpeosKind kind) {
    return Reader(text, name).read(kind);
}

}  // namespace gonio::proc
