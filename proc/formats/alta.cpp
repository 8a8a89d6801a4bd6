#include "proc/formats/alta.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include "proc/core/coordinates.h"
#include "proc/core/number_text.h"
#include "proc/core/quantities.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/foreign_keywords.h"
#include "proc/formats/row_notes.h"
#include "proc/formats/shown.h"
#include "proc/formats/text_lines.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kForeign = "alta.";
/// What the reader itself understands.
constexpr std::array<std::string_view, 5> kOwnKeywords{
    "dim", "vs", "param_in", "param_out", "sample"};
using Numbers = std::span<const double>;

Direction at(double theta, double phi) {
    return fileDirection(fromFileRadians(theta), Radians(phi));
}

std::optional<LightView> fromProjected(Numbers n) {
    return LightView{.in = at(n[0], 0), .out = at(std::hypot(n[1], n[2]), std::atan2(n[2], n[1]))};
}
std::optional<LightView> fromDifference(Numbers n) {
    return LightView{.in = at(n[1], n[2]), .out = at(n[0], 0)};
}
std::optional<LightView> fromSpherical(Numbers n) {
    return LightView{.in = at(n[0], n[1]), .out = at(n[2], n[3])};
}
/// Ours counts the difference vector from the light, theirs from the view.
std::optional<LightView> fromHalf(double thetaH, double phiH, double thetaD, double phiD) {
    const LightView swapped =
        fromHalfDifference({Radians(thetaH), Radians(phiH), Radians(thetaD), Radians(phiD)});
    return LightView{.in = swapped.out, .out = swapped.in};
}
std::optional<LightView> fromIsotropicHalf(Numbers n) { return fromHalf(n[0], 0, n[1], n[2]); }
std::optional<LightView> fromWholeHalf(Numbers n) { return fromHalf(n[0], n[1], n[2], n[3]); }
std::optional<LightView> fromVectors(Numbers n) {
    const auto out = Direction::fromVector({n[0], n[1], n[2]});
    const auto in = Direction::fromVector({n[3], n[4], n[5]});
    if (!in || !out) return std::nullopt;
    return LightView{.in = *in, .out = *out};
}

struct InputForm {
    std::string_view name;
    std::size_t numbers;
    bool isotropic;
    std::optional<LightView> (*pair)(Numbers);
    /// Places of the polar angles, as bits.
    unsigned thetas;
};
constexpr std::array<InputForm, 6> kInputs{{
    {"ISOTROPIC_TL_TV_PROJ_DPHI", 3, true, fromProjected, 1},
    {"ISOTROPIC_TV_TL_DPHI", 3, true, fromDifference, 3},
    {"SPHERICAL_TL_PL_TV_PV", 4, false, fromSpherical, 5},
    {"RUSIN_TH_TD_PD", 3, true, fromIsotropicHalf, 3},
    {"RUSIN_TH_PH_TD_PD", 4, false, fromWholeHalf, 5},
    {"CARTESIAN", 6, false, fromVectors, 0},
}};

struct OutputForm {
    std::string_view name;
    bool cosine;
    std::string_view channels;  ///< a letter each; empty: one without a name
};
constexpr std::array<OutputForm, 4> kOutputs{{
    {"INV_STERADIAN", false, ""},
    {"INV_STERADIAN_COSINE_FACTOR", true, ""},
    {"RGB_COLOR", false, "RGB"},
    {"XYZ_COLOR", false, "XYZ"},
}};

template <class Forms>
auto* formNamed(const Forms& forms, std::string_view name) {
    const auto found = std::find_if(
        forms.begin(), forms.end(), [&](const auto& form) { return form.name == name; });
    return found == forms.end() ? nullptr : &*found;
}

template <class Forms>
std::string namesOf(const Forms& forms) {
    std::string list;
    for (const auto& form : forms) list += (list.empty() ? "" : ", ") + std::string(form.name);
    return list;
}

