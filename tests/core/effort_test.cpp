#include "proc/core/effort.h"

#include <gtest/gtest.h>

namespace gonio {
namespace {

TEST(EffortNames, AreThoseOfTheCommandLine) {
    EXPECT_EQ(name(Effort::Draft), "draft");
    EXPECT_EQ(name(Effort::Standard), "standard");
    EXPECT_EQ(name(Effort::Reference), "reference");
}

TEST(ParseEffort, TakesWholeWordsInSmallLettersOnly) {
    for (const char* bad : {"", "Draft", "drafts", " draft", "draft ", "stand", "2"}) {
        const auto refused = parseEffort(bad);
        ASSERT_FALSE(refused) << bad;
        EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
        EXPECT_NE(refused.error().message.find("'" + std::string(bad) + "'"), std::string::npos);
        EXPECT_NE(refused.error().message.find("draft, standard, reference"), std::string::npos);
    }
}

}  // namespace
}  // namespace gonio
