#include "proc/formats/scattered_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/channel_texts.h"
#include "proc/formats/csv_rows.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/row_notes.h"
#include "proc/formats/shown.h"
#include "proc/formats/text_lines.h"

namespace gonio::proc {
namespace {

/// What stands behind f_: empty for a channel without name and wavelength.
std::string suffixOf(const Channel& channel) {
    for (const Band band : kBands) {
        if (channel == Channel::of(band)) return "_" + std::string(letter(band));
    }
    const std::string nm =
        channel.nanometres ? shortest(*channel.nanometres) + "nm" : std::string();
    if (channel.name.empty()) return nm.empty() ? "" : "_" + nm;
    return "_" + channel.name + (nm.empty() ? "" : "@" + nm);
}

std::optional<double> nanometresIn(std::string_view text) {
    constexpr std::string_view kUnit = "nm";
    if (!text.ends_with(kUnit)) return std::nullopt;
    return parseDouble(text.substr(0, text.size() - kUnit.size()));
}

/// The inverse; `suffix` without its underscore.
Channel channelOf(std::string_view suffix) {
    for (const Band band : kBands) {
        if (suffix == letter(band)) return Channel::of(band);
    }
    const std::size_t at = suffix.rfind('@');
    const bool both = at != std::string_view::npos;
    const auto nm = nanometresIn(both ? suffix.substr(at + 1) : suffix);
    if (nm && both) return {std::string(suffix.substr(0, at)), nm};
    if (nm) return {"", nm};
    return {std::string(suffix), std::nullopt};
}

/// `suffix` with its underscore; none for one whose uncertainty would be another's u_random or
/// u_systematic.
std::optional<Channel> channelOfColumn(std::string_view suffix) {
    if (suffix.empty()) return Channel{};
    if (suffix.starts_with("_random") || suffix.starts_with("_systematic")) return std::nullopt;
    return channelOf(suffix.substr(1));
}

/// On one line, without blanks at the end.
Channel plainChannel(const Channel& channel) {
    return {onOneLine(channel.name), channel.nanometres};
}

/// Where a channel's columns are.
struct ChannelColumns {
    std::size_t f = 0;
    std::optional<std::size_t> combined, random, systematic, flags;
};

class Reader {
public:
    Reader(std::string_view text, std::string_view name) : csv_(text, name) {}

    Result<FileRead<BrdfRows>> read() {
        bool first = true;
        while (csv_.next()) {
            if (std::exchange(first, false) && !findColumns()) return *csv_.error();
            if (!addRow()) return *csv_.error();
        }
        if (csv_.error()) return *csv_.error();
        if (first) {
            csv_.fail("no row of values");
            return *csv_.error();
        }
        finish();
        return std::move(read_);
    }

private:
    bool findColumns() {
        const std::vector<std::string>& names = csv_.columns();
        for (std::size_t i = 0; i < names.size(); ++i) {
            const bool one = names[i] == "f";
            if (!one && !names[i].starts_with("f_")) continue;
            const std::string suffix = one ? "" : names[i].substr(1);
            const std::optional<Channel> channel = channelOfColumn(suffix);
            if (!channel) {
                return csv_.fail("column " + printable(names[i]) +
                                 ": its uncertainty would be another's u_random or u_systematic");
            }
            rows().channels.push_back(*channel);
            if (!addColumns(i, suffix)) return false;
        }
        if (columns_.empty()) return csv_.fail("no column of values, wanted f, or f_r,f_g,f_b");
        if (columns_.size() > 1) {
            for (const Channel& channel : rows().channels) {
                if (channel == Channel{}) return csv_.fail("a column f beside others, f_...");
            }
        }
        return true;
    }
    bool addColumns(std::size_t f, const std::string& suffix) {
        ChannelColumns columns{.f = f};
        // One mask for all channels is what eval writes.
        const auto& names = csv_.columns();
        const bool ownFlags =
            std::find(names.begin(), names.end(), "flags" + suffix) != names.end();
        const bool good = find("u" + suffix, columns.combined) &&
                          find("u_random" + suffix, columns.random) &&
                          find("u_systematic" + suffix, columns.systematic) &&
                          find(ownFlags ? "flags" + suffix : "flags", columns.flags);
        if (std::count(names.begin(), names.end(), names[f]) > 1) {
            return csv_.fail("column " + printable(names[f]) + " is there twice");
        }
        split_ = split_ || columns.random || columns.systematic;
        uncertain_ = uncertain_ || split_ || columns.combined;
        flagged_ = flagged_ || columns.flags;
        columns_.push_back(columns);
        return good;
    }
    bool find(const std::string& name, std::optional<std::size_t>& place) {
        const auto& names = csv_.columns();
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) return true;
        place = static_cast<std::size_t>(found - names.begin());
        return std::find(found + 1, names.end(), name) == names.end() ||
               csv_.fail("column " + printable(name) + " is there twice");
    }