class Reader {
public:
    Reader(std::string_view text, std::string_view name) : lines_(text), name_(name) {}

    Result<FileRead<BrdfRows>> read() {
        std::vector<std::string_view> words;
        while (const auto line = lines_.next()) {
            const std::string_view content = trimmed(*line);
            if (content.empty()) continue;
            if (content.front() == '#') {
                if (!headerLine(content.substr(1))) return *error_;
                continue;
            }
            if (columns_ == 0 && !begin()) return *error_;
            words = wordsIn(content, std::move(words));
            if (!row(words)) return *error_;
        }
        if (!end()) return *error_;
        return std::move(read_);
    }

private:
    bool fail(const std::string& what) {
        error_ = Error{ErrorKind::File,
                       "alta: " + std::string(name_) + ": line " + std::to_string(lines_.number()) +
                           ": " + what};
        return false;
    }
    bool keepComment(std::string_view line) {
        return comments_.add(line) ||
               fail("more than " + std::to_string(CommentLines::kMost) + " comments");
    }

    bool headerLine(std::string_view line) {
        const bool free = line.starts_with(' ') || line.empty();  // "# text" is a comment
        const std::size_t size = std::min(line.find_first_of(" \t"), line.size());
        const std::string_view keyword = line.substr(0, size);
        const std::string_view value = trimmed(line.substr(size));
        if (free) {
            return keepComment(line.empty() ? line : line.substr(1));
        }
        if (columns_ > 0) return fail("the keyword " + shown(keyword) + " among the rows");
        const std::string known = lower(keyword);
        if (!keys_.insert(known).second) return fail(shown(keyword) + " is given twice");
        if (known == "dim") return dimensions(value);
        if (known == "param_in") return parametrisation(kInputs, input_, keyword, value);
        if (known == "param_out") return parametrisation(kOutputs, output_, keyword, value);
        if (known == "vs") {
            const bool none = value.find_first_not_of("0 \t") == std::string_view::npos;
            return none || fail("VS " + shown(value) + ": intervals of values are not read");
        }
        keep(keyword, value);
        return true;
    }
    template <class Forms, class Form>
    bool parametrisation(const Forms& forms,
                         const Form*& form,
                         std::string_view keyword,
                         std::string_view value) {
        form = formNamed(forms, value);
        return form != nullptr ||
               fail(std::string(keyword) + " " + shown(value) + ", known are " + namesOf(forms));
    }
    bool dimensions(std::string_view value) {
        const std::vector<std::string_view> words = wordsIn(value);
        const auto columns = [&](std::size_t i) -> std::size_t {  // 0: none
            constexpr std::int64_t kMost = 1000;
            const std::int64_t n = parseInteger(words[i]).value_or(0);
            return n < 1 || n > kMost ? 0 : static_cast<std::size_t>(n);
        };
        const bool two = words.size() == 2;
        inputs_ = two ? columns(0) : 0;
        outputs_ = two ? columns(1) : 0;
        return (inputs_ > 0 && outputs_ > 0) ||
               fail("DIM " + shown(value) + ", wanted two numbers of columns");
    }
    void keep(std::string_view keyword, std::string_view value) {
        const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
        if (quoted) value = value.substr(1, value.size() - 2);
        if (lower(keyword) == "sample") {
            read_.about.set(key::kSample, std::string(value));
        } else {
            read_.about.set(std::string(kForeign) + std::string(keyword), std::string(value));
        }
    }

    bool begin() {
        if (input_ == nullptr) return fail("no PARAM_IN, known are " + namesOf(kInputs));
        if (output_ == nullptr) return fail("no PARAM_OUT, known are " + namesOf(kOutputs));
        if (inputs_ == 0) return fail("no DIM");
        if (inputs_ != input_->numbers) {
            return fail("DIM has " + std::to_string(inputs_) + " coordinates, " +
                        std::string(input_->name) + " has " + std::to_string(input_->numbers));
        }
        if (!output_->channels.empty() && outputs_ != output_->channels.size()) {
            return fail("DIM has " + std::to_string(outputs_) + " values, " +
                        std::string(output_->name) + " has 3");
        }
        for (const char letter : output_->channels) {
            rows().channels.push_back({std::string(1, letter), std::nullopt});
        }
        rows().channels.resize(outputs_);
        columns_ = inputs_ + outputs_;
        return true;
    }

