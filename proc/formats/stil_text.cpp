#include "proc/formats/stil_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/shown.h"
#include "proc/formats/spherical_warnings.h"
#include "proc/formats/text_lines.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

std::vector<std::string_view> fieldsOf(std::string_view line) {
    std::vector<std::string_view> fields = fieldsBetween('\t', line);
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    return fields;
}

/// Lines that end in CR, LF or CR LF.
class Lines {
public:
    explicit Lines(std::string_view text) : text_(text) {
        if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    }
    [[nodiscard]] bool done() const { return at_ >= text_.size(); }
    [[nodiscard]] int number() const { return line_; }
    [[nodiscard]] std::size_t bytesLeft() const { return text_.size() - at_; }
    std::vector<std::string_view> take() {
        const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
        const std::string_view line = text_.substr(at_, end - at_);
        at_ = end + (text_.substr(end).starts_with("\r\n") ? 2 : 1);
        ++line_;
        return fieldsOf(line);
    }

private:
    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 0;
};

struct Range {
    std::optional<double> first, last, step;

    /// 0 where it is not whole or no range.
    [[nodiscard]] double count() const {
        if (!first || !last || !step) return 0;
        if (*first == *last) return 1;
        const double steps = (*last - *first) / *step;
        return steps > 0 && std::abs(steps - std::round(steps)) < 1e-6 ? std::round(steps) + 1 : 0;
    }
    [[nodiscard]] double at(std::size_t i) const {
        return *first + static_cast<double>(i) * step.value_or(0);
    }
};

struct Scan {
    Range theta, phi;
    std::optional<double> incidence;
    std::vector<double> values;  ///< theta > phi
    std::size_t thetas = 0, phis = 0;
    bool begun = false;
};

/// Where a value of an axis stands that is on it.
std::size_t placeOf(const std::vector<double>& axis, double at) {
    return static_cast<std::size_t>(std::lower_bound(axis.begin(), axis.end(), at) - axis.begin());
}

/// Values by direction, of which a scan may have several: a place beyond the normal is one before
/// it at phi + 180, phi 0 is 360, and the normal is at every phi.
class Directions {
public:
    explicit Directions(SphericalBlock& block)
        : block_(block), counts_(block.f.size(), 0), differs_(block.f.size(), false) {}

    /// The mean of what is not 0, which is no signal.
    void add(std::size_t azimuth, std::size_t theta, double value) {
        const bool pole = block_.thetaDeg[theta] == 0;
        const std::size_t at = block_.index(pole ? 0 : azimuth, theta);
        double& f = block_.f[at];
        if (std::isnan(f)) {
            f = value;
            counts_[at] = value != 0 ? 1 : 0;
            return;
        }
        if (value != f) differs_[at] = true;
        if (value == 0) return;
        const double count = ++counts_[at];
        f += value / count - f / count;  // stays finite: a sum might not
    }
    /// Directions of several values that are not the same.
    std::size_t settle() {
        if (block_.thetaDeg.front() == 0) {
            for (std::size_t a = 1; a < block_.azimuthDeg.size(); ++a) {
                block_.f[block_.index(a, 0)] = block_.f[block_.index(0, 0)];
            }
        }
        return static_cast<std::size_t>(std::count(differs_.begin(), differs_.end(), true));
    }

private:
    SphericalBlock& block_;
    std::vector<std::uint32_t> counts_;
    std::vector<bool> differs_;
};

struct ScannedBlock {
    SphericalBlock block;
    std::size_t differing = 0;  ///< directions of several values that are not the same
};

