#include "proc/formats/astm.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "proc/core/number_text.h"
#include "proc/formats/channel_texts.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/foreign_keywords.h"
#include "proc/formats/row_notes.h"
#include "proc/formats/shown.h"
#include "proc/formats/text_lines.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kForeign = "astm.";
constexpr std::string_view kOnlyValue = "BRDF";

/// Keys of the format that have one of ours.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kKeys{{
    {"SAMPLE_NAME", key::kSample},
    {"SYSTEM_NAME", key::kRig},
    {"MEAS_DATE", key::kDate},
}};

/// What the reader itself understands.
constexpr std::array<std::string_view, 7> kOwnKeywords{
    "vars", "comment", "num_points", "sample_name", "system_name", "meas_date", "meas_name"};

std::string_view withoutQuotes(std::string_view value) {
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"') {
        return value.substr(1, value.size() - 2);
    }
    return value;
}

std::string columnName(const Channel& channel) {
    if (!channel.name.empty()) return channel.name;
    if (channel.nanometres) return shortest(*channel.nanometres) + "nm";
    return std::string(kOnlyValue);
}

Channel channelNamed(std::string_view name) {
    constexpr std::string_view kUnit = "nm";
    if (name == kOnlyValue) return {};
    if (name.ends_with(kUnit)) {
        const auto nm = parseDouble(name.substr(0, name.size() - kUnit.size()));
        if (nm) return {"", nm};
    }
    return {std::string(name), std::nullopt};
}

/// Wavelengths of channels with names stand in the notes.
Channel plainChannel(const Channel& channel) {
    std::string name = channel.name;
    for (char& c : name) {
        if (c == ',' || static_cast<unsigned char>(c) <= ' ') c = '_';
    }
    return {name, name.empty() ? channel.nanometres : std::nullopt};
}

class Reader {
public:
    Reader(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<FileRead<BrdfRows>> read() {
        if (header() && rowsOfValues() && enough()) return std::move(read_);
        return *error_;
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File,
                       "astm: " + std::string(name_) + ": line " + std::to_string(lines_.number()) +
                           ": " + what};
        return false;
    }
    bool keepComment(std::string_view line) {
        return comments_.add(line) ||
               fail("more than " + std::to_string(CommentLines::kMost) + " comments");
    }

    bool header() {
        while (const auto line = lines_.next()) {
            const std::string_view content = trimmed(*line);
            if (content.empty()) continue;
            const std::size_t end = std::min(content.find_first_of(" \t"), content.size());
            const std::string_view keyword = content.substr(0, end);
            const std::string_view value = trimmed(content.substr(end));
            const std::string known = lower(keyword);
            if (known == "vars") return variables(value);
            if (known == "comment") {
                if (!keepComment(value)) return false;
                continue;
            }
            if (!keys_.insert(known).second) return fail(shown(keyword) + " is given twice");
            if (known == "num_points") {
                promised_ = parseInteger(value);
                if (!promised_ || *promised_ < 0) {
                    return fail("NUM_POINTS: " + shown(value) + ", wanted a number of rows");
                }
            } else {
                keep(keyword, withoutQuotes(value));
            }
        }
        return fail("the text ends, wanted VARS");
    }
    void keep(std::string_view keyword, std::string_view value) {
        for (const auto& [theirs, ours] : kKeys) {
            if (lower(keyword) == lower(theirs)) {
                read_.about.set(ours, std::string(value));
                return;
            }
        }
        if (lower(keyword) == "meas_name") return;
        read_.about.set(std::string(kForeign) + std::string(keyword), std::string(value));
    }

    bool variables(std::string_view list) {
        std::vector<std::string> names;
        for (const std::string_view name : fieldsBetween(',', list)) names.emplace_back(name);
        const auto is = [&](std::initializer_list<std::string_view> wanted) {
            return names.size() > wanted.size() &&
                   std::equal(wanted.begin(), wanted.end(), names.begin());
        };
        threeAngles_ = is({"theta_i", "theta_s", "phi_s"});
        if (!threeAngles_ && !is({"theta_i", "phi_i", "theta_s", "phi_s"})) {
            return fail("VARS " + shown(list) +
                        ", wanted theta_i,phi_i,theta_s,phi_s or theta_i,theta_s,phi_s and "
                        "columns of values");
        }
        std::set<std::string> seen;
        for (std::size_t i = threeAngles_ ? 3 : 4; i < names.size(); ++i) {
            if (names[i].empty()) return fail("VARS has a column without a name");
            if (!seen.insert(names[i]).second) return fail(shown(names[i]) + " is in VARS twice");
            rows().channels.push_back(channelNamed(names[i]));
        }
        // Files exist that have "RGB" under other names; which is which is not said.
        columns_ = names.size();
        return true;
    }

