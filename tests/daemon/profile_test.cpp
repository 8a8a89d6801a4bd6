#include "daemon/profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "daemon/references.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

constexpr std::string_view kGood = R"(schema = "gonio/rig/1"
name = "bench"
[camera]
usb = 3
[sensor]
electrons_per_dn = 2.6
read_noise_electrons = 2.4
dark_electrons_per_second = 3
full_scale_dn = 4095
[mirror]
wedge_u_deg = 0.01
[led]
drift_relative = 0.002
[bracket]
exposures_us = [320, 20, 80]
dim_levels = [0.0025, 0.05]
[references]
white = "references/white-ptfe.csv"
black_reflectance = 0.001
black_relative_uncertainty = 0.10
)";

class Profile : public testing::Test {
protected:
    test::TempFolder folder;
    Result<RigProfile> read(std::string_view text) {
        std::ofstream(folder / "rig.toml") << text;
        return readProfile(folder / "rig.toml");
    }
    static std::string without(std::string_view line) {
        std::string text(kGood);
        const std::size_t at = text.find(line);
        EXPECT_NE(at, std::string::npos) << line;
        text.erase(at, text.find('\n', at) - at);
        return text;
    }
};

TEST_F(Profile, SortsItsLadders) {
    const auto profile = read(kGood);
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_EQ(profile->name, "bench");
    EXPECT_EQ(profile->exposures,
              (std::vector{Microseconds(20), Microseconds(80), Microseconds(320)}));
    EXPECT_EQ(profile->dimLevels, (std::vector{0.05, 0.0025}));
    EXPECT_EQ(profile->cameraUsb, 3);
    EXPECT_EQ(profile->ledDrift, 0.002);
    EXPECT_EQ(profile->noise.electronsPerDn, 2.6);
    EXPECT_EQ(profile->blackReflectance, 0.001);
}

TEST_F(Profile, HashFollowsTheBytes) {
    const auto one = read(kGood);
    const auto two = read(std::string(kGood) + "# a comment\n");
    ASSERT_TRUE(one && two);
    EXPECT_EQ(one->hash.size(), 8U);
    EXPECT_NE(one->hash, two->hash);
    EXPECT_EQ(read(kGood)->hash, one->hash);
}

TEST_F(Profile, EveryKeyIsAskedForByName) {
    for (const std::string key : {"schema",
                                  "name",
                                  "usb",
                                  "electrons_per_dn",
                                  "read_noise_electrons",
                                  "dark_electrons_per_second",
                                  "full_scale_dn",
                                  "wedge_u_deg",
                                  "drift_relative",
                                  "exposures_us",
                                  "dim_levels",
                                  "white",
                                  "black_reflectance",
                                  "black_relative_uncertainty"}) {
        const auto profile = read(without(key));
        ASSERT_FALSE(profile) << key;
        EXPECT_EQ(profile.error().kind, ErrorKind::File);
        EXPECT_NE(profile.error().message.find(key + "'"), std::string::npos)
            << profile.error().message;
    }
}

TEST_F(Profile, ALightTrapIsKnownTo1eMinus5UnlessTheFileSaysOtherwise) {
    EXPECT_EQ(read(kGood)->zeroUncertainty, 1e-5);
    std::string text(kGood);
    const std::size_t at = text.find("black_reflectance");
    ASSERT_NE(at, std::string::npos);
    text.insert(at, "zero_uncertainty_per_sr = 3e-6\n");
    const auto profile = read(text);
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_EQ(profile->zeroUncertainty, 3e-6);
    text.replace(text.find("3e-6"), 4, "0.0");
    EXPECT_NE(read(text).error().message.find("zero_uncertainty_per_sr"), std::string::npos);
}

TEST_F(Profile, AnLedWarmsUpForTwoSecondsUnlessTheFileSaysOtherwise) {
    EXPECT_EQ(read(kGood)->warmUp, Seconds(2));
    std::string text(kGood);
    const std::size_t at = text.find("drift_relative");
    ASSERT_NE(at, std::string::npos);
    text.insert(at, "warm_up_s = 0\n");
    const auto none = read(text);
    ASSERT_TRUE(none) << none.error().message;
    EXPECT_EQ(none->warmUp, Seconds(0));
    text.replace(text.find("warm_up_s = 0"), 13, "warm_up_s = -1");
    EXPECT_NE(read(text).error().message.find("warm_up_s"), std::string::npos);
}

TEST_F(Profile, RefusesAnotherSchemaAndSaysWhichItSaw) {
    std::string text = without("schema");
    text.insert(0, "schema = \"gonio/rig/2\"\n");
    const auto newer = read(text);
    ASSERT_FALSE(newer);
    EXPECT_EQ(newer.error().kind, ErrorKind::File);
    EXPECT_NE(newer.error().message.find("wanted \"gonio/rig/1\", saw \"gonio/rig/2\""),
              std::string::npos)
        << newer.error().message;
    EXPECT_NE(read(without("schema")).error().message.find("it is missing"), std::string::npos);
}

TEST_F(Profile, ACameraSpeaksUsb2OrUsb3) {
    for (const std::string bad : {"usb = 1", "usb = 4", "usb = \"3\"", "usb = 3.5"}) {
        std::string text = without("usb");
        text.insert(text.find("[camera]\n") + 9, bad + "\n");
        const auto profile = read(text);
        ASSERT_FALSE(profile) << bad;
        EXPECT_NE(profile.error().message.find("'camera.usb': wanted 2 or 3"), std::string::npos)
            << profile.error().message;
    }
}

