#include "sim/rig_errors.h"

#include <gtest/gtest.h>

namespace gonio::sim {
namespace {

using namespace std::chrono_literals;

RigErrors parsed(std::string_view text, const RigErrors& base = {}) {
    const auto errors = parseRigErrors(text, base);
    EXPECT_TRUE(errors) << errors.error().message;
    return errors ? *errors : RigErrors{};
}

TEST(RigErrors, NoneAndWhatIsNotSaidAreAsInTheBase) {
    const RigErrors base{.glare = 0.004, .ledDrift = 0.01, .celsius = 40};
    EXPECT_EQ(parsed("none", base), base);
    RigErrors wanted = base;
    wanted.columnNoise = 2;
    EXPECT_EQ(parsed("column_e=2", base), wanted);
    EXPECT_EQ(parsed("glare=0", base).glare, 0);
}

TEST(RigErrors, ANameWithoutASizeHasItsUsualOne) {
    EXPECT_EQ(parsed("glare").glare, 0.001);
    EXPECT_EQ(parsed("drift").ledDrift, 0.002);
    EXPECT_EQ(parsed("offset_us").exposureOffset, 200ns);
    EXPECT_EQ(parsed("prnu").nonUniformity, 0.007);
    EXPECT_EQ(parsed("column_e").columnNoise, 0.5);
    EXPECT_EQ(parsed("doubling_k").doublingKelvin, 7);
    EXPECT_EQ(parsed("inl").nonLinearity, 0.003);
    EXPECT_EQ(parsed("crosstalk").crosstalk, 0.01);
    EXPECT_EQ(parsed("source_deg").sourceDiameter, 1_deg);
    EXPECT_EQ(parsed("wedge_deg").wedges, 0.01_deg);
}

TEST(RigErrors, SizesAreAsSaid) {
    const RigErrors wanted{.glare = 0.05,
                           .ledDrift = 0.003,
                           .ledStep = {.size = -0.05, .planStep = 300},
                           .exposureOffset = -14us,
                           .nonUniformity = 0,
                           .columnNoise = 20,
                           .celsius = 80,
                           .doublingKelvin = 6,
                           .nonLinearity = -0.02,
                           .crosstalk = 0.2,
                           .sourceDiameter = 2_deg,
                           .wedges = 0.5_deg,
                           .bits = 10};
    EXPECT_EQ(
        parsed(
            "glare=0.05,drift=0.003,step=-0.05@300,offset_us=-14,prnu=0,column_e=20,"
            "celsius=80,doubling_k=6,inl=-0.02,crosstalk=0.2,source_deg=2,wedge_deg=0.5,bits=10"),
        wanted);
}

TEST(RigErrors, TypicalIsAllThatARigHasAtOnceAndWhatFollowsOverrides) {
    const RigErrors wanted{.glare = 0.001,
                           .ledDrift = 0.002,
                           .exposureOffset = 200ns,
                           .columnNoise = 0.5,
                           .nonLinearity = 0.003,
                           .crosstalk = 0,
                           .sourceDiameter = 1_deg,
                           .wedges = 0.01_deg};
    EXPECT_EQ(parsed("typical,crosstalk=0"), wanted);
}

TEST(RigErrors, BadTextIsOneUsageErrorThatNamesThePart) {
    for (const char* text :
         {"glare=0.0501", "glare=-0.001", "glare=nan",     "glare=",     "glare=1%",
          "celsius",      "celsius=81",   "bits=9",        "bits=16",    "bits=8.5",
          "bits",         "step",         "step=0.05",     "step=0.05@", "step=0.6@1",
          "step=0.05@-1", "step=@3",      "step=0.05@1.5", "blur",       "blur=1",
          "doubling_k=5", "typical=1",    "none=0",        "Glare"}) {
        const auto errors = parseRigErrors(text, {});
        ASSERT_FALSE(errors) << text;
        EXPECT_EQ(errors.error().kind, ErrorKind::Usage);
        EXPECT_NE(errors.error().message.find("'" + std::string(text) + "'"), std::string::npos)
            << errors.error().message;
    }
    for (const char* text : {"",
                             ",",
                             "glare,",
                             ",glare",
                             "glare,none",
                             "none,glare",
                             "glare,glare=0.01",
                             "glare drift"}) {
        const auto errors = parseRigErrors(text, {});
        ASSERT_FALSE(errors) << text;
        EXPECT_EQ(errors.error().kind, ErrorKind::Usage) << text;
    }
}

}  // namespace
}  // namespace gonio::sim