    bool rowsOfValues() {
        std::vector<std::string_view> fields;
        std::vector<double> numbers(columns_);
        while (const auto line = lines_.next()) {
            if (trimmed(*line).empty()) continue;
            fields = fieldsBetween(',', *line, std::move(fields));
            if (fields.size() != columns_) {
                return fail(std::to_string(fields.size()) + " values, VARS has " +
                            std::to_string(columns_));
            }
            for (std::size_t i = 0; i < columns_; ++i) {
                const auto number = parseDouble(fields[i]);
                if (!number) return fail(shown(fields[i]) + ", wanted a number");
                numbers[i] = *number;
            }
            if (!addRow(numbers)) return false;
        }
        return true;
    }
    bool addRow(const std::vector<double>& numbers) {
        const double thetaI = numbers[0];
        const double phiI = threeAngles_ ? 0 : numbers[1];
        const double thetaS = numbers[threeAngles_ ? 1 : 2];
        const double phiS = numbers[threeAngles_ ? 2 : 3];
        for (const double theta : {thetaI, thetaS}) {
            if (theta < 0 || theta > kPi + 1e-5) {
                return fail("a theta of " + shortest(theta) + ", wanted radians in [0, pi]");
            }
        }
        rows().pairs.push_back({.in = fileDirection(fromFileRadians(thetaI), Radians(phiI)),
                                .out = fileDirection(fromFileRadians(thetaS), Radians(phiS))});
        rows().f.insert(rows().f.end(), numbers.begin() + (threeAngles_ ? 3 : 4), numbers.end());
        return true;
    }

    bool enough() {
        const auto count = static_cast<std::int64_t>(rows().pairs.size());
        if (promised_ && *promised_ != count) {
            return fail(std::to_string(count) + " rows, NUM_POINTS promised " +
                        std::to_string(*promised_));
        }
        if (count == 0) return fail("no row of values");
        Metadata told = metadataOfLines(comments_.all());
        for (auto& [name, value] : told.values) read_.about.set(name, std::move(value));
        read_.about.comments = std::move(told.comments);
        takeRowNotes(read_.about, rows());
        if (threeAngles_) rows().isotropic = true;
        read_.warnings = negativeValues(rows());
        return true;
    }

    BrdfRows& rows() { return read_.content; }

    TextLines lines_;
    std::string_view name_;
    FileRead<BrdfRows> read_;
    std::set<std::string> keys_;
    CommentLines comments_;
    std::optional<std::int64_t> promised_;
    std::size_t columns_ = 0;
    bool threeAngles_ = false;
    std::optional<Error> error_;
};

std::string headerText(const BrdfRows& rows, const Metadata& about) {
    std::string text;
    const auto put = [&](std::string_view keyword, std::string_view value) {
        text += std::string(keyword) + " " + onOneLine(trimmed(value)) + "\n";
    };
    for (const auto& [theirs, ours] : kKeys) {
        const std::string_view value = about.at(ours);
        if (!value.empty()) put(theirs, "\"" + std::string(value) + "\"");
    }
    put("MEAS_NAME", "BRDF");
    const auto named = std::any_of(rows.channels.begin(),
                                   rows.channels.end(),
                                   [](const Channel& c) { return !c.name.empty(); });
    Metadata rest = withRowNotes(about, rows, named);
    for (const auto& [keyword, value] : takeForeignKeywords(rest, kForeign, kOwnKeywords)) {
        put(keyword, "\"" + value + "\"");
    }
    for (const std::string& line : metadataLines(rest)) put("COMMENT", line);
    return text;
}

}  // namespace

Result<FileRead<BrdfRows>> parseAstm(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

Result<Written> writeAstm(const BrdfRows& rows, const Metadata& about) {
    Written written;
    std::string body;
    std::size_t count = 0, missing = 0, beside = 0;
    const std::size_t channels = rows.channels.size();
    for (std::size_t pair = 0; pair < rows.pairs.size(); ++pair) {
        const auto first = rows.f.begin() + static_cast<std::ptrdiff_t>(rows.index(pair, 0));
        const auto last = first + static_cast<std::ptrdiff_t>(channels);
        const auto there = static_cast<std::size_t>(
            std::count_if(first, last, [](double f) { return std::isfinite(f); }));
        if (there < channels) {
            missing += channels - there;
            beside += there;
            continue;
        }
        ++count;
        const LightView& at = rows.pairs[pair];
        for (const Direction* w : {&at.in, &at.out}) {
            appendShortest(body, fileRadians(w->theta().value()));
            body += ',';
            appendShortest(body, fileRadians(w->phi().value()));
            body += w == &at.in ? "," : "";
        }
        for (auto f = first; f != last; ++f) {
            body += ',';
            appendShortest(body, *f);
        }
        body += '\n';
    }
    if (count == 0 || channels == 0) return noWholeRow("astm");
    written.loss.add(Loss::Masked, "missing values, left out", missing);
    written.loss.add(Loss::Dropped, "values beside a missing one, left out with it", beside);
    countDroppedColumns(rows, written.loss);
    written.bytes = headerText(rows, about) + "NUM_POINTS " + std::to_string(count) +
                    "\nVARS theta_i,phi_i,theta_s,phi_s";
    const ChannelTexts columns =
        channelTexts(rows.channels, {plainChannel, columnName, channelNamed});
    for (const std::string& column : columns.texts) written.bytes += "," + column;
    written.loss.add(Loss::Clamped, "names of channels", columns.changed);
    written.bytes += "\n" + body;
    return written;
}

}  // namespace gonio::proc
