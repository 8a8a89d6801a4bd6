#include "tests/faults/row.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "proc/core/number_text.h"

namespace gonio::fault_test {
namespace {

const std::filesystem::path kFolder = GONIO_FAULT_SCRIPTS;
constexpr std::array<std::string_view, 4> kVerdicts{"completed", "interrupted", "fault", "refused"};
constexpr std::array<std::string_view, 3> kRelations{"=", "<=", ">="};
constexpr std::array<std::string_view, 2> kDoors{"inproc", "umockdev"};

template <class All>
bool has(const All& all, std::string_view one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

std::string textOf(const std::string& name) {
    std::ifstream file(kFolder / (name + ".fault"));
    if (!file) throw std::runtime_error("no script " + name);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The words of one wish, each of which must be what it should.
class Wish {
public:
    Wish(const Row& row, const std::string& line) : row_(row.name), line_(line), words_(line) {}
    std::string word(const char* what) {
        std::string word;
        if (!(words_ >> word)) refuse(what);
        return word;
    }
    template <class All>
    std::string oneOf(const All& all, const char* what) {
        std::string found = word(what);
        if (!has(all, found)) refuse(what);
        return found;
    }
    std::string counter() {
        std::string name = word("a counter");
        if (!isCounter(name)) refuse("a counter");
        return name;
    }
    int number() {
        const auto value = parseInteger(word("a whole number"));
        if (!value || *value < -1'000'000 || *value > 1'000'000) refuse("a whole number");
        return static_cast<int>(*value);
    }
    Nanoseconds time() {
        const std::string text = word("a time");
        const auto number = leadingDouble(text);
        const std::string unit = number ? text.substr(number->length) : std::string();
        if ((unit != "s" && unit != "ms") || number->value <= 0) refuse("a time such as 300ms");
        return Nanoseconds(static_cast<std::int64_t>(number->value * (unit == "s" ? 1e9 : 1e6)));
    }
    std::string rest() {
        std::string text;
        words_ >> std::ws;
        if (!std::getline(words_, text)) refuse("a text");
        return text;
    }
    /// What stands behind is a remark, and not allowed but where it is.
    void end() {
        std::string word;
        if (words_ >> word) refuse("the end of the line");
    }
    [[noreturn]] void refuse(const std::string& wanted) const {
        throw std::runtime_error(row_ + ": \"" + line_ + "\": wanted " + wanted);
    }

private:
    std::string row_, line_;
    std::istringstream words_;
};

void readWaiver(Wish& wish, Row& row) {
    const std::string counter = wish.counter();
    const int more = wish.number();
    if (more == 0) wish.refuse("a difference: 0 waives nothing");
    row.waived[counter] = more;
}

void readWish(const std::string& line, Row& row) {
    Wish wish(row, line);
    const std::string kind = wish.word("a wish");
    if (kind == "says") {
        row.says.push_back(wish.rest());
        return;
    }
    if (kind == "when") {
        const std::string malformed = wish.word("what is malformed");
        if (wish.word("\"says\"") != "says") wish.refuse("\"says\"");
        row.saysWhen[malformed] = wish.rest();
        return;
    }
    if (kind == "waive") return readWaiver(wish, row);  // with its reason
    if (kind == "verdict") {
        row.verdict = wish.oneOf(kVerdicts, "completed, interrupted, fault or refused");
    } else if (kind == "count") {
        WantedCount& count = row.counts.emplace_back();
        count.name = wish.counter();
        count.relation = wish.oneOf(kRelations, "=, <= or >=");
        count.value = wish.number();
    } else if (kind == "event") {
        row.events.push_back(wish.number());
    } else if (kind == "detected") {
        row.detected = wish.time();
    } else if (kind == "reclaimed") {
        row.reclaimed = wish.time();
    } else if (kind == "noticed") {
        row.noticed = wish.time();
    } else if (kind == "only") {
        row.only = wish.oneOf(kDoors, "inproc or umockdev");
    } else {
        wish.refuse("verdict, says, when, count, event, detected, reclaimed, noticed, waive, only");
    }
    wish.end();
}

/// A row that wants something of one malformation wants something of each, and of no other.
void checkMalformations(const Row& row) {
    if (row.saysWhen.empty()) return;
    std::vector<std::string> has;
    for (const auto& rule : row.script.rules) {
        for (const auto& fault : rule.faults) {
            if (fault.kind == sim::FaultKind::Malform) has.push_back(fault.name);
        }
    }
    for (const std::string& name : has) {
        if (!row.saysWhen.contains(name))
            throw std::runtime_error(row.name + ": what is said when " + name + "?");
    }
    for (const auto& [name, text] : row.saysWhen) {
        if (std::find(has.begin(), has.end(), name) == has.end())
            throw std::runtime_error(row.name + ": nothing malforms " + name);
    }
}

}  // namespace

bool isCounter(std::string_view name) { return has(kCounters, name); }

std::vector<std::string> rowNames(const std::string& door) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        if (entry.path().extension() != ".fault") continue;
        const std::string only = readRow(entry.path().stem()).only;
        if (only.empty() || only == door) names.push_back(entry.path().stem());
    }
    std::sort(names.begin(), names.end());
    return names;
}

Row readRow(const std::string& name) { return parseRow(name, textOf(name)); }

Row parseRow(const std::string& name, const std::string& text) {
    auto script = sim::FaultScript::parse(text);
    if (!script) throw std::runtime_error(name + ": " + script.error().message);
    Row row{.name = name, .script = std::move(*script)};
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("#!")) readWish(line.substr(2), row);
    }
    if (row.verdict.empty()) throw std::runtime_error(name + ": no verdict");
    checkMalformations(row);
    return row;
}

std::vector<Row> variantsOf(const Row& row) {
    if (row.saysWhen.empty()) return {row};
    std::vector<Row> variants;
    for (const auto& [name, text] : row.saysWhen) {
        Row& variant = variants.emplace_back(row);
        for (auto& rule : variant.script.rules) {
            std::erase_if(rule.faults, [&](const sim::Fault& fault) {
                return fault.kind == sim::FaultKind::Malform && fault.name != name;
            });
        }
        std::erase_if(variant.script.rules, [](const auto& rule) { return rule.faults.empty(); });
    }
    return variants;
}

}  // namespace gonio::fault_test