TEST_F(Profile, LedDriftIsAFractionAndMayBeNone) {
    const auto with = [&](const std::string& value) {
        std::string text = without("drift_relative");
        text.insert(text.find("[led]\n") + 6, "drift_relative = " + value + "\n");
        return read(text);
    };
    EXPECT_EQ(with("0.0")->ledDrift, 0);
    for (const std::string bad : {"-0.001", "1.0", "nan", "\"0.002\""}) {
        const auto profile = with(bad);
        ASSERT_FALSE(profile) << bad;
        EXPECT_NE(profile.error().message.find("'led.drift_relative'"), std::string::npos)
            << profile.error().message;
    }
}

TEST_F(Profile, RefusesWhatIsOutOfItsDomain) {
    for (const std::string bad : {"exposures_us = [20, -80]",
                                  "exposures_us = []",
                                  "exposures_us = [20, \"80\"]",
                                  "exposures_us = [20.5]",
                                  "exposures_us = [20, 20]",
                                  "dim_levels = [1.5]",
                                  "dim_levels = [1]"}) {
        const std::string key = bad.substr(0, bad.find(' '));
        std::string text = without(key);
        text.insert(text.find("[bracket]\n") + 10, bad + "\n");
        const auto profile = read(text);
        ASSERT_FALSE(profile) << bad;
        EXPECT_NE(profile.error().message.find(key), std::string::npos) << profile.error().message;
    }
}

TEST(RigProfile, DefaultIsGoodAndItsReferencesOpen) {
    const auto profile = readProfile(defaultProfile());
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_TRUE(std::is_sorted(profile->exposures.begin(), profile->exposures.end()));
    const auto references = loadReferences();
    ASSERT_TRUE(references) << references.error().message;
    // The certified white is PTFE: within a few per cent of 1/pi at normal incidence, 45 degrees.
    const LightView pair{.in = Direction(), .out = Direction::fromSpherical(45_deg, 90_deg)};
    EXPECT_NEAR(references->white->answer(pair).f[Band::G] * kPi, 1, 0.05);
    EXPECT_NEAR(references->black->answer(pair).f[Band::G] * kPi, 0.001, 1e-12);
    EXPECT_EQ(references->white->certificate().uCommon, 0.005);
    EXPECT_EQ(references->white->certificate().uPerDirection, 0.003);
    EXPECT_EQ(references->black->certificate().uCommon, 0.10);
}

TEST(RigProfile, TheUsb3RigDiffersInItsCamera) {
    const auto usb2 = readProfile(configDirectory() / "rigs" / "minidiff-usb2.toml");
    const auto usb3 = readProfile(configDirectory() / "rigs" / "minidiff-usb3.toml");
    ASSERT_TRUE(usb2) << usb2.error().message;
    ASSERT_TRUE(usb3) << usb3.error().message;
    EXPECT_EQ(usb2->cameraUsb, 2);
    EXPECT_EQ(usb3->cameraUsb, 3);
    EXPECT_EQ(usb2->exposures, usb3->exposures);
    EXPECT_EQ(usb2->noise.fullScaleDn, usb3->noise.fullScaleDn);
}

TEST(RigProfile, RigsOfFewerBitsCountTheSameElectronsInLargerSteps) {
    const auto twelve = readProfile(configDirectory() / "rigs" / "minidiff-usb2.toml");
    ASSERT_TRUE(twelve) << twelve.error().message;
    for (const int bits : {8, 10}) {
        const std::string file = "minidiff-usb2-" + std::to_string(bits) + "bit.toml";
        const auto fewer = readProfile(configDirectory() / "rigs" / file);
        ASSERT_TRUE(fewer) << fewer.error().message;
        EXPECT_EQ(fewer->noise.fullScaleDn, (1 << bits) - 1);
        EXPECT_NEAR(fewer->noise.electronsPerDn * (1 << bits),
                    twelve->noise.electronsPerDn * (1 << 12),
                    1e-9);
        EXPECT_EQ(fewer->noise.readNoiseElectrons, twelve->noise.readNoiseElectrons);
        EXPECT_EQ(fewer->exposures, twelve->exposures);
    }
}

TEST_F(Profile, WhiteWithoutATableIsAnOpenFallback) {
    const auto profile = read(without("white") + "\nwhite = \"1/pi\"\n");
    ASSERT_TRUE(profile) << profile.error().message;
    const auto references = loadReferences(*profile);
    ASSERT_TRUE(references) << references.error().message;
    const LightView pair{.in = Direction::fromSpherical(60_deg, 0_deg), .out = Direction()};
    EXPECT_DOUBLE_EQ(references->white->answer(pair).f[Band::B], 1 / kPi);
    EXPECT_EQ(references->white->certificate().uCommon, 0.15);
    EXPECT_NE(references->white->certificate().citation.find("without a table"), std::string::npos);
}

TEST(References, MissingWhiteIsNamed) {
    RigProfile profile;
    profile.whiteReference = "/no/such/white.csv";
    const auto references = loadReferences(profile);
    ASSERT_FALSE(references);
    EXPECT_EQ(references.error().kind, ErrorKind::File);
    EXPECT_NE(references.error().message.find("/no/such/white.csv"), std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
