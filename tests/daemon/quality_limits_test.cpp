#include "daemon/quality_limits.h"

#include <gtest/gtest.h>

#include <fstream>

#include "daemon/profile.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

const std::string kSchema = "schema = \"gonio/quality/1\"\n";

class QualityLimits : public testing::Test {
protected:
    Result<JudgingLimits> read(const std::string& text) {
        std::ofstream(folder / "q.toml") << kSchema << text;
        return readLimits(folder / "q.toml");
    }
    test::TempFolder folder;
};

/// All that the file can say, in its order.
std::vector<double> figuresOf(const JudgingLimits& limits) {
    const proc::QualityLimits& s = limits.sample;
    return {limits.pose.corrected.degrees(),
            limits.pose.warned.degrees(),
            limits.pose.refused.degrees(),
            limits.pose.wavy.degrees(),
            limits.lightStep,
            s.ambient.warned,
            s.ambient.refused,
            s.softness,
            s.drift,
            s.reciprocity.warned,
            s.reciprocity.refused,
            s.reciprocityChiSquare,
            s.energySure,
            s.saturation.warned,
            s.saturation.refused,
            s.translucency,
            s.translucencySure};
}

TEST_F(QualityLimits, TheUsualFileSaysWhatIsSo) {
    const auto usual = readLimits(configDirectory() / "quality" / "usual.toml");
    ASSERT_TRUE(usual) << usual.error().message;
    const std::vector<double> read = figuresOf(*usual), built = figuresOf({});
    ASSERT_EQ(read.size(), built.size());
    for (std::size_t i = 0; i < read.size(); ++i) EXPECT_NEAR(read[i], built[i], 1e-12) << i;
}

TEST_F(QualityLimits, EachKeyMovesItsLimitAndNoOther) {
    const std::vector<std::string> keys{
        "[tilt]\ncorrected_deg",
        "[tilt]\nwarned_deg",
        "[tilt]\nrefused_deg",
        "[waviness]\nrefused_deg",
        "[light]\nrefused",
        "[ambient]\nwarned",
        "[ambient]\nrefused",
        "[softness]\nrefused",
        "[drift]\nwarned",
        "[reciprocity]\nwarned",
        "[reciprocity]\nrefused",
        "[reciprocity]\nchi_square",
        "[energy]\nrefused_u",
        "[saturation]\nwarned",
        "[saturation]\nrefused",
        "[translucency]\nrefused",
        "[translucency]\nrefused_u",
    };
    const std::vector<double> built = figuresOf({});
    ASSERT_EQ(keys.size(), built.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const double moved = built[i] == 0 ? 0.001 : 0.9 * built[i];
        const auto limits = read(keys[i] + " = " + std::to_string(moved) + "\n");
        ASSERT_TRUE(limits) << limits.error().message;
        const std::vector<double> found = figuresOf(*limits);
        for (std::size_t j = 0; j < found.size(); ++j)
            EXPECT_NEAR(found[j], j == i ? moved : built[j], 1e-6) << keys[i] << ' ' << j;
    }
}

TEST_F(QualityLimits, RefusesWhatItDoesNotKnowOrCannotBe) {
    const auto refused = [&](const std::string& text, const std::string& key) {
        const auto limits = read(text);
        EXPECT_FALSE(limits) << text;
        if (limits) return;
        EXPECT_EQ(limits.error().kind, ErrorKind::File);
        EXPECT_NE(limits.error().message.find("q.toml"), std::string::npos);
        EXPECT_NE(limits.error().message.find("'" + key + "'"), std::string::npos)
            << limits.error().message;
    };
    refused("[tilt]\nwarned = 1\n", "tilt.warned");
    refused("[tilts]\nwarned_deg = 1\n", "tilts.warned_deg");
    refused("[tilt]\nwarned_deg = 6\n", "tilt.warned_deg");
    refused("[tilt]\nrefused_deg = 9\n", "tilt.refused_deg");
    refused("[tilt]\ncorrected_deg = 0.5\nwarned_deg = 0.3\nrefused_deg = 0.4\n",
            "tilt.corrected_deg");
    refused("[ambient]\nwarned = 2\n", "ambient.warned");
    refused("[ambient]\nwarned = -1\n", "ambient.warned");
    refused("[drift]\nwarned = 0\n", "drift.warned");
    refused("[drift]\nwarned = nan\n", "drift.warned");
    refused("[drift]\nwarned = \"much\"\n", "drift.warned");
}

TEST_F(QualityLimits, ARigProfileGoesByTheFileThatItNames) {
    const auto usual = readProfile(defaultProfile());
    ASSERT_TRUE(usual) << usual.error().message;
    std::ifstream in(defaultProfile());
    std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string named = "limits = \"quality/usual.toml\"";
    const std::size_t at = text.find(named);
    ASSERT_NE(at, std::string::npos);
    ASSERT_TRUE(read("[drift]\nwarned = 0.003\n"));
    text.replace(at, named.size(), "limits = \"" + (folder / "q.toml").string() + "\"");
    std::ofstream(folder / "rig.toml") << text;
    const auto strict = readProfile(folder / "rig.toml");
    ASSERT_TRUE(strict) << strict.error().message;
    EXPECT_EQ(strict->quality.sample.drift, 0.003);
    EXPECT_EQ(usual->quality.sample.drift, 0.015);
    EXPECT_EQ(usual->quality.name, "usual");
    EXPECT_EQ(strict->quality.name, "q");
    EXPECT_EQ(strict->hash, usual->hash) << "no calibration depends on them";
    const std::size_t section = text.find("\n[quality]");
    ASSERT_NE(section, std::string::npos);
    std::ofstream(folder / "rig.toml") << text.substr(0, section);
    EXPECT_EQ(readProfile(folder / "rig.toml")->hash, usual->hash);
    std::ofstream(folder / "rig.toml") << text;
    ASSERT_FALSE(read("[drift]\nwarned = 0\n"));
    const auto bad = readProfile(folder / "rig.toml");
    ASSERT_FALSE(bad);
    EXPECT_NE(bad.error().message.find("rig.toml"), std::string::npos) << bad.error().message;
    EXPECT_NE(bad.error().message.find("drift.warned"), std::string::npos) << bad.error().message;
}

}  // namespace
}  // namespace gonio::daemon
