#include "proc/table/metadata.h"

#include <gtest/gtest.h>

namespace gonio::proc {
namespace {

SampleInfo fullInfo() {
    SampleInfo info;
    info.name = "EC1: \\n is no line end";
    info.rigSerial = "MD2-0001";
    info.calibrationId = "10+11+12";
    info.operatorNotes = "two\nlines";
    info.budgetJson = R"({"a": "b\\c"})";
    info.rigSeconds = 2.5;
    info.requestedUncertainty = 0.01;
    info.interruptions = 2;
    info.extra["key"] = "value";
    return info;
}

TEST(Metadata, OfASampleComesBackWhole) {
    EXPECT_EQ(infoOf(metadataOf(fullInfo())), fullInfo());
    EXPECT_EQ(infoOf(metadataOf(SampleInfo{})), SampleInfo{});
}

TEST(Metadata, SurvivesAsLinesOfText) {
    Metadata about = metadataOf(fullInfo());
    about.comments = {"free text", "", "key: value"};
    const auto lines = metadataLines(about);
    for (const std::string& line : lines) EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_EQ(metadataOfLines(lines), about);
}

TEST(Metadata, KeepsCommentsInASampleInTheirOrder) {
    Metadata about;
    for (int i = 0; i < 12; ++i) about.comments.push_back("line " + std::to_string(i));
    EXPECT_EQ(metadataOf(infoOf(about)), about);
}

TEST(Metadata, KeepsTheNamesOfKeysThatASampleHasNoMemberFor) {
    Metadata about;
    about.set(key::kSolidAngle, "0.001");
    about.set("bird.method", "goniometer");
    about.set(key::kRig, "MD2-0001");
    EXPECT_EQ(metadataOf(infoOf(about)), about);
}

TEST(Metadata, TellsAnExtraFromTheMemberOfItsName) {
    SampleInfo info = fullInfo();
    info.extra["rig"] = "simulated";
    info.extra["interruptions"] = "many";
    info.extra["extra.rig"] = "twice";
    EXPECT_EQ(metadataOf(info).at("extra.rig"), "simulated");
    EXPECT_EQ(metadataOf(info).at(key::kRig), "MD2-0001");
    EXPECT_EQ(infoOf(metadataOf(info)), info);
}

TEST(Metadata, HaveNoLineOfTheCosineOfAFileThatWasRead) {
    Metadata about;
    about.set(key::kCosine, "yes");
    EXPECT_TRUE(metadataLines(about).empty());
    const std::vector<std::string> said{"gonio.cosine: yes"};
    EXPECT_EQ(metadataOfLines(said), Metadata{});
}

}  // namespace
}  // namespace gonio::proc
