#include "proc/formats/bird.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "proc/formats/bird_columns.h"
#include "proc/formats/entry_pairs.h"
#include "proc/formats/file_degrees.h"

namespace gonio::proc {
namespace {

using namespace bird;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Rows of columns that are complete and converted.
class RowMaker {
public:
    RowMaker(Columns columns, std::string_view name) : columns_(std::move(columns)), name_(name) {
        read_.about = std::move(columns_.about);
        read_.warnings = std::move(columns_.warnings);
    }

    Result<FileRead<BrdfRows>> made() {
        if (makeRows()) return std::move(read_);
        return *error_;
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File, "bird: " + std::string(name_) + ": " + what};
        return false;
    }
    [[nodiscard]] const std::vector<double>& of(Number number) const { return columns_.of(number); }
    [[nodiscard]] bool has(Number number) const { return columns_.has(number); }

    /// Which channel each entry has: its wavelength, name and polarization together.
    bool findChannels() {
        struct Label {
            double nm = 0;
            std::array<std::uint32_t, kWords> words{};
            auto operator<=>(const Label&) const = default;
        };
        std::map<Label, std::uint32_t> known;
        const Number wavelength = has(WavelengthI) ? WavelengthI : WavelengthR;
        Label last;
        for (std::size_t i = 0; i < columns_.entries; ++i) {
            Label label;
            if (has(wavelength)) label.nm = of(wavelength)[i];
            for (std::size_t w = 0; w < kWords; ++w) {
                if (columns_.words[w].given) label.words[w] = columns_.words[w].values[i];
            }
            if (i > 0 && label == last) {
                channelOf_.push_back(channelOf_.back());
                continue;
            }
            const auto [place, fresh] =
                known.emplace(label, static_cast<std::uint32_t>(known.size()));
            channelOf_.push_back(place->second);
            last = label;
            if (!fresh) continue;
            read_.content.channels.push_back(
                {nameOf(label.words), has(wavelength) ? std::optional(label.nm) : std::nullopt});
        }
        return true;
    }
    [[nodiscard]] std::string nameOf(const std::array<std::uint32_t, kWords>& words) {
        const auto text = [&](Word w) {
            return columns_.words[w].given ? columns_.words[w].texts[words[w]] : std::string();
        };
        std::string name = text(ChannelName);
        for (const Word side : {PolarizationI, PolarizationR}) {
            const std::string state = text(side);
            if (state.empty() || state == "u" || state == "1,0,0,0") continue;
            name += (name.empty() ? "" : " ") + std::string(kWordNames[side]) + "=" + state;
        }
        return name;
    }

    bool makeRows() {
        if (!findChannels()) return false;
        BrdfRows& rows = read_.content;
        const EntryPairs pairs = pairEntries({.thetaIn = of(ThetaI),
                                              .phiIn = of(PhiI),
                                              .thetaOut = of(ThetaR),
                                              .phiOut = of(PhiR),
                                              .channel = channelOf_,
                                              .channels = rows.channels.size()});
        // Every pair holds all channels: a list of ever new wavelengths would grow as a square.
        constexpr std::size_t kSparsest = 8;
        if (pairs.firstOf.size() > kSparsest * columns_.entries / rows.channels.size() + 1) {
            return fail(std::to_string(columns_.entries) + " values at " +
                        std::to_string(pairs.firstOf.size()) + " direction pairs and in " +
                        std::to_string(rows.channels.size()) + " channels: too few for a table");
        }
        rows.pairs.reserve(pairs.firstOf.size());
        for (const std::uint32_t i : pairs.firstOf) {
            rows.pairs.push_back(
                {.in = fileDirection(Radians(of(ThetaI)[i]), Radians(of(PhiI)[i])),
                 .out = fileDirection(Radians(of(ThetaR)[i]), Radians(of(PhiR)[i]))});
        }
        rows.isotropic = isIsotropic();
        orderChannels(pairs);
        fill(pairs);
        return true;
    }
    /// As the first pair has them that has all: one that comes before may lack the first channel.
    void orderChannels(const EntryPairs& pairs) {
        std::vector<Channel>& channels = read_.content.channels;
        std::vector<std::uint32_t> count(pairs.firstOf.size(), 0);
        for (const std::uint32_t pair : pairs.pairOf) ++count[pair];
        const auto whole = std::find(count.begin(), count.end(), channels.size());
        if (whole == count.begin() || whole == count.end()) return;
        const auto pair = static_cast<std::uint32_t>(whole - count.begin());
        std::vector<std::uint32_t> place(channels.size());
        std::vector<Channel> ordered;
        for (std::size_t i = pairs.firstOf[pair]; ordered.size() < channels.size(); ++i) {
            if (pairs.pairOf[i] != pair) continue;
            place[channelOf_[i]] = static_cast<std::uint32_t>(ordered.size());
            ordered.push_back(channels[channelOf_[i]]);
        }
        channels = std::move(ordered);
        for (std::uint32_t& channel : channelOf_) channel = place[channel];
    }
    [[nodiscard]] bool isIsotropic() const {
        if (!columns_.symmetry.empty()) {
            return columns_.symmetry.find("isotropic") != std::string::npos &&
                   columns_.symmetry.find("anisotropic") == std::string::npos;
        }
        return lightsAtOneAzimuth(read_.content.pairs);
    }

    void fill(const EntryPairs& pairs) {
        BrdfRows& rows = read_.content;
        const std::size_t values = rows.pairs.size() * rows.channels.size();
        const bool split = has(Random);
        const auto place = [&](std::vector<double>& into, Number from) {
            if (!has(from)) return;
            into.assign(values, kNan);
            for (std::size_t i = 0; i < columns_.entries; ++i) {
                into[rows.index(pairs.pairOf[i], channelOf_[i])] = of(from)[i];
            }
            columns_.numbers[from].values = {};
        };
        place(rows.f, Value);
        place(rows.uRandom, split ? Random : Combined);
        if (split) place(rows.uSystematic, Systematic);
        if (!has(FlagMask)) return;
        rows.flags.assign(values, Flags{});
        for (std::size_t i = 0; i < columns_.entries; ++i) {
            rows.flags[rows.index(pairs.pairOf[i], channelOf_[i])] =
                Flags::fromMask(static_cast<std::uint32_t>(of(FlagMask)[i]));
        }
    }

    Columns columns_;
    std::string_view name_;
    FileRead<BrdfRows> read_;
    std::vector<std::uint32_t> channelOf_;
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<BrdfRows>> parseBird(std::string_view text, std::string_view name) {
    Result<Columns> columns = readColumns(text, name);
    if (!columns) return columns.error();
    return RowMaker(std::move(*columns), name).made();
}

}  // namespace gonio::proc
