#include "proc/formats/bird.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/bird_metadata.h"
#include "proc/formats/entry_pairs.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/json_scan.h"
#include "proc/formats/shown.h"

namespace gonio::proc {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

enum Number : std::size_t {
    ThetaI,
    PhiI,
    ThetaR,
    PhiR,
    Value,
    Combined,
    WavelengthI,
    WavelengthR,
    Random,
    Systematic,
    FlagMask,
    Negative,
    kNumbers
};
constexpr std::array<std::string_view, kNumbers> kNumberNames{"theta_i",
                                                              "phi_i",
                                                              "theta_r",
                                                              "phi_r",
                                                              "BRDF",
                                                              "uBRDF",
                                                              "wavelength_i",
                                                              "wavelength_r",
                                                              "u_random",
                                                              "u_systematic",
                                                              "flags",
                                                              "negative"};
enum Word : std::size_t {
    PolarizationI,
    PolarizationR,
    ChannelName,
    kWords
};
constexpr std::array<std::string_view, kWords> kWordNames{
    "polarization_i", "polarization_r", "channel"};

struct NumberColumn {
    bool given = false;
    std::string unit;
    std::vector<double> values;
};

/// Texts of which few differ: each once, and which one each entry has.
struct WordColumn {
    bool given = false;
    std::vector<std::string> texts;
    std::vector<std::uint32_t> values;

    static constexpr std::size_t kMostTexts = 1024;
    /// False: too many.
    bool add(std::string_view text) {
        if (!values.empty() && texts[values.back()] == text) {
            values.push_back(values.back());
            return true;
        }
        const auto found = std::find(texts.begin(), texts.end(), text);
        if (found == texts.end() && texts.size() >= kMostTexts) return false;
        values.push_back(static_cast<std::uint32_t>(found - texts.begin()));
        if (found == texts.end()) texts.emplace_back(text);
        return true;
    }
};

/// Reads one text. The first complaint stops it: each step answers false once there is an error.
class Reader {
public:
    Reader(std::string_view text, std::string_view name) : scan_(text), name_(name) {}

    Result<FileRead<BrdfRows>> read() {
        if (file() && complete() && convert() && makeRows()) return std::move(read_);
        if (!error_) fail(scan_.fault());
        return *error_;
    }

private:
    bool fail(const std::string& what) {
        if (!error_) {
            error_ = Error{ErrorKind::File,
                           "bird: " + std::string(name_) + ": line " +
                               std::to_string(scan_.line()) + ": " + what};
        }
        return false;
    }
    bool twice(std::string_view name) { return fail("'" + std::string(name) + "' is given twice"); }

    bool expect(JsonToken wanted, const std::string& what) {
        const JsonToken token = scan_.next();
        if (token == JsonToken::Bad) return false;
        return token == wanted || fail("wanted " + what);
    }

