#include "daemon/sample_quality.h"

#include <gtest/gtest.h>

#include "proc/table/rotations.h"

namespace gonio::daemon {
namespace {

TEST(SampleQuality, ASampleIsHeldAgainstOneOfTheSameRotationAlone) {
    proc::SampleSet other;
    other.info.name = "on-black";
    other.info.extra["backing"] = "black";
    other.leds = {{.incidence = 20_deg, .rotation = proc::rotationOf(-45), .bands = {}}};
    BackingEvidence evidence{
        .backing = proc::Backing::White, .other = other, .rotation = proc::rotationOf(315)};
    EXPECT_TRUE(checkOther(evidence));
    evidence.rotation = Radians();
    const Result<void> refused = checkOther(evidence);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    for (const char* word : {"'on-black'", "rotation 315 degrees, not 0", "--rotation 315"}) {
        EXPECT_NE(refused.error().message.find(word), std::string::npos) << refused.error().message;
    }
}

}  // namespace
}  // namespace gonio::daemon