ScannedBlock blockOf(const Scan& scan) {
    SphericalBlock block{.incidenceDeg = *scan.incidence};
    const auto azimuthOf = [&](std::size_t theta, std::size_t phi) {
        const double turned = scan.phi.at(phi) + (scan.theta.at(theta) < -1e-9 ? 180 : 0);
        return roundedDegrees(turned - 360 * std::floor(roundedDegrees(turned) / 360));
    };
    const auto thetaOf = [&](std::size_t i) { return roundedDegrees(std::abs(scan.theta.at(i))); };
    std::set<double> azimuths;
    std::set<double> thetas;
    for (std::size_t t = 0; t < scan.thetas; ++t) {
        thetas.insert(thetaOf(t));
        for (std::size_t p = 0; p < scan.phis; ++p) azimuths.insert(azimuthOf(t, p));
    }
    block.azimuthDeg.assign(azimuths.begin(), azimuths.end());
    block.thetaDeg.assign(thetas.begin(), thetas.end());
    block.f.assign(azimuths.size() * thetas.size(), std::numeric_limits<double>::quiet_NaN());
    Directions directions(block);
    for (std::size_t t = 0; t < scan.thetas; ++t) {
        const std::size_t theta = placeOf(block.thetaDeg, thetaOf(t));
        for (std::size_t p = 0; p < scan.phis; ++p) {
            const std::size_t azimuth = placeOf(block.azimuthDeg, azimuthOf(t, p));
            directions.add(azimuth, theta, scan.values[t * scan.phis + p]);
        }
    }
    const std::size_t differing = directions.settle();
    return {std::move(block), differing};
}

