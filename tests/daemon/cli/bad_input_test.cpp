// Bad input gets one clear line, the right exit code, in under a second and 100 MiB.

#include <algorithm>

#include "tests/daemon/cli/running_daemon.h"

namespace gonio {
namespace {

using test::Ran;

constexpr int kUsage = 2, kNoRig = 3, kBusy = 4, kFile = 6, kQuality = 7;

constexpr double kMebibytes = 100;
constexpr double kSeconds = 1;

/// One line on stderr that says all of `words`, nothing on stdout.
void expectRefused(const Ran& ran, int exitCode, const std::vector<std::string>& words) {
    EXPECT_EQ(ran.exitCode, exitCode) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    for (const std::string& word : words) {
        EXPECT_NE(ran.err.find(word), std::string::npos) << word << " is not in: " << ran.err;
    }
    EXPECT_EQ(ran.out, "");
    EXPECT_LT(ran.seconds, kSeconds);
    EXPECT_LT(ran.mebibytes, kMebibytes);
}

const std::string kRealFile = GONIO_SOURCE_DIR "/config/demo/AnoBlackEC1onAlum.bsdf";

class BadInput : public testing::Test {
protected:
    test::Program gonio;
    std::string file(const std::string& name, const std::string& text) {
        test::writeText(gonio / name, text);
        return (gonio / name).string();
    }
};

/// With a daemon on the simulated rig.
class BadInputAtDaemon : public BadInput {
protected:
    test::RunningDaemon daemon{gonio};
};

TEST_F(BadInput, MissingFileIsNamedByEveryCommandOnFiles) {
    const std::string missing = (gonio / "none.bsdf").string();
    const std::string points = file("points.csv", "theta_i,phi_i,theta_o,phi_o\n0,0,10,0\n");
    expectRefused(gonio({"info", missing}), kFile, {missing, "no such file"});
    expectRefused(gonio({"eval", missing, "--points", points}), kFile, {missing});
    expectRefused(gonio({"convert", missing, (gonio / "o.csv").string()}), kFile, {missing});
    expectRefused(gonio({"plot", missing}), kFile, {missing});
    expectRefused(gonio({"sim", "score", missing}), kFile, {missing});
    expectRefused(gonio({"eval", kRealFile, "--points", missing}), kFile, {missing});
}

TEST_F(BadInput, FitsSayWhatIsWanted) {
    const std::string plain = file("plain.csv", "theta_i,phi_i,theta_o,phi_o\n0,0,10,0\n");
    expectRefused(
        gonio({"fit", kRealFile, "--models", "banana"}), kUsage, {"banana", "lambert+ggx"});
    expectRefused(gonio({"fit", kRealFile, "--weights", "heavy"}), kUsage, {"heavy", "cosine"});
    expectRefused(gonio({"fit", kRealFile, "--robust", "huber:0"}), kUsage, {"huber:0"});
    expectRefused(gonio({"fit", kRealFile, "--assume", "-5%"}), kUsage, {"-5%"});
    expectRefused(gonio({"fit", "model:lambert,albedo=0.5"}), kUsage, {"a formula already"});
    expectRefused(gonio({"fit", plain}), kFile, {plain, "f_r"});
    expectRefused(gonio({"fit", (gonio / "none.csv").string()}), kFile, {"none.csv"});
}

TEST_F(BadInput, FolderIsNotAFile) {
    expectRefused(gonio({"info", (gonio / ".").string()}), kFile, {"not a file"});
}

TEST_F(BadInput, TruncatedBsdfIsRefusedWithItsLine) {
    const std::string whole = test::textOf(kRealFile);
    for (const double share : {0.1, 0.5, 0.9, 0.999}) {
        const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
        const std::string cut = file("cut.bsdf", whole.substr(0, size));
        expectRefused(gonio({"info", cut}), kFile, {cut, "line "});
    }
}

TEST_F(BadInput, BananaIsNoNumber) {
    std::string text = test::textOf(kRealFile);
    const std::size_t data = text.find("TIS");
    ASSERT_NE(data, std::string::npos);
    text.insert(text.find('\n', data) + 1, "banana ");
    const std::string bsdf = file("banana.bsdf", text);
    expectRefused(gonio({"info", bsdf}), kFile, {bsdf, "line ", "'banana'"});
    const std::string points = file("points.csv", "theta_i,phi_i,theta_o,phi_o\n0,0,banana,0\n");
    expectRefused(gonio({"eval", kRealFile, "--points", points}),
                  kFile,
                  {points, "line 2", "theta_o", "'banana'"});
    expectRefused(gonio({"info", "model:lambert,albedo=banana"}), kUsage, {"albedo", "banana"});
    expectRefused(gonio({"sim", "place", "white", "--tilt", "banana"}), kUsage, {"banana"});
}

TEST_F(BadInput, HostileHeaderCostsNoMemory) {
    const std::string axis = " 999999999\n0 1\n";
    const std::string bsdf = file("hostile.bsdf",
                                  "Source Measured\nSymmetry PlaneSymmetrical\n"
                                  "SpectralContent Monochrome\nScatterType BRDF\n"
                                  "SampleRotation 1\n0\nAngleOfIncidence" +
                                      axis + "ScatterAzimuth" + axis + "ScatterRadial" + axis +
                                      "\nMonochrome\nDataBegin\nTIS 0\n");
    expectRefused(gonio({"info", bsdf}), kFile, {bsdf, "line ", "AngleOfIncidence"});
}

TEST_F(BadInput, HugePromiseOfSmallAxesCostsNoMemory) {
    std::string numbers;
    for (int i = 0; i < 90; ++i) numbers += std::to_string(i) + " ";
    const std::string axis = " 90\n" + numbers + "\n";
    const std::string bsdf = file("promise.bsdf",
                                  "Source Measured\nSymmetry PlaneSymmetrical\n"
                                  "SpectralContent Monochrome\nScatterType BRDF\n"
                                  "SampleRotation" +
                                      axis + "AngleOfIncidence" + axis + "ScatterAzimuth" + axis +
                                      "ScatterRadial" + axis + "\nMonochrome\nDataBegin\nTIS 0\n");
    expectRefused(gonio({"info", bsdf}), kFile, {bsdf, "promises 65610000 values"});
}

TEST_F(BadInput, UnknownModelAndParameterListWhatIsKnown) {
    expectRefused(gonio({"info", "model:lambret,albedo=0.5"}), kUsage, {"lambret", "lambert"});
    expectRefused(gonio({"info", "model:lambert,albdo=0.5"}), kUsage, {"albedo"});
    expectRefused(gonio({"info", "model:lambert,albedo=0.5,alpha=1"}), kUsage, {"alpha", "albedo"});
    expectRefused(gonio({"info", "model:lambert"}), kUsage, {"albedo", "missing"});
    expectRefused(gonio({"info", "model:lambert,albedo=1.5"}), kUsage, {"albedo=1.5", "[0, 1]"});
    expectRefused(gonio({"info", "model:ggx,alpha=0,f0=1"}), kUsage, {"alpha=0"});
    expectRefused(gonio({"info", "model:"}), kUsage, {"unknown model ''"});
}

TEST_F(BadInput, WrongCommandLinesAreUsageErrors) {
    expectRefused(gonio({}), kUsage, {"--help"});
    expectRefused(gonio({"mesure"}), kUsage, {"mesure"});
    expectRefused(gonio({"info"}), kUsage, {"file"});
    expectRefused(gonio({"info", kRealFile, "--colour"}), kUsage, {"--colour"});
    expectRefused(gonio({"measure", "x", "--effort", "heroic"}), kUsage, {"heroic", "draft"});
    expectRefused(gonio({"plan", "--target-uncertainty", "1"}), kUsage, {"--target-uncert", "1%"});
    expectRefused(gonio({"plan", "--target-uncertainty", "0%"}), kUsage, {"0%"});
    expectRefused(gonio({"plan", "--time-budget", "soon"}), kUsage, {"--time-budget", "5s"});
    expectRefused(gonio({"plan", "--time-budget", "-1s"}), kUsage, {"-1 s", "above 0"});
    expectRefused(gonio({"plan", "--time-budget", "2s", "--effort", "draft"}),
                  kUsage,
                  {"exclude each other"});
    expectRefused(gonio({"measure", "../x"}), kUsage, {"../x"});
    for (const std::string rotation : {"361", "-360.5", "nan", "north"}) {
        expectRefused(gonio({"measure", "x", "--rotation=" + rotation}), kUsage, {"rotation"});
    }
    expectRefused(gonio({"merge", "a.gonio", "-o", "out.bsdf"}), kUsage, {"OUT.gonio or OUT.csv"});
    expectRefused(gonio({"merge", "a.gonio"}), kUsage, {"--output"});
    expectRefused(gonio({"merge", "none.gonio", "-o", "out.gonio"}), kFile, {"none.gonio"});
    expectRefused(
        gonio({"merge", "model:lambert,albedo=0.5", "-o", "o.csv"}), kUsage, {"lambert", "files"});
    expectRefused(gonio({"info", "sample:../../etc/passwd"}), kFile, {"there is none"});
    expectRefused(gonio({"verify-white", "--limit", "0.5"}), kUsage, {"--limit", "1%"});
    expectRefused(gonio({"export", kRealFile, "-o", "x", "--formats", "doc"}), kUsage, {"doc"});
}

TEST_F(BadInput, UnknownFormatsAreNamed) {
    const std::string out = (gonio / "o.xyz").string();
    expectRefused(gonio({"convert", kRealFile, out}), kUsage, {"o.xyz", "--to"});
    expectRefused(gonio({"convert", kRealFile, (gonio / "o.csv").string(), "--half"}),
                  kUsage,
                  {"--half", "exr-tiles"});
    const std::string rgl = file("rgl.bsdf", std::string("tensor_file\0\1\0", 14));
    expectRefused(gonio({"info", rgl}), kFile, {rgl, "rgl: ", "fields"});
    const std::string noise = file("noise.gonio", "this is no OpenEXR file");
    expectRefused(gonio({"info", noise}), kFile, {noise, "not an OpenEXR file"});
}

TEST_F(BadInput, OutputThatCannotBeWrittenIsNamed) {
    const std::string nowhere = (gonio / "no/such/folder/o.bsdf").string();
    const Ran ran = gonio({"convert", kRealFile, nowhere, "-q"});
    expectRefused(ran, kFile, {nowhere});
}

TEST_F(BadInputAtDaemon, MeasuringBeforeCalibratingSaysWhatToRun) {
    ASSERT_EQ(gonio({"sim", "place", "model:lambert,albedo=0.5", "-q"}).exitCode, 0);
    expectRefused(gonio({"measure", "x"}), kQuality, {"gonio calibrate mirror"});
    expectRefused(gonio({"calibrate", "white"}), kQuality, {"gonio sim place white"});
    expectRefused(gonio({"calibrate", "black"}), kQuality, {"gonio sim place black"});
    expectRefused(gonio({"calibrate", "mirror"}), kQuality, {"gonio sim place mirror"});
    expectRefused(gonio({"verify-white"}), kQuality, {"gonio sim place white"});
}

TEST_F(BadInputAtDaemon, PlacementsThatMakeNoSenseAreRefusedBeforeTheyAreKept) {
    const std::string missing = (gonio / "none.bsdf").string();
    expectRefused(gonio({"sim", "place", "black", "--turned", "30"}), kUsage, {"only the white"});
    expectRefused(gonio({"sim", "place", missing}), kFile, {missing});
    expectRefused(gonio({"sim", "place", "sample:none"}), kFile, {"sample:none"});
    expectRefused(gonio({"sim", "place", "model:lambret"}), kUsage, {"lambret"});
    expectRefused(gonio({"sim", "place", "white", "--systematic", "some"}), kUsage, {"some"});
    for (const std::string tilt : {"nan", "inf", "-90"}) {
        expectRefused(gonio({"sim", "place", "mirror", "--tilt=" + tilt}), kUsage, {"tilt"});
    }
    expectRefused(gonio({"sim", "place", "white", "--tilt", "5"}), kUsage, {"only the mirror"});
    expectRefused(gonio({"sim", "place", "white", "--seed=-1"}), kUsage, {"--seed"});
    for (const std::string serial : {"", "a b", "0123456789012345678901234567890123"}) {
        expectRefused(gonio({"sim", "place", "white", "--serial=" + serial}), kUsage, {"serial"});
    }
    EXPECT_FALSE(std::filesystem::exists(gonio / "store/sim.json"));
    const Ran turned = gonio({"--json", "sim", "place", "white", "--turned", "30"});
    EXPECT_EQ(turned.exitCode, 0) << turned.err;
    EXPECT_NE(turned.out.find("\"turned_deg\": 30"), std::string::npos) << turned.out;
}

TEST_F(BadInputAtDaemon, SessionsAndJobsThatAreNotThereAreSaid) {
    expectRefused(gonio({"session", "close"}), kUsage, {"gonio session new"});
    ASSERT_EQ(gonio({"session", "new", "one", "-q"}).exitCode, 0);
    expectRefused(gonio({"session", "new", "two"}), kUsage, {"'one' is open"});
    ASSERT_EQ(gonio({"session", "close", "-q"}).exitCode, 0);
    expectRefused(gonio({"session", "new", "one"}), kUsage, {"'one'", "was used"});
    expectRefused(gonio({"jobs", "cancel"}), kUsage, {"no job is running"});
}

TEST_F(BadInput, WithoutADaemonItIsSaidHowToStartOne) {
    const std::string socket = (gonio / "store/goniod.sock").string();
    const std::vector<std::vector<std::string>> commands{{"status"},
                                                         {"rigs"},
                                                         {"samples"},
                                                         {"jobs"},
                                                         {"watch"},
                                                         {"measure", "x"},
                                                         {"calibrate", "white"},
                                                         {"verify-white"},
                                                         {"session", "list"},
                                                         {"sim", "place", "white"}};
    for (const auto& command : commands) {
        expectRefused(gonio(command), kNoRig, {socket, "goniod --rig sim"});
    }
}

TEST_F(BadInputAtDaemon, ASecondDaemonOnTheStoreOrTheSocketIsRefused) {
    expectRefused(gonio.daemon({"--rig", "sim"}), kBusy, {"another goniod", "store"});
    const test::Program other;
    const std::string socket = (gonio / "store/goniod.sock").string();
    expectRefused(other.daemon({"--rig", "sim", "--socket", socket}), kBusy, {socket});
    EXPECT_EQ(gonio({"status", "-q"}).exitCode, 0);  // the first serves on
}

TEST_F(BadInput, CommentThatIsNoUtf8IsShownAllTheSame) {
    const std::string latin = file("latin.bsdf", "# 20 \xB0 C\n" + test::textOf(kRealFile));
    const Ran plain = gonio({"info", latin});
    EXPECT_EQ(plain.exitCode, 0) << plain.err;
    EXPECT_EQ(gonio({"info", latin, "--json"}).exitCode, 0);
    EXPECT_EQ(gonio({"convert", latin, (gonio / "out.bsdf").string()}).exitCode, 0);
    EXPECT_NE(test::textOf(gonio / "out.bsdf").find("20 \xB0 C"), std::string::npos);
}

TEST_F(BadInput, DaemonRefusesWhatItCannotBeTold) {
    expectRefused(gonio.daemon({}), kUsage, {"--rig sim"});
    expectRefused(gonio.daemon({"--rig", "usb3"}), kUsage, {"usb3", "usb:SERIAL"});
    expectRefused(gonio.daemon({"--rig", "sim", "--socket", "/" + std::string(200, 'x')}),
                  kUsage,
                  {"--socket", "107 bytes"});
    expectRefused(gonio.daemon({"--rig", "usb", "--faults", "f"}), kUsage, {"--faults", "sim"});
    const std::string faults = file("faults", "at 1s explode\n");
    expectRefused(
        gonio.daemon({"--rig", "sim", "--faults", faults}), kFile, {faults, "line 1", "explode"});
    expectRefused(gonio.daemon({"--rig", "sim", "--record", faults}),
                  kFile,
                  {faults, "no recording", "another file"});
    const std::string config = file("goniod.toml", "schema = \"gonio/goniod/1\"\nrigs = \"sim\"\n");
    expectRefused(gonio.daemon({"--config", config}), kFile, {config, "'rigs'"});
}

TEST_F(BadInput, BrokenStoreIsNamed) {
    std::filesystem::create_directories(gonio / "store");
    test::writeText(gonio / "store/sim.json", "{\"schema\":\"gonio/sim/1\",\"serial\":7}");
    expectRefused(gonio.daemon({"--rig", "sim"}), kFile, {"sim.json"});
}

TEST_F(BadInput, BrokenProfileIsNamedWithItsKey) {
    const std::string profile = file("rig.toml",
                                     "schema = \"gonio/rig/1\"\nname = \"x\"\n[camera]\nusb = "
                                     "2\n[sensor]\nelectrons_per_dn = -1\n");
    expectRefused(gonio.daemon({"--rig", "sim", "--profile", profile}),
                  kFile,
                  {profile, "sensor.electrons_per_dn"});
    const std::string torn = file("torn.toml", "name = \n");
    expectRefused(gonio.daemon({"--rig", "sim", "--profile", torn}), kFile, {torn});
    expectRefused(gonio({"doctor", "--profile", torn}), kFile, {torn});
}

}  // namespace
}  // namespace gonio
