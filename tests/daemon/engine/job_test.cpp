#include "daemon/engine/job.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gonio::daemon {
namespace {

constexpr JobKind kKinds[] = {JobKind::CalibrateMirror,
                              JobKind::CalibrateBlack,
                              JobKind::CalibrateWhite,
                              JobKind::CalibrateZero,
                              JobKind::VerifyWhite,
                              JobKind::Measure,
                              JobKind::Plan,
                              JobKind::Recalibrate};

TEST(JobKind, ComesBackFromItsName) {
    for (const JobKind kind : kKinds) EXPECT_EQ(*parseJobKind(name(kind)), kind) << name(kind);
}

TEST(JobKind, UnknownNameListsAllThatThereAre) {
    for (const char* text : {"", "Measure", "calibrate", "measure "}) {
        const auto kind = parseJobKind(text);
        ASSERT_FALSE(kind) << text;
        EXPECT_EQ(kind.error().kind, ErrorKind::Usage);
        for (const JobKind known : kKinds) {
            EXPECT_NE(kind.error().message.find(name(known)), std::string::npos) << text;
        }
    }
}

TEST(JobCheck, SampleNeedsANameThatAFileCanHave) {
    const auto named = [](const std::string& name) { return check(JobRequest{.name = name}); };
    EXPECT_TRUE(named("tile-1.b_2"));
    EXPECT_TRUE(named(std::string(64, 'x')));
    for (const char* bad : {"", "../x", "a/b", ".x", "a b", "-x", "\xC3\xA9"}) {
        const auto refused = named(bad);
        ASSERT_FALSE(refused) << bad;
        EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    }
    EXPECT_FALSE(named(std::string(65, 'x')));
    EXPECT_FALSE(named(std::string("a\0b", 3)));
}

TEST(JobCheck, OthersNeedNone) {
    EXPECT_TRUE(check(JobRequest{.kind = JobKind::CalibrateMirror}));
    EXPECT_TRUE(check(JobRequest{.kind = JobKind::VerifyWhite}));
    EXPECT_FALSE(check(JobRequest{.kind = JobKind::VerifyWhite, .name = "white"}));
}

TEST(JobCheck, NotesAreAtMost4096Bytes) {
    EXPECT_TRUE(check(JobRequest{.name = "a", .notes = std::string(4096, 'n')}));
    const auto refused = check(JobRequest{.name = "a", .notes = std::string(4097, 'n')});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
}

TEST(JobCheck, OnlyASampleThatIsMeasuredHasABackingAndOneToHoldItAgainst) {
    using proc::Backing;
    EXPECT_TRUE(check(JobRequest{.name = "a", .backing = Backing::Black}));
    EXPECT_TRUE(check(JobRequest{.name = "a", .backing = Backing::White, .against = "b"}));
    for (const JobRequest& bad :
         {JobRequest{.name = "a", .against = "b"},
          JobRequest{.name = "a", .backing = Backing::White, .against = "../b"},
          JobRequest{.kind = JobKind::Recalibrate, .name = "a", .backing = Backing::White},
          JobRequest{.kind = JobKind::Recalibrate, .name = "a", .rotation = 45_deg},
          JobRequest{.kind = JobKind::CalibrateWhite, .backing = Backing::White}}) {
        const auto refused = check(bad);
        ASSERT_FALSE(refused) << bad.against;
        EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    }
}

TEST(JobCheck, LimitLiesAbove0AndAtMost1) {
    const auto limited = [](double limit) {
        return static_cast<bool>(check(JobRequest{.kind = JobKind::VerifyWhite, .limit = limit}));
    };
    EXPECT_TRUE(limited(1));
    EXPECT_TRUE(limited(std::numeric_limits<double>::denorm_min()));
    for (const double bad : {0.0,
                             -0.01,
                             std::nextafter(1.0, 2.0),
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_FALSE(limited(bad)) << bad;
    }
}

}  // namespace
}  // namespace gonio::daemon