    bool row(const std::vector<std::string_view>& words) {
        if (words.size() != columns_) {
            return fail(std::to_string(words.size()) + " numbers, DIM promised " +
                        std::to_string(columns_));
        }
        numbers_.clear();
        for (const std::string_view word : words) {
            const auto number = parseDouble(word);
            if (!number) return fail(shown(word) + ", wanted a number");
            numbers_.push_back(*number);
        }
        for (std::size_t i = 0; i < inputs_; ++i) {
            const bool theta = (input_->thetas >> i & 1) != 0;
            if (theta && (numbers_[i] < 0 || numbers_[i] > kPi + 1e-5)) {
                return fail("a theta of " + shown(words[i]) + ", wanted radians in [0, pi]");
            }
        }
        const auto pair = input_->pair(Numbers(numbers_).first(inputs_));
        if (!pair) return fail("a direction has no length");
        rows().pairs.push_back(*pair);
        for (const double value : Numbers(numbers_).subspan(inputs_)) addValue(value);
        return true;
    }
    void addValue(double value) {
        if (output_->cosine) {
            value = toBrdf(Ars(value), std::abs(rows().pairs.back().out.z())).value();
            if (std::isnan(value)) ++atHorizon_;
        }
        rows().f.push_back(value);
    }

    bool end() {
        if (rows().pairs.empty()) return fail("no row of numbers");
        Metadata told = metadataOfLines(comments_.all());
        for (auto& [name, value] : told.values) read_.about.set(name, std::move(value));
        read_.about.comments = std::move(told.comments);
        takeRowNotes(read_.about, rows());
        nameChannels();
        if (input_->isotropic) rows().isotropic = true;
        if (output_->cosine) read_.about.set(key::kCosine, "yes");
        read_.warnings = negativeValues(rows());
        if (atHorizon_ > 0) {
            read_.warnings.push_back(std::to_string(atHorizon_) +
                                     " values at the horizon, where f cos(theta_o) tells no f");
        }
        return true;
    }

    /// Values that nothing names are numbered, one alone is not.
    void nameChannels() {
        for (std::size_t i = 0; i < outputs_ && outputs_ > 1; ++i) {
            Channel& channel = rows().channels[i];
            if (channel == Channel{}) channel.name = "value " + std::to_string(i + 1);
        }
    }

    BrdfRows& rows() { return read_.content; }

    TextLines lines_;
    std::string_view name_;
    FileRead<BrdfRows> read_;
    std::set<std::string> keys_;
    CommentLines comments_;
    const InputForm* input_ = nullptr;
    const OutputForm* output_ = nullptr;
    std::size_t inputs_ = 0, outputs_ = 0, columns_ = 0;
    std::vector<double> numbers_;
    std::size_t atHorizon_ = 0;
    std::optional<Error> error_;
};

class Writer {
public:
    Writer(const BrdfRows& rows, const Metadata& about)
        : rows_(rows), about_(about), projected_(canProject()) {}

