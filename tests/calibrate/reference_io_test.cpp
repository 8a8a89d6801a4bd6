#include "proc/calibrate/reference_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace gonio::proc {
namespace {

const std::string kHeader = "theta_i,theta_o,phi_o,f_r,f_g,f_b\n";

std::string refusal(const std::string& text) {
    const auto table = parseReference(text);
    if (table) return "read";
    EXPECT_EQ(table.error().kind, ErrorKind::File);
    return table.error().message;
}

TEST(ReferenceFile, CommentsAreTheCertificate) {
    const auto table = parseReference(
        "# name: tile 7\n"
        "#licence:CC-BY-4.0\n"
        "# citation: A: B, 2020 \n"
        "# u_common: 0\n"
        "# u_per_direction: 2.5e-3\n"
        "# colour: ignored\n"
        "# a remark without a key\n" +
        kHeader + "0,0,0,1,1,1\n# u_common: 0.25\n");
    ASSERT_TRUE(table) << table.error().message;
    const Certificate& certificate = table->certificate();
    EXPECT_EQ(certificate.name, "tile 7");
    EXPECT_EQ(certificate.licence, "CC-BY-4.0");
    EXPECT_EQ(certificate.citation, "A: B, 2020");
    EXPECT_EQ(certificate.uPerDirection, 2.5e-3);
    EXPECT_EQ(certificate.uCommon, 0.25);  // the last one counts
}

TEST(ReferenceFile, UncertaintiesAreFractions) {
    for (const char* bad : {"", "1", "-0.001", "0.5 %", "nan", "inf"}) {
        EXPECT_EQ(
            refusal("# u_common: " + std::string(bad) + "\n" + kHeader).find("line 1: u_common"),
            0U)
            << bad;
    }
    EXPECT_EQ(refusal("\n# u_per_direction: 2\n" + kHeader).find("line 2: u_per_direction"), 0U);
}

TEST(ReferenceFile, ATableWithoutItsColumnsIsRefused) {
    EXPECT_NE(refusal("0,0,0,1,1,1\n").find("line 1: wanted theta_i"), std::string::npos);
    EXPECT_NE(refusal(kHeader), "read");  // and so is one without rows
}

TEST(ReferenceFile, ValuesAreFiniteAndAboveZero) {
    EXPECT_EQ(refusal(kHeader + "0,0,0,1,1,1\n"), "read");
    for (const char* bad : {"nan", "inf", "0", "-1", "1e999", "0x10", "1 2"}) {
        EXPECT_NE(refusal(kHeader + "0,0,0," + bad + ",1,1\n"), "read") << bad;
    }
}

TEST(ReferenceFile, EveryIncidenceIsAFullGrid) {
    const std::string grid = "0,0,0,1,1,1\n0,0,90,1,1,1\n0,10,0,1,1,1\n";
    EXPECT_NE(refusal(kHeader + grid), "read");  // one node short
    EXPECT_EQ(refusal(kHeader + grid + "0,10,90,1,1,1\n"), "read");
    EXPECT_NE(refusal(kHeader + grid + "0,10,90,1,1,1\n0,10,90,2,2,2\n"), "read");  // one twice
    EXPECT_NE(refusal(kHeader + "0,0,0,1,1,1\n0,0,0,1,1,1\n"), "read");
}

TEST(ReferenceFile, IncidencesMayHaveGridsOfTheirOwn) {
    const auto table =
        parseReference(kHeader + "20,0,0,2,2,2\n0,0,0,1,1,1\n0,10,0,1,1,1\n0,20,0,1,1,1");
    ASSERT_TRUE(table) << table.error().message;
    ASSERT_EQ(table->planes().size(), 2U);
    EXPECT_EQ(table->planes()[0].theta.size(), 3U);  // by ascending incidence
    EXPECT_EQ(table->planes()[1].theta.size(), 1U);
}

TEST(ReferenceFile, AFaultInAFileNamesFileAndLine) {
    const auto file = std::filesystem::path(testing::TempDir()) / "gonio_reference_io_test.csv";
    std::ofstream(file) << kHeader << "0,0,0,1,1,1\n0,10,0,1,1\n";
    const auto broken = readReference(file);
    std::ofstream(file) << kHeader << "0,0,0,1,2,3\n";
    const auto sound = readReference(file);
    std::filesystem::remove(file);
    ASSERT_FALSE(broken);
    EXPECT_EQ(broken.error().message.find(file.string() + ": line 3: "), 0U);
    ASSERT_TRUE(sound) << sound.error().message;
    EXPECT_EQ(sound->planes()[0].f[0], (LedBands{{1, 2, 3}}));
}

TEST(ReferenceFile, AFolderIsNoFile) {
    const auto refused = readReference(testing::TempDir());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::File);
}

}  // namespace
}  // namespace gonio::proc