    bool file() {
        if (!expect(JsonToken::ObjectBegin, "an object with metadata and data")) return false;
        bool metadata = false, data = false;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ObjectEnd) break;
            if (token != JsonToken::Key) return false;
            const std::string name = scan_.text();
            if (name == "metadata") {
                if (std::exchange(metadata, true)) return twice(name);
                if (!readMetadata()) return false;
            } else if (name == "data") {
                if (std::exchange(data, true)) return twice(name);
                if (!readData()) return false;
            } else {
                read_.warnings.push_back("passed over " + shown(name));
                if (!scan_.skipValue()) return false;
            }
        }
        if (scan_.next() != JsonToken::End) return false;
        return data || fail("there is no data");
    }

    bool readMetadata() {
        auto metadata = readBirdMetadata(scan_);
        if (!metadata) return false;
        read_.about = std::move(metadata->about);
        symmetry_ = std::move(metadata->symmetry);
        if (metadata->leftOut > 0) {
            read_.warnings.push_back(std::to_string(metadata->leftOut) +
                                     " metadata entries too many or too long");
        }
        return true;
    }

    bool readData() {
        if (!expect(JsonToken::ObjectBegin, "an object of variables")) return false;
        std::optional<JsonScan> rows;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ObjectEnd) break;
            if (token != JsonToken::Key) return false;
            const std::string name = scan_.text();
            if (name == "variables") {
                if (!readVariables()) return false;
            } else if (name == "values") {
                rows = scan_;
                if (!scan_.skipValue()) return false;
            } else if (name == "adhoc_variables") {
                if (!readAdhoc()) return false;
            } else if (!readVariable(name, false)) {
                return false;
            }
        }
        if (!rows) return true;
        std::swap(scan_, *rows);
        if (!readRows()) return false;
        std::swap(scan_, *rows);
        return true;
    }

    bool readAdhoc() {
        if (!expect(JsonToken::ObjectBegin, "an object of adhoc variables")) return false;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ObjectEnd) return true;
            if (token != JsonToken::Key) return false;
            if (!readVariable(scan_.text(), true)) return false;
        }
    }

    /// Those of the schema do not stand among the adhoc ones, nor the other way round.
    static std::optional<Number> numberNamed(std::string_view name, bool adhoc) {
        const auto found = std::find(kNumberNames.begin(), kNumberNames.end(), name);
        const auto at = static_cast<std::size_t>(found - kNumberNames.begin());
        if (at == kNumbers || (at >= Random) != adhoc) return std::nullopt;
        return static_cast<Number>(at);
    }
    static std::optional<Word> wordNamed(std::string_view name, bool adhoc) {
        const auto found = std::find(kWordNames.begin(), kWordNames.end(), name);
        const auto at = static_cast<std::size_t>(found - kWordNames.begin());
        if (at == kWords || (at == ChannelName) != adhoc) return std::nullopt;
        return static_cast<Word>(at);
    }

    bool readVariable(const std::string& name, bool adhoc) {
        const auto number = numberNamed(name, adhoc);
        const auto word = wordNamed(name, adhoc);
        if (!number && !word) {
            read_.warnings.push_back("passed over the variable " + shown(name));
            return scan_.skipValue();
        }
        if (!expect(JsonToken::ObjectBegin, name + " as an object with unit and values")) {
            return false;
        }
        if (number && std::exchange(numbers_[*number].given, true)) return twice(name);
        if (word && std::exchange(words_[*word].given, true)) return twice(name);
        bool values = false;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ObjectEnd) break;
            if (token != JsonToken::Key) return false;
            const std::string_view key = scan_.raw();
            if (key == "values") {
                if (std::exchange(values, true)) return twice(name + ".values");
                if (!expect(JsonToken::ArrayBegin, name + ".values as an array")) return false;
                if (number ? !readNumbers(*number, adhoc) : !readWords(*word)) return false;
            } else if (key == "unit" && number) {
                if (!expect(JsonToken::String, name + ".unit as a string")) return false;
                numbers_[*number].unit = scan_.text();
            } else if (key == "comments" && number == Combined) {
                if (!expect(JsonToken::String, name + ".comments as a string")) return false;
                coverageIsSaid_ = scan_.text().find("k = 1") != std::string::npos;
            } else if (key == "uncertainty" && number == Value) {
                if (!readConstantUncertainty()) return false;
            } else if (!scan_.skipValue()) {
                return false;
            }
        }
        return values || fail(name + " has no values");
    }

    bool readNumbers(Number number, bool nulls) {
        std::vector<double>& values = numbers_[number].values;
        // Two bytes at least for each, and few files have more variables than this many.
        constexpr std::size_t kVariables = 8;
        values.reserve(scan_.bytesLeft() / (2 * kVariables) / 8);
        return scan_.numbers(values, nulls);
    }

    /// Strings, or arrays of numbers as one text: "1,-1,0,0".
    bool readWords(Word word) {
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ArrayEnd) return true;
            std::string text;
            if (token == JsonToken::String) {
                text = scan_.text();
            } else if (token == JsonToken::ArrayBegin) {
                std::vector<double> numbers;
                if (!scan_.numbers(numbers)) return false;
                for (const double n : numbers) text += (text.empty() ? "" : ",") + shortest(n);
            } else if (token == JsonToken::Bad) {
                return false;
            } else {
                return fail(std::string(kWordNames[word]) +
                            ": wanted strings or arrays of numbers");
            }
            if (!words_[word].add(text)) {
                return fail(std::string(kWordNames[word]) + ": more than " +
                            std::to_string(WordColumn::kMostTexts) + " that differ");
            }
        }
    }

    /// One uncertainty for all values, where there is no uBRDF.
    bool readConstantUncertainty() {
        if (!expect(JsonToken::ObjectBegin, "BRDF.uncertainty as an object")) return false;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ObjectEnd) return true;
            if (token != JsonToken::Key) return false;
            if (scan_.raw() == "value") {
                if (!expect(JsonToken::Number, "BRDF.uncertainty.value as a number")) return false;
                constantU_ = scan_.number();
            } else if (scan_.raw() == "unit") {
                if (!expect(JsonToken::String, "BRDF.uncertainty.unit as a string")) return false;
                constantUnit_ = scan_.text();
            } else if (!scan_.skipValue()) {
                return false;
            }
        }
    }

    // The layouts before v1.0: data.variables names the columns of the rows in data.values.
    struct OldColumn {
        std::optional<Number> number;
        std::optional<Word> word;
    };

    bool readVariables() {
        if (!columns_.empty()) return twice("variables");
        if (!expect(JsonToken::ArrayBegin, "data.variables as an array")) return false;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ArrayEnd) return true;
            if (token == JsonToken::Bad) return false;
            if (token != JsonToken::ObjectBegin) return fail("a variable is no object");
            if (!readOldVariable()) return false;
        }
    }
    bool readOldVariable() {
        std::string name, unit;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ObjectEnd) break;
            if (token != JsonToken::Key) return false;
            const std::string key = scan_.text();
            if (key != "name" && key != "unit") {
                if (!scan_.skipValue()) return false;
                continue;
            }
            if (!expect(JsonToken::String, "a variable's " + key + " as a string")) return false;
            (key == "name" ? name : unit) = scan_.text();
        }
        // Either kind: these layouts knew of no difference.
        OldColumn column{numberNamed(name, false), wordNamed(name, false)};
        if (!column.number && name == "wavelength") column.number = WavelengthI;
        if (!column.number) column.number = numberNamed(name, true);
        if (!column.number && !column.word) {
            read_.warnings.push_back("passed over the variable " + shown(name));
        }
        if (column.number) {
            NumberColumn& into = numbers_[*column.number];
            if (std::exchange(into.given, true)) return twice(name);
            into.unit = unit;
        }
        if (column.word && std::exchange(words_[*column.word].given, true)) return twice(name);
        columns_.push_back(column);
        return true;
    }
    bool readRows() {
        if (columns_.empty()) return fail("data.values without data.variables");
        if (!expect(JsonToken::ArrayBegin, "data.values as an array of rows")) return false;
        for (;;) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ArrayEnd) return true;
            if (token == JsonToken::Bad) return false;
            if (token != JsonToken::ArrayBegin) return fail("a row of data.values is no array");
            if (!readRow()) return false;
        }
    }
    bool readRow() {
        std::size_t at = 0;
        for (;; ++at) {
            const JsonToken token = scan_.next();
            if (token == JsonToken::ArrayEnd) break;
            if (token == JsonToken::Bad) return false;
            if (at == columns_.size()) return fail("a row has more values than variables");
            if (!addOld(columns_[at], token)) return false;
        }
        return at == columns_.size() || fail(std::to_string(at) + " values in a row, there are " +
                                             std::to_string(columns_.size()) + " variables");
    }
    bool addOld(const OldColumn& column, JsonToken token) {
        if (column.number) {
            double number = scan_.number();
            if (token == JsonToken::String) {  // the first files wrote "1.5"
                const auto parsed = parseDouble(scan_.text());
                if (!parsed) return fail(shown(scan_.raw()) + ", wanted a number");
                number = *parsed;
            } else if (token != JsonToken::Number) {
                return fail("wanted a number");
            }
            numbers_[*column.number].values.push_back(number);
            return true;
        }
        if (token == JsonToken::ObjectBegin || token == JsonToken::ArrayBegin) {
            return scan_.skipRest();
        }
        if (column.word && !words_[*column.word].add(scan_.text())) {
            return fail("too many texts that differ");
        }
        return true;
    }

    [[nodiscard]] const std::vector<double>& of(Number number) const {
        return numbers_[number].values;
    }
    [[nodiscard]] bool has(Number number) const { return numbers_[number].given; }

    bool complete() {
        for (const Number number : {ThetaI, PhiI, ThetaR, PhiR, Value}) {
            if (!has(number)) return fail("there is no " + std::string(kNumberNames[number]));
        }
        entries_ = of(Value).size();
        const auto fits = [&](std::string_view name, std::size_t size) {
            return size == entries_ || fail(std::string(name) + ": " + std::to_string(size) +
                                            " values, BRDF has " + std::to_string(entries_));
        };
        for (std::size_t i = 0; i < kNumbers; ++i) {
            if (numbers_[i].given && !fits(kNumberNames[i], numbers_[i].values.size())) {
                return false;
            }
        }
        for (std::size_t i = 0; i < kWords; ++i) {
            if (words_[i].given && !fits(kWordNames[i], words_[i].values.size())) return false;
        }
        return entries_ > 0 || fail("BRDF has no values");
    }

    bool unitOf(Number number, std::initializer_list<std::string_view> known) {
        const std::string& unit = numbers_[number].unit;
        if (std::find(known.begin(), known.end(), unit) != known.end()) return true;
        std::string wanted;
        for (const std::string_view one : known) {
            wanted += (wanted.empty() ? "" : ", ") + std::string(one);
        }
        return fail(std::string(kNumberNames[number]) + ": unit " + shown(unit) + ", wanted " +
                    printable(wanted));
    }

    /// Angles to radians, wavelengths to nanometres, uncertainties to 1/sr.
    bool convert() {
        for (const Number number : {ThetaI, PhiI, ThetaR, PhiR}) {
            if (!unitOf(number, {"deg", "rad", "\xC2\xB0"})) return false;
            if (!toRadians(number)) return false;
        }
        for (const Number number : {WavelengthI, WavelengthR}) {
            // Both letters that look like a Greek mu.
            if (!has(number)) continue;
            if (!unitOf(number, {"nm", "\xCE\xBCm", "\xC2\xB5m", "um"})) return false;
            const double scale = numbers_[number].unit == "nm" ? 1 : 1000;
            for (double& one : numbers_[number].values) {
                one *= scale;
                if (one < 0) return fail(std::string(kNumberNames[number]) + ": " + shortest(one));
            }
        }
        if (!unitOf(Value, {"sr^-1", "1/sr", "sr-1"})) return false;
        return addNegative() && convertUncertainty() && checkFlags();
    }
    bool toRadians(Number number) {
        const bool radians = numbers_[number].unit == "rad";
        const bool theta = number == ThetaI || number == ThetaR;
        const double most = radians ? kPi + 1e-5 : 180;
        for (double& one : numbers_[number].values) {
            if (theta && (one < 0 || one > most)) {
                return fail(std::string(kNumberNames[number]) + ": " + shortest(one) +
                            ", wanted [0, 180] degrees");
            }
            if (!radians) one = Radians::fromDegrees(one).value();
        }
        return true;
    }
    bool addNegative() {
        std::vector<double>& f = numbers_[Value].values;
        if (has(Negative)) {
            for (std::size_t i = 0; i < entries_; ++i) {
                if (of(Negative)[i] < 0) f[i] += of(Negative)[i];
            }
        }
        const auto below = std::count_if(f.begin(), f.end(), [](double one) { return one < 0; });
        if (below > 0) read_.warnings.push_back(std::to_string(below) + " negative values");
        return true;
    }
    bool convertUncertainty() {
        if (!has(Combined) && constantU_) {
            numbers_[Combined] = {true, constantUnit_, std::vector(entries_, *constantU_)};
        }
        if (!has(Combined)) return true;
        if (!unitOf(Combined, {"sr^-1", "1/sr", "sr-1", "%"})) return false;
        std::vector<double>& u = numbers_[Combined].values;
        for (std::size_t i = 0; i < entries_; ++i) {
            if (u[i] < 0) return fail("uBRDF: " + shortest(u[i]) + ", wanted 0 or more");
            if (numbers_[Combined].unit == "%") u[i] *= std::abs(of(Value)[i]) / 100;
        }
        if (!coverageIsSaid_) {
            read_.warnings.emplace_back("uBRDF taken as standard uncertainty (k = 1): not said");
        }
        return true;
    }
    bool checkFlags() {
        for (const double mask : of(FlagMask)) {
            if (!(mask >= 0 && mask < 1 << kFlagCount && mask == std::floor(mask))) {
                return fail("flags: " + shortest(mask) + ", wanted a mask of " +
                            std::to_string(kFlagCount) + " flags");
            }
        }
        return true;
    }

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
        for (std::size_t i = 0; i < entries_; ++i) {
            Label label;
            if (has(wavelength)) label.nm = of(wavelength)[i];
            for (std::size_t w = 0; w < kWords; ++w) {
                if (words_[w].given) label.words[w] = words_[w].values[i];
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
            return words_[w].given ? words_[w].texts[words[w]] : std::string();
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
        if (pairs.firstOf.size() > kSparsest * entries_ / rows.channels.size() + 1) {
            return fail(std::to_string(entries_) + " values at " +
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
        if (!symmetry_.empty()) {
            return symmetry_.find("isotropic") != std::string::npos &&
                   symmetry_.find("anisotropic") == std::string::npos;
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
            for (std::size_t i = 0; i < entries_; ++i) {
                into[rows.index(pairs.pairOf[i], channelOf_[i])] = of(from)[i];
            }
            numbers_[from].values = {};
        };
        place(rows.f, Value);
        place(rows.uRandom, split ? Random : Combined);
        if (split) place(rows.uSystematic, Systematic);
        if (!has(FlagMask)) return;
        rows.flags.assign(values, Flags{});
        for (std::size_t i = 0; i < entries_; ++i) {
            rows.flags[rows.index(pairs.pairOf[i], channelOf_[i])] =
                Flags::fromMask(static_cast<std::uint32_t>(of(FlagMask)[i]));
        }
    }

    JsonScan scan_;
    std::string_view name_;
    FileRead<BrdfRows> read_;
    std::string symmetry_;
    std::array<NumberColumn, kNumbers> numbers_;
    std::array<WordColumn, kWords> words_;
    std::vector<OldColumn> columns_;
    std::optional<double> constantU_;
    std::string constantUnit_;
    bool coverageIsSaid_ = false;
    std::size_t entries_ = 0;
    std::vector<std::uint32_t> channelOf_;
    std::optional<Error> error_;
};

}  // namespace

Result<FileRead<BrdfRows>> parseBird(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

}  // namespace gonio::proc
