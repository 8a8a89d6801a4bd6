#include "proc/formats/rt300s.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "proc/core/number_text.h"
#include "proc/formats/shown.h"
#include "proc/formats/text_lines.h"

namespace gonio::proc {
namespace {

constexpr std::array<std::string_view, 4> kColumns{
    "azimuth_deg", "incidence_deg", "receive_deg", "RT"};

/// Counts what a reader should not believe silently.
std::vector<std::string> warningsOf(std::span<const Rt300sReading> readings) {
    const auto count = [&](auto&& is) {
        return std::count_if(readings.begin(), readings.end(), is);
    };
    const auto negative = count([](const Rt300sReading& r) { return r.value < 0; });
    const auto zero = count([](const Rt300sReading& r) { return r.value == 0; });
    std::vector<std::string> warnings;
    if (negative > 0) warnings.push_back(std::to_string(negative) + " negative values");
    if (zero > 0) warnings.push_back(std::to_string(zero) + " values of exactly 0");
    return warnings;
}

/// What is wrong with a reading's angles; empty where nothing is.
std::string outside(const Rt300sReading& r) {
    if (std::abs(r.azimuthDeg) > 360)
        return "azimuth " + shortest(r.azimuthDeg) + ", wanted [-360, 360]";
    if (r.incidenceDeg < 0 || r.incidenceDeg >= 90) {
        return "incidence " + shortest(r.incidenceDeg) + ", wanted [0, 90)";
    }
    if (std::abs(r.receiveDeg) >= 90) {
        return "receive " + shortest(r.receiveDeg) + ", wanted (-90, 90)";
    }
    return "";
}

class CsvReader {
public:
    CsvReader(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<FileRead<Rt300sScan>> read() {
        while (const auto line = lines_.next()) {
            const std::string_view content = trimmed(*line);
            if (content.empty()) continue;
            if (content.front() == '#') {
                comments_.emplace_back(trimmed(content.substr(1)));
                continue;
            }
            fields_ = fieldsBetween(',', content, std::move(fields_));
            if (!(headerIsRead_ ? row() : header())) return *error_;
        }
        if (!end()) return *error_;
        return std::move(read_);
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File,
                       "rt300s: " + std::string(name_) + ": line " +
                           std::to_string(lines_.number()) + ": " + what};
        return false;
    }
    bool header() {
        headerIsRead_ = true;
        for (std::size_t i = 0; i < kColumns.size(); ++i) {
            const auto found = std::find(fields_.begin(), fields_.end(), kColumns[i]);
            places_[i] = static_cast<std::size_t>(found - fields_.begin());
            if (found == fields_.end() || fields_.size() != kColumns.size()) {
                return fail("the header wants azimuth_deg,incidence_deg,receive_deg,RT");
            }
        }
        return true;
    }
    bool row() {
        if (fields_.size() != kColumns.size()) {
            return fail(std::to_string(fields_.size()) + " fields, the header has " +
                        std::to_string(kColumns.size()) +
                        (fields_.size() > kColumns.size() ? "; a decimal comma?" : ""));
        }
        std::array<double, 4> numbers{};
        for (std::size_t i = 0; i < kColumns.size(); ++i) {
            const auto number = parseDouble(fields_[places_[i]]);
            if (!number) {
                return fail(std::string(kColumns[i]) + ": " + shown(fields_[places_[i]]) +
                            ", wanted a number");
            }
            numbers[i] = *number;
        }
        const Rt300sReading reading{numbers[0], numbers[1], numbers[2], numbers[3]};
        if (const std::string what = outside(reading); !what.empty()) return fail(what);
        read_.content.readings.push_back(reading);
        return true;
    }
    bool end() {
        auto& readings = read_.content.readings;
        if (readings.empty()) return fail("no reading");
        std::vector<std::array<double, 3>> angles;
        angles.reserve(readings.size());
        for (const Rt300sReading& r : readings) {
            angles.push_back({r.azimuthDeg, r.incidenceDeg, r.receiveDeg});
        }
        std::sort(angles.begin(), angles.end());
        const auto twice = std::adjacent_find(angles.begin(), angles.end());
        if (twice != angles.end()) {
            return fail("two readings at azimuth " + shortest((*twice)[0]) + ", incidence " +
                        shortest((*twice)[1]) + ", receive " + shortest((*twice)[2]));
        }
        read_.about = metadataOfLines(comments_);
        read_.warnings = warningsOf(readings);
        return true;
    }

    TextLines lines_;
    std::string_view name_;
    FileRead<Rt300sScan> read_;
    std::vector<std::string_view> fields_;
    std::array<std::size_t, 4> places_{};
    std::vector<std::string> comments_;
    bool headerIsRead_ = false;
    std::optional<Error> error_;
};

class JdvReader {
public:
    JdvReader(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<FileRead<std::vector<JdvBlock>>> read() {
        while (nextLine()) {
            if (!block()) return *error_;
        }
        if (read_.content.empty()) {
            fail("the text ends, wanted DataType");
            return *error_;
        }
        std::vector<Rt300sReading> all;
        for (const JdvBlock& one : read_.content) {
            all.insert(all.end(), one.scan.readings.begin(), one.scan.readings.end());
        }
        read_.warnings = warningsOf(all);
        return std::move(read_);
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File,
                       "jdv: " + std::string(name_) + ": line " + std::to_string(lines_.number()) +
                           ": " + what};
        return false;
    }
    /// The next line that says something, as fields; trailing empty ones are the export's filling.
    bool nextLine() {
        while (const auto line = lines_.next()) {
            fields_ = fieldsBetween('\t', *line, std::move(fields_));
            while (!fields_.empty() && fields_.back().empty()) fields_.pop_back();
            if (!fields_.empty()) return true;
        }
        fields_.clear();
        return false;
    }

