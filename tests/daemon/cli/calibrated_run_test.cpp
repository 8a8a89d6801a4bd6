// A whole laboratory session on a rig with the usual errors, with all that can be calibrated.

#include "tests/daemon/cli/lab_bench.h"
#include "tests/report/html.h"

namespace gonio {
namespace {

using test::Bench;
using test::expectAccurate;
using test::Json;
using test::Ran;

/// A report of the stored sample names its operator, and the calibrations with their ages.
void expectReported(const Bench& gonio) {
    const std::string file = gonio.program / "all.html";
    gonio({"report", "sample:all", "-o", file, "--models", "none", "--estimator", "none"});
    const std::string words = test::wordsOf(test::readHtml(test::textOf(file)));
    EXPECT_NE(words.find(" Ada "), std::string::npos);
    for (const char* row :
         {" mirror 1 ", " black 6 ", " white 7 ", " flat 4 ", " leds 3 ", " sensor 2 ", " min "})
        EXPECT_NE(words.find(row), std::string::npos) << row;
    const Ran none = gonio.program({"report", "sample:nobody"});
    EXPECT_EQ(none.exitCode, 6) << none.err;
    EXPECT_NE(none.err.find("nobody"), std::string::npos) << none.err;
}

/// What each calibration says of the rig is what was wrong with it; a sample that was measured with
/// all of them is good, and the same when it is worked out again.
TEST(CalibratedRun, WithAllThatCanBeCalibratedTheRigIsKnownAndTheSampleGood) {
    const Bench gonio;
    gonio({"sim", "place", "mirror", "--rig-errors", "typical"});
    gonio({"calibrate", "mirror"});
    gonio({"sim", "place", "white"});
    const Json sensor = gonio({"calibrate", "sensor"});
    // 2.6 electrons per DN and 2.4 of read noise; half a per cent of the gain is the bend's.
    EXPECT_NEAR(sensor["electrons_per_dn"], 2.6, 0.03) << sensor;
    EXPECT_NEAR(sensor["read_noise_electrons"], 2.4, 0.1) << sensor;
    const Json leds = gonio({"calibrate", "leds"});
    EXPECT_EQ(leds["schema"], "gonio/calibrate-leds/1");
    // They lose 0.4, 0.1 and 0.1 % in the 3 K that their board warms by.
    for (const auto& [band, perKelvin] :
         {std::pair("r", -0.00133), std::pair("g", -0.00033), std::pair("b", -0.00033)})
        EXPECT_NEAR(leds["bands"][band]["per_kelvin"], perKelvin, 1e-4) << leds;
    const Json flat = gonio({"calibrate", "flat"});
    EXPECT_EQ(flat["schema"], "gonio/calibrate-flat/1");
    EXPECT_NEAR(flat["spread"], 0.007, 0.0005) << flat;
    const Json dark = gonio({"calibrate", "dark"});
    EXPECT_EQ(dark["schema"], "gonio/calibrate-dark/1");
    EXPECT_EQ(dark["sensor_celsius"], 25);
    gonio({"sim", "place", "black"});
    gonio({"calibrate", "black"});
    gonio({"sim", "place", "white"});
    gonio({"calibrate", "white"});

    gonio({"sim",
           "place",
           "model:lambert,albedo=0.3/0.1/0.05+ggx,alpha=0.2,f0=0.04",
           "--turned",
           "-45"});
    gonio({"session", "new", "one", "--operator", "Ada"});
    const Json measured = gonio({"measure", "all", "--rotation", "-45"});
    EXPECT_EQ(measured["rotation_deg"], 315);
    EXPECT_EQ(measured["calibration"], "1+6+7+4+3+2") << "mirror, black, white, flat, leds, sensor";
    const Json info = gonio({"info", measured["file"]});
    EXPECT_EQ(info["leds"][3]["rotation_deg"], 315);
    EXPECT_EQ(gonio({"info", measured["raw"]})["about"]["rotation_deg"], "315");
    for (const auto& [name, verdict] : info["qc"].items())
        EXPECT_NE(verdict["grade"], "refused") << name << ' ' << verdict;
    expectAccurate(gonio({"sim", "score", measured["file"]})["samples"][0]);
    EXPECT_TRUE(gonio({"recalibrate", "all"})["identical"]);
    expectReported(gonio);

    // The certificate says how far directions of the white differ; turned, it shows them.
    gonio({"sim", "place", "white", "--turned", "90"});
    const Json turned = gonio({"verify-white", "--turned"});
    EXPECT_EQ(turned["schema"], "gonio/verify-white/1");
    EXPECT_NEAR(turned["texture"], 0.003, 0.0005) << turned;
}

}  // namespace
}  // namespace gonio
