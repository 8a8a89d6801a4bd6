#pragma once
// What the program says as JSON.

#include <nlohmann/json.hpp>

#include "tests/daemon/cli/program.h"
#include "tests/support/json_schema.h"

namespace gonio::test {

/// Of a command that must succeed; it conforms to its schema in docs/json.
inline nlohmann::json documentOf(const Program& program, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "--json");
    const Ran ran = program(std::move(arguments));
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    nlohmann::json json = nlohmann::json::parse(ran.out, nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << ran.out;
    EXPECT_EQ(complaintsOf(json), "") << json;
    return json;
}

}  // namespace gonio::test