    bool addRow() {
        rows().pairs.push_back(csv_.pair());
        for (const ChannelColumns& columns : columns_) {
            const auto f = csv_.number(columns.f);
            if (!f) return false;
            rows().f.push_back(*f);
            if (uncertain_ && !addUncertainty(columns)) return false;
            if (flagged_ && !addFlags(columns, *f)) return false;
        }
        return true;
    }
    bool addUncertainty(const ChannelColumns& columns) {
        const bool combined = !columns.random && !columns.systematic;
        const auto random = uncertainty(combined ? columns.combined : columns.random);
        const auto systematic = uncertainty(columns.systematic);
        if (!random || !systematic) return false;
        rows().uRandom.push_back(*random);
        if (split_) rows().uSystematic.push_back(combined ? 0 : *systematic);
        return true;
    }
    std::optional<double> uncertainty(std::optional<std::size_t> column) {
        if (!column) return std::nan("");
        const auto u = csv_.number(*column);
        if (u && *u < 0) {
            csv_.fail(printable(csv_.columns()[*column]) + ": " + shortest(*u) +
                      ", wanted 0 or more");
            return std::nullopt;
        }
        return u;
    }
    bool addFlags(const ChannelColumns& columns, double f) {
        if (!columns.flags) {
            rows().flags.push_back(std::isnan(f) ? Flags{} : Flags{Flag::Measured});
            return true;
        }
        const auto mask = csv_.number(*columns.flags);
        if (!mask) return false;
        if (!(*mask >= 0 && *mask < 1 << kFlagCount && *mask == std::floor(*mask))) {
            return csv_.fail(printable(csv_.columns()[*columns.flags]) + ": " +
                             shown(csv_.fields()[*columns.flags]) + ", wanted a mask of " +
                             std::to_string(kFlagCount) + " flags");
        }
        rows().flags.push_back(Flags::fromMask(static_cast<std::uint32_t>(*mask)));
        return true;
    }

    void finish() {
        read_.about = metadataOfLines(csv_.comments());
        takeRowNotes(read_.about, rows());
        read_.warnings = negativeValues(rows());
    }

    BrdfRows& rows() { return read_.content; }

    CsvRows csv_;
    FileRead<BrdfRows> read_;
    std::vector<ChannelColumns> columns_;
    bool split_ = false, uncertain_ = false, flagged_ = false;
};

class Writer {
public:
    Writer(const BrdfRows& rows, const Metadata& about)
        : rows_(rows),
          suffixes_(channelTexts(rows.channels, {plainChannel, suffixOf, channelOfColumn})) {
        text_.reserve(rows.pairs.size() * (40 + rows.channels.size() * 90) + 2000);
        comments(about);
        header();
    }

    Written write() {
        for (std::size_t pair = 0; pair < rows_.pairs.size(); ++pair) {
            direction(rows_.pairs[pair].in, light_);
            text_ += ',';
            direction(rows_.pairs[pair].out, view_);
            values(pair);
            text_ += '\n';
        }
        written_.loss.add(Loss::Masked, "values that are not finite, left empty", infinite_);
        written_.loss.add(Loss::Clamped, "names of channels", suffixes_.changed);
        written_.bytes = std::move(text_);
        return std::move(written_);
    }

private:
    void comments(const Metadata& about) {
        for (const std::string& line : metadataLines(withRowNotes(about, rows_, false))) {
            text_ += "# " + onOneLine(line) + "\n";
        }
    }
    void header() {
        text_ += "theta_i,phi_i,theta_o,phi_o";
        columns("f");
        if (!rows_.uRandom.empty()) columns("u");
        if (!rows_.uSystematic.empty()) {
            columns("u_random");
            columns("u_systematic");
        }
        if (!rows_.flags.empty()) columns("flags");
        text_ += '\n';
    }
    void columns(const std::string& name) {
        for (const std::string& suffix : suffixes_.texts) text_ += ',' + csvName(name + suffix);
    }

    /// The text of a direction is the last row's as long as it does not change.
    struct LastDirection {
        Eigen::Vector3d vector{0, 0, 0};
        std::string text;
    };
    void direction(const Direction& w, LastDirection& last) {
        if (w.vector() != last.vector) {
            last.vector = w.vector();
            last.text.clear();
            appendShortest(last.text, fileDegrees(w.theta()));
            last.text += ',';
            appendShortest(last.text, fileAzimuthDegrees(w.phi()));
        }
        text_ += last.text;
    }
    void orEmpty(double value) {
        text_ += ',';
        if (std::isfinite(value)) appendShortest(text_, value);
    }
    void values(std::size_t pair) {
        const std::size_t from = rows_.index(pair, 0);
        const std::size_t end = from + rows_.channels.size();
        for (std::size_t i = from; i < end; ++i) {
            orEmpty(rows_.f[i]);
            if (std::isinf(rows_.f[i])) ++infinite_;
        }
        const auto& random = rows_.uRandom;
        const auto& systematic = rows_.uSystematic;
        for (std::size_t i = from; i < end && !random.empty(); ++i) {
            orEmpty(systematic.empty() ? random[i] : std::hypot(random[i], systematic[i]));
        }
        if (!systematic.empty()) {
            for (std::size_t i = from; i < end; ++i) orEmpty(random[i]);
            for (std::size_t i = from; i < end; ++i) orEmpty(systematic[i]);
        }
        for (std::size_t i = from; i < end && !rows_.flags.empty(); ++i) {
            text_ += ',' + std::to_string(rows_.flags[i].mask());
        }
    }

    const BrdfRows& rows_;
    ChannelTexts suffixes_;
    std::string text_;
    LastDirection light_, view_;
    std::size_t infinite_ = 0;
    Written written_;
};

}  // namespace

Result<FileRead<BrdfRows>> parseScatteredCsv(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

Written writeScatteredCsv(const BrdfRows& rows, const Metadata& about) {
    return Writer(rows, about).write();
}

}  // namespace gonio::proc
