#include "tests/faults/row.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace gonio::fault_test {
namespace {

const std::filesystem::path kFolder = GONIO_FAULT_SCRIPTS;

std::string textOf(const std::string& name) {
    std::ifstream file(kFolder / (name + ".fault"));
    if (!file) throw std::runtime_error("no script " + name);
    return {std::istreambuf_iterator<char>(file), {}};
}

void readWish(std::istringstream& line, Row& row) {
    std::string word;
    line >> word >> std::ws;
    if (word == "verdict") {
        line >> row.verdict;
    } else if (word == "says") {
        std::getline(line, row.says.emplace_back());
    } else if (word == "count") {
        WantedCount& count = row.counts.emplace_back();
        line >> count.name >> count.relation >> count.value;
    } else if (word == "event") {
        line >> row.events.emplace_back();
    } else if (word == "waive") {
        line >> row.waived.emplace_back();
    } else if (word == "detected") {
        int milliseconds = 0;
        line >> milliseconds;
        row.detected = std::chrono::milliseconds(milliseconds);
    } else if (word == "seeds") {
        line >> row.seeds;
    } else {
        throw std::runtime_error(row.name + ": " + word + " is no wish");
    }
    if (line.fail()) throw std::runtime_error(row.name + ": " + word + " lacks something");
}

}  // namespace

std::vector<std::string> rowNames() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        if (entry.path().extension() == ".fault") names.push_back(entry.path().stem());
    }
    std::sort(names.begin(), names.end());
    return names;
}

Row readRow(const std::string& name) {
    const std::string text = textOf(name);
    auto script = sim::FaultScript::parse(text);
    if (!script) throw std::runtime_error(name + ": " + script.error().message);
    Row row{.name = name, .script = std::move(*script)};
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("#!")) continue;
        std::istringstream words(line.substr(2));
        readWish(words, row);
    }
    if (row.verdict.empty()) throw std::runtime_error(name + ": no verdict");
    return row;
}

}  // namespace gonio::fault_test
