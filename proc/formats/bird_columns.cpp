#include "proc/formats/bird_columns.h"

#include <utility>

#include "proc/core/number_text.h"
#include "proc/formats/bird_metadata.h"
#include "proc/formats/json_scan.h"
#include "proc/formats/shown.h"

namespace gonio::proc::bird {
namespace {

/// Reads one text. The first complaint stops it: each step answers false once there is an error.
class Reader {
public:
    Reader(std::string_view text, std::string_view name) : scan_(text), name_(name) {}

    Result<Columns> read() {
        if (file()) {
            const std::string complaint = convertColumns(columns_);
            if (complaint.empty()) return std::move(columns_);
            fail(complaint);
        }
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
                columns_.warnings.push_back("passed over " + shown(name));
                if (!scan_.skipValue()) return false;
            }
        }
        if (scan_.next() != JsonToken::End) return false;
        return data || fail("there is no data");
    }

    bool readMetadata() {
        auto metadata = readBirdMetadata(scan_);
        if (!metadata) return false;
        columns_.about = std::move(metadata->about);
        columns_.symmetry = std::move(metadata->symmetry);
        if (metadata->leftOut > 0) {
            columns_.warnings.push_back(std::to_string(metadata->leftOut) +
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
            columns_.warnings.push_back("passed over the variable " + shown(name));
            return scan_.skipValue();
        }
        if (!expect(JsonToken::ObjectBegin, name + " as an object with unit and values")) {
            return false;
        }
        if (number && std::exchange(columns_.numbers[*number].given, true)) return twice(name);
        if (word && std::exchange(columns_.words[*word].given, true)) return twice(name);
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
                columns_.numbers[*number].unit = scan_.text();
            } else if (key == "comments" && number == Combined) {
                if (!expect(JsonToken::String, name + ".comments as a string")) return false;
                columns_.coverageIsSaid = scan_.text().find("k = 1") != std::string::npos;
            } else if (key == "uncertainty" && number == Value) {
                if (!readConstantUncertainty()) return false;
            } else if (!scan_.skipValue()) {
                return false;
            }
        }
        return values || fail(name + " has no values");
    }

    bool readNumbers(Number number, bool nulls) {
        std::vector<double>& values = columns_.numbers[number].values;
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
            if (!columns_.words[word].add(text)) {
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
                columns_.constantU = scan_.number();
            } else if (scan_.raw() == "unit") {
                if (!expect(JsonToken::String, "BRDF.uncertainty.unit as a string")) return false;
                columns_.constantUnit = scan_.text();
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
        if (!oldColumns_.empty()) return twice("variables");
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
            columns_.warnings.push_back("passed over the variable " + shown(name));
        }
        if (column.number) {
            NumberColumn& into = columns_.numbers[*column.number];
            if (std::exchange(into.given, true)) return twice(name);
            into.unit = unit;
        }
        if (column.word && std::exchange(columns_.words[*column.word].given, true))
            return twice(name);
        oldColumns_.push_back(column);
        return true;
    }
    bool readRows() {
        if (oldColumns_.empty()) return fail("data.values without data.variables");
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
            if (at == oldColumns_.size()) return fail("a row has more values than variables");
            if (!addOld(oldColumns_[at], token)) return false;
        }
        return at == oldColumns_.size() ||
               fail(std::to_string(at) + " values in a row, there are " +
                    std::to_string(oldColumns_.size()) + " variables");
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
            columns_.numbers[*column.number].values.push_back(number);
            return true;
        }
        if (token == JsonToken::ObjectBegin || token == JsonToken::ArrayBegin) {
            return scan_.skipRest();
        }
        if (column.word && !columns_.words[*column.word].add(scan_.text())) {
            return fail("too many texts that differ");
        }
        return true;
    }

    JsonScan scan_;
    std::string_view name_;
    Columns columns_;
    std::vector<OldColumn> oldColumns_;
    std::optional<Error> error_;
};

}  // namespace

Result<Columns> readColumns(std::string_view text, std::string_view name) {
    return Reader(text, name).read();
}

}  // namespace gonio::proc::bird
