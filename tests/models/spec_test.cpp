#include "proc/models/spec.h"

#include <gtest/gtest.h>

namespace gonio::proc {
namespace {

double green(std::string_view spec) {
    const auto model = makeModel(spec);
    EXPECT_TRUE(model) << spec;
    return (*model)->answer({Direction(), Direction()}).f[Band::G];
}

std::string complaint(std::string_view spec) {
    const auto model = makeModel(spec);
    if (model) return "";
    EXPECT_EQ(model.error().kind, ErrorKind::Usage);
    return model.error().message;
}

TEST(ModelSpec, ReadsOneValueOrThree) {
    EXPECT_DOUBLE_EQ(green("lambert,albedo=0.5"), 0.5 / kPi);
    EXPECT_DOUBLE_EQ(green("lambert,albedo=0.3/0.1/0.05"), 0.1 / kPi);
}

TEST(ModelSpec, AddsLobes) {
    EXPECT_DOUBLE_EQ(green("lambert,albedo=0.5+lambert,albedo=0.25"), 0.75 / kPi);
    EXPECT_DOUBLE_EQ(green("lambert,albedo=5e-1+lambert,albedo=0.25e+0"), 0.75 / kPi);
}

TEST(ModelSpec, RoughnessIsTheRootOfAlpha) {
    EXPECT_DOUBLE_EQ(green("ggx,roughness=0.5,f0=1"), green("ggx,alpha=0.25,f0=1"));
}

TEST(ModelSpec, NamesWhatIsWrong) {
    EXPECT_NE(complaint("phlogiston,albedo=1").find("unknown model 'phlogiston'"),
              std::string::npos);
    EXPECT_NE(complaint("lambert").find("'albedo' is missing"), std::string::npos);
    EXPECT_NE(complaint("lambert,albedo=banana").find("albedo=banana"), std::string::npos);
    EXPECT_NE(complaint("lambert,albedo=1.2").find("[0, 1]"), std::string::npos);
    EXPECT_NE(complaint("lambert,albedo=0.1/0.2").find("one value or r/g/b"), std::string::npos);
    EXPECT_NE(complaint("lambert,albedo=1,colour=3").find("unknown parameter 'colour'"),
              std::string::npos);
    EXPECT_NE(complaint("lambert,albedo").find("NAME=VALUE"), std::string::npos);
    EXPECT_NE(complaint("lambert,albedo=1,albedo=1").find("twice"), std::string::npos);
    EXPECT_NE(complaint("ggx,alpha=0,f0=1").find("alpha=0"), std::string::npos);
    EXPECT_NE(complaint("ggx,alpha=0.1,f0=1,masking=none").find("separable"), std::string::npos);
    EXPECT_NE(complaint("").find("unknown model ''"), std::string::npos);
    EXPECT_NE(complaint("lambert,albedo=1+").find("unknown model"), std::string::npos);
}

}  // namespace
}  // namespace gonio::proc
