#include "proc/core/log.h"

#include <gtest/gtest.h>

#include <string>

namespace gonio {
namespace {

/// What reaches stderr of one message of each level, as the letters that got through.
std::string through(log::Level level) {
    testing::internal::CaptureStderr();
    log::setLevel(level);
    log::debug("<D>");
    log::info("<I>");
    log::warning("<W>");
    log::error("<E>");
    const std::string text = testing::internal::GetCapturedStderr();
    log::setLevel(log::Level::Warning);  // the default, for whoever comes next
    std::string letters;
    for (const char letter : std::string("DIWE")) {
        if (text.find(std::string("<") + letter + ">") != std::string::npos) letters += letter;
    }
    return letters;
}

TEST(Log, EachLevelLetsItsOwnAndWorseThrough) {
    EXPECT_EQ(through(log::Level::Debug), "DIWE");
    EXPECT_EQ(through(log::Level::Info), "IWE");
    EXPECT_EQ(through(log::Level::Warning), "WE");
    EXPECT_EQ(through(log::Level::Error), "E");
}

TEST(Log, NeverWritesToStdoutAndTakesBracesAsTheyAre) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    log::error("{} {0:x} %s");
    const std::string seen = testing::internal::GetCapturedStderr();
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_NE(seen.find("{} {0:x} %s"), std::string::npos);
}

}  // namespace
}  // namespace gonio
