// An equation's key leads to its paper: every [Key1994] in the sources stands in
// docs/references.md.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

std::set<std::string> keysIn(const std::string& text, const std::regex& pattern) {
    std::set<std::string> keys;
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) {
        keys.insert((*it)[1]);
    }
    return keys;
}

const std::regex kCitation(R"(\[([A-Z][A-Za-z]+[12][0-9]{3})(?=[\],;]))");
const std::regex kEntry(R"(\| ([A-Z][A-Za-z]+[12][0-9]{3}) \|)");

TEST(References, HoldEveryKeyOfTheSources) {
    const fs::path root = GONIO_SOURCE_DIR;
    const auto known = keysIn(textOf(root / "docs/references.md"), kEntry);
    EXPECT_GE(known.size(), 5U);
    for (const char* top : {"proc", "driver", "sim", "daemon"}) {
        if (!fs::exists(root / top)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            for (const std::string& key : keysIn(textOf(entry.path()), kCitation)) {
                EXPECT_TRUE(known.contains(key))
                    << fs::relative(entry.path(), root).string() << " cites " << key
                    << ", which has no row in docs/references.md";
            }
        }
    }
}

TEST(References, AreSeenWithAndWithoutAnEquation) {
    const auto keys = keysIn("// [Walter2007, eq. 33]; [Heitz2014] [i] [Seen 2014]", kCitation);
    EXPECT_EQ(keys, (std::set<std::string>{"Heitz2014", "Walter2007"}));
}

}  // namespace