    /// first, last, step as "-30,30,30".
    struct Steps {
        double first = 0, last = 0, step = 0;
        std::size_t count = 0;
        [[nodiscard]] double at(std::size_t i) const {
            return first + static_cast<double>(i) * step;
        }
    };
    bool steps(std::string_view keyword, std::string_view text, Steps& into) {
        const std::vector<std::string_view> parts = fieldsBetween(',', text);
        std::array<double, 3> numbers{};
        for (std::size_t i = 0; i < 3 && parts.size() == 3; ++i) {
            const auto number = parseDouble(parts[i]);
            if (!number)
                return fail(std::string(keyword) + " " + shown(parts[i]) + ", wanted a number");
            numbers[i] = *number;
        }
        const double span = numbers[1] - numbers[0];
        const double count = numbers[2] == 0 ? 0 : span / numbers[2];
        constexpr double kMost = 10'000;
        const bool whole = std::abs(count - std::round(count)) < 1e-6;
        if (parts.size() != 3 || !whole || count < 0 || count > kMost) {
            return fail(std::string(keyword) + " " + shown(text) + ", wanted first,last,step");
        }
        into = {
            numbers[0], numbers[1], numbers[2], static_cast<std::size_t>(std::lround(count)) + 1};
        return true;
    }

    bool keyword(std::string_view wanted, std::string_view& value) {
        if (fields_.empty() || fields_[0] != wanted) {
            return fail((fields_.empty() ? "the text ends" : shown(fields_[0])) + ", wanted " +
                        std::string(wanted));
        }
        value = fields_.size() > 1 ? fields_[1] : std::string_view();
        nextLine();
        return true;
    }

    bool block() {
        JdvBlock one;
        std::string_view value, polarText, azimuthText, incidenceText;
        if (!keyword("DataType:", value)) return false;
        if (value != "BRDF(RT-300S)")
            return fail("DataType " + shown(value) + ", wanted BRDF(RT-300S)");
        if (!keyword("SampleID:", value)) return false;
        one.sampleId = std::string(value);
        if (!keyword("Date:", value)) return false;
        one.date = std::string(value);
        if (!keyword("Incidence:", incidenceText) || !keyword("Polar:", polarText) ||
            !keyword("Azimuth:", azimuthText)) {
            return false;
        }
        const auto incidence = parseDouble(incidenceText);
        if (!incidence) return fail("Incidence: " + shown(incidenceText) + ", wanted a number");
        Steps polar, azimuth;
        if (!steps("Polar:", polarText, polar) || !steps("Azimuth:", azimuthText, azimuth)) {
            return false;
        }
        if (fields_.empty() || fields_[0] != "Raw data") return fail("no 'Raw data'");
        if (!grid(one.scan, *incidence, polar, azimuth)) return false;
        read_.content.push_back(std::move(one));
        return true;
    }

    /// A row of angles, then rows of an angle and its values.
    bool grid(Rt300sScan& scan, double incidence, const Steps& polar, const Steps& azimuth) {
        if (!nextLine()) return fail("the text ends, wanted the polar angles");
        // They stand behind an empty field, which the first column's angles leave free.
        if (!row(polar.count + 1)) return false;
        for (std::size_t p = 0; p < polar.count; ++p) {
            if (!sameAngle(numbers_[p + 1], polar.at(p), "polar")) return false;
        }
        for (std::size_t a = 0; a < azimuth.count; ++a) {
            if (!nextLine()) {
                return fail("the text ends after " + std::to_string(a) + " of " +
                            std::to_string(azimuth.count) + " rows");
            }
            if (!row(polar.count + 1) || !sameAngle(numbers_[0], azimuth.at(a), "azimuth")) {
                return false;
            }
            for (std::size_t p = 0; p < polar.count; ++p) {
                const Rt300sReading reading{azimuth.at(a), incidence, polar.at(p), numbers_[p + 1]};
                if (const std::string what = outside(reading); !what.empty()) return fail(what);
                scan.readings.push_back(reading);
            }
        }
        return true;
    }
    bool row(std::size_t count) {
        if (fields_.size() != count) {
            return fail(std::to_string(fields_.size()) + " fields, the block promised " +
                        std::to_string(count));
        }
        numbers_.assign(count, 0);
        for (std::size_t i = 0; i < count; ++i) {
            if (i == 0 && fields_[0].empty()) continue;
            const auto number = parseDouble(fields_[i]);
            if (!number) return fail(shown(fields_[i]) + ", wanted a number");
            numbers_[i] = *number;
        }
        return true;
    }
    bool sameAngle(double seen, double wanted, const char* what) {
        return std::abs(seen - wanted) < 1e-6 ||
               fail(std::string(what) + " angle " + shortest(seen) + ", the block promised " +
                    shortest(wanted));
    }

    TextLines lines_;
    std::string_view name_;
    FileRead<std::vector<JdvBlock>> read_;
    std::vector<std::string_view> fields_;
    std::vector<double> numbers_;
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<Rt300sScan>> parseRt300sCsv(std::string_view text, std::string_view name) {
    return CsvReader(text, name).read();
}

Result<FileRead<std::vector<JdvBlock>>> parseJdv(std::string_view text, std::string_view name) {
    return JdvReader(text, name).read();
}

bool isJdv(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    return text.starts_with("DataType:");
}

}  // namespace gonio::proc