    Result<Written> write() {
        header();
        std::size_t count = 0, missing = 0, beside = 0;
        const std::size_t channels = rows_.channels.size();
        for (std::size_t pair = 0; pair < rows_.pairs.size(); ++pair) {
            std::size_t there = 0;
            for (std::size_t c = 0; c < channels; ++c) {
                there += std::isfinite(rows_.f[rows_.index(pair, c)]) ? 1U : 0U;
            }
            if (there < channels) {
                missing += channels - there;
                beside += there;
                continue;
            }
            ++count;
            coordinates(rows_.pairs[pair]);
            for (std::size_t c = 0; c < channels; ++c) put(rows_.f[rows_.index(pair, c)]);
            text_.back() = '\n';
        }
        if (count == 0 || channels == 0) return noWholeRow("alta");
        Written written{.bytes = std::move(text_), .loss = {}};
        written.loss.add(Loss::Masked, "missing values, left out", missing);
        written.loss.add(Loss::Dropped, "values beside a missing one, left out with it", beside);
        countDroppedColumns(rows_, written.loss);
        written.loss.add(Loss::Dropped, "names of channels", lostNames());
        return written;
    }

private:
    [[nodiscard]] std::size_t lostNames() const {
        if (outputName() != kOutputs[0].name) return 0;
        std::size_t lost = 0;
        for (std::size_t i = 0; i < rows_.channels.size(); ++i) {
            const std::string& name = rows_.channels[i].name;
            const bool comesBack = name.empty() || name == "value " + std::to_string(i + 1);
            lost += comesBack ? 0U : 1U;
        }
        return lost;
    }

    /// The isotropic form has no azimuth of the light.
    [[nodiscard]] bool canProject() const {
        return rows_.isotropic &&
               std::all_of(rows_.pairs.begin(), rows_.pairs.end(), [](const LightView& pair) {
                   return pair.in.x() >= 0 && std::abs(pair.in.y()) < 1e-12;
               });
    }
    void put(double number) {
        appendShortest(text_, number);
        text_ += ' ';
    }
    void coordinates(const LightView& pair) {
        const double theta = pair.out.theta().value();
        put(fileRadians(pair.in.theta().value()));
        if (projected_) {
            put(fileRadians(theta * cos(pair.out.phi())));
            put(fileRadians(theta * sin(pair.out.phi())));
        } else {
            put(fileRadians(pair.in.phi().value()));
            put(fileRadians(theta));
            put(fileRadians(pair.out.phi().value()));
        }
    }

    [[nodiscard]] std::string_view outputName() const {
        std::string letters;
        for (const Channel& channel : rows_.channels) letters += channel.name + " ";
        if (letters == "R G B ") return kOutputs[2].name;
        if (letters == "X Y Z ") return kOutputs[3].name;
        return kOutputs[0].name;
    }
    void line(std::string_view keyword, std::string_view value) {
        text_ += "#" + std::string(keyword) + " " + onOneLine(trimmed(value)) + "\n";
    }
    void header() {
        const std::string_view output = outputName();
        Metadata rest = withRowNotes(about_, rows_, true);
        // The isotropic form says what the azimuths cannot.
        if (projected_) rest.values.erase("symmetry");
        if (!about_.at(key::kSample).empty()) {
            line("SAMPLE", "\"" + std::string(about_.at(key::kSample)) + "\"");
        }
        for (const auto& [keyword, value] : takeForeignKeywords(rest, kForeign, kOwnKeywords)) {
            line(keyword, "\"" + value + "\"");
        }
        for (const std::string& comment : metadataLines(rest)) {
            text_ += "# " + onOneLine(comment) + "\n";
        }
        const std::size_t inputs = projected_ ? 3 : 4;
        line("DIM", std::to_string(inputs) + " " + std::to_string(rows_.channels.size()));
        line("VS", "0");
        line("PARAM_IN", projected_ ? "ISOTROPIC_TL_TV_PROJ_DPHI" : "SPHERICAL_TL_PL_TV_PV");
        line("PARAM_OUT", output);
    }

    const BrdfRows& rows_;
    const Metadata& about_;
    bool projected_;
    std::string text_;
};

}  // namespace

Result<FileRead<BrdfRows>> parseAlta(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

Result<Written> writeAlta(const BrdfRows& rows, const Metadata& about) {
    return Writer(rows, about).write();
}

}  // namespace gonio::proc