class Reader {
public:
    Reader(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<FileRead<SphericalTable>> read() {
        while (!lines_.done()) {
            if (!line(lines_.take())) return *error_;
        }
        if (scan_.begun && !endScan()) return *error_;
        if (out_.content.blocks.empty() && !fail("no scan, wanted 'Theta Lighting' and rows")) {
            return *error_;
        }
        out_.content.mirrorAzimuthDeg = kStilMirrorDeg;
        warn();
        return std::move(out_);
    }

private:
    bool fail(const std::string& what) {
        if (!error_) {
            error_ = Error{ErrorKind::File,
                           "stil: " + std::string(name_) + ": line " +
                               std::to_string(lines_.number()) + ": " + what};
        }
        return false;
    }

    bool line(const std::vector<std::string_view>& fields) {
        if (fields.empty()) return !inRows() || scan_.values.empty() || endScan();
        if (fields[0].empty()) return fail("a value without its theta");
        if (parseDouble(fields[0])) return row(fields);
        if (inRows() && !scan_.values.empty() && !endScan()) return false;
        if (inRows()) return fail(shown(fields[0]) + ", wanted a row of values");
        return header(fields);
    }
    [[nodiscard]] bool inRows() const { return scan_.incidence.has_value(); }

    bool header(const std::vector<std::string_view>& fields) {
        scan_.begun = true;
        std::string key = lower(fields[0].substr(0, 80));
        if (key.ends_with(':')) key.pop_back();
        while (key.ends_with(' ')) key.pop_back();
        const std::string_view value = fields.size() > 1 ? fields[1] : std::string_view();
        using Field = std::pair<std::string_view, std::optional<double>*>;
        const std::array<Field, 7> numbers{{
            {"theta measure beginning", &scan_.theta.first},
            {"theta measure end", &scan_.theta.last},
            {"theta measure step", &scan_.theta.step},
            {"phi measure beginning", &scan_.phi.first},
            {"phi measure end", &scan_.phi.last},
            {"phi measure step", &scan_.phi.step},
            {"theta lighting", &scan_.incidence},
        }};
        for (const auto& [known, into] : numbers) {
            if (key != known) continue;
            if (*into) return fail(shown(fields[0]) + " is given twice in one scan");
            *into = parseDouble(value);
            if (!*into) return fail(shown(value) + ", wanted the degrees of " + std::string(known));
            return known != "theta lighting" || headerIsWhole();
        }
        if (key == "data file type" && lower(value).find("brdf") == std::string::npos) {
            return fail("data file type " + shown(value) + ", wanted one with BRDF");
        }
        if (key == "name / comment") out_.about.set(key::kSample, printable(value));
        const std::string comment = printable(fields[0]) + " " + printable(value);
        if (comments_.insert(comment).second) out_.about.comments.push_back(comment);
        return true;
    }

    bool headerIsWhole() {
        if (*scan_.incidence < 0 || *scan_.incidence >= 90) {
            return fail("Theta Lighting " + shortest(*scan_.incidence) + ", wanted [0, 90)");
        }
        const double thetas = scan_.theta.count();
        const double phis = scan_.phi.count();
        if (thetas < 1) return fail("Theta measure beginning, end and step make no range");
        if (phis < 1) return fail("Phi measure beginning, end and step make no range");
        if (std::max(std::abs(*scan_.theta.first), std::abs(*scan_.theta.last)) > 90) {
            return fail("Theta measure goes beyond 90 degrees, where reflection ends");
        }
        if (std::abs(*scan_.phi.first) > 360 || std::abs(*scan_.phi.last) > 360) {
            return fail("Phi measure goes beyond 360 degrees");
        }
        if (thetas * phis > static_cast<double>(lines_.bytesLeft()) / 2 + 1) {
            return fail("the header promises " + shortest(thetas * phis) + " values, " +
                        std::to_string(lines_.bytesLeft()) + " bytes are left");
        }
        scan_.thetas = static_cast<std::size_t>(thetas);
        scan_.phis = static_cast<std::size_t>(phis);
        return true;
    }

    bool row(const std::vector<std::string_view>& fields) {
        if (!inRows()) return fail(shown(fields[0]) + ", wanted Theta Lighting before the rows");
        const std::size_t rows = scan_.values.size() / scan_.phis;
        if (rows == scan_.thetas) {
            return fail("more than " + std::to_string(scan_.thetas) + " rows, header promised " +
                        std::to_string(scan_.thetas));
        }
        if (std::abs(*parseDouble(fields[0]) - scan_.theta.at(rows)) > 1e-6) {
            return fail("theta " + shown(fields[0]) + ", wanted " + shortest(scan_.theta.at(rows)));
        }
        if (fields.size() - 1 != scan_.phis) {
            return fail(std::to_string(fields.size() - 1) + " values in row, header promised " +
                        std::to_string(scan_.phis));
        }
        for (std::size_t i = 1; i < fields.size(); ++i) {
            const auto value = parseDouble(fields[i]);
            if (!value) return fail(shown(fields[i]) + " is not a finite number");
            zeros_ += *value == 0 ? 1U : 0U;
            scan_.values.push_back(*value);
        }
        return true;
    }

    bool endScan() {
        if (!inRows()) return fail("the text ends within a header, wanted Theta Lighting");
        const std::size_t rows = scan_.values.size() / scan_.phis;
        if (rows != scan_.thetas) {
            return fail(std::to_string(rows) + " rows, header promised " +
                        std::to_string(scan_.thetas));
        }
        auto [block, differing] = blockOf(scan_);
        differing_ += differing;
        block.channel = scansOf_[block.incidenceDeg]++;
        if (block.channel == out_.content.channels.size()) {
            out_.content.channels.push_back({"scan " + std::to_string(block.channel + 1), {}});
        }
        out_.content.blocks.push_back(std::move(block));
        scan_ = {};
        return true;
    }

    void warn() {
        SphericalTable& table = out_.content;
        if (table.channels.size() == 1) {
            table.channels[0] = {};
        } else {
            out_.warnings.push_back("an incidence was scanned " +
                                    std::to_string(table.channels.size()) +
                                    " times: each scan is a channel of its own");
        }
        if (zeros_ > 0) {
            out_.warnings.push_back(std::to_string(zeros_) +
                                    " values of exactly 0: no signal, not black");
        }
        if (differing_ > 0) {
            out_.warnings.push_back(std::to_string(differing_) +
                                    " directions were scanned more than once, with values that "
                                    "differ: their means are taken");
        }
        for (std::string& warning : sphericalWarnings(table)) {
            out_.warnings.push_back(std::move(warning));
        }
        out_.warnings.emplace_back(
            "the file does not say where the light is: its mirror direction is taken at phi 270, "
            "as the arm's shadow in RT-300S scans has it");
    }

    Lines lines_;
    std::string_view name_;
    Scan scan_;
    FileRead<SphericalTable> out_{.content = {}, .about = {}};
    std::map<double, std::size_t> scansOf_;
    std::set<std::string> comments_;
    std::size_t zeros_ = 0, differing_ = 0;
    std::optional<Error> error_;
};

}  // namespace

bool isStilText(std::string_view text) {
    constexpr std::size_t kHead = 4096;
    for (Lines lines(text.substr(0, kHead)); !lines.done();) {
        const auto fields = lines.take();
        if (!fields.empty() && lower(fields[0]).starts_with("data file type")) return true;
    }
    return false;
}

Result<FileRead<SphericalTable>> parseStilText(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

}  // namespace gonio::proc
