#include "daemon/merging.h"

#include <gtest/gtest.h>

#include "daemon/channel_merging.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/quality/verdict.h"
#include "proc/table/rotations.h"
#include "tests/support/sample_sets.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

/// Smooth, alike on both sides of the plane of incidence; 1 % random, 2 % systematic.
MergeInput input(const std::string& name, double rotationDeg, double factor = 1) {
    proc::SampleSet set;
    set.info.name = name;
    set.info.rigSerial = "R1";
    set.info.calibrationId = "1+2+3";
    set.info.rigSeconds = 2;
    set.leds = {test::ledTable(
        20_deg, [&](Radians, const Direction& wo) { return factor * (0.2 + 0.1 * wo.x()); })};
    proc::turnTo(set, proc::rotationOf(rotationDeg));
    return {.file = name, .sample = std::move(set), .values = {}, .band = {}};
}

/// With one of its bands alone.
MergeInput bandOnly(const std::string& name, Band band) {
    MergeInput one = input(name, 0);
    for (const Band other : kBands) {
        if (other != band) one.sample->leds[0].bands[index(other)] = {};
    }
    one.band = band;
    return one;
}

void expectRefused(const std::vector<MergeInput>& inputs,
                   const MergeOptions& options,
                   const std::vector<std::string>& words) {
    const Result<Merged> done = merged(inputs, options);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().kind, ErrorKind::Usage);
    for (const std::string& word : words) {
        EXPECT_NE(done.error().message.find(word), std::string::npos) << done.error().message;
    }
}

proc::Grade gradeOf(const Merged& merged, const std::string& name) {
    for (const proc::Verdict& one : proc::readVerdicts(merged.sample.info.qcVerdicts)) {
        if (one.name == name) return one.grade;
    }
    ADD_FAILURE() << "no verdict " << name;
    return proc::Grade::NotDetermined;
}

TEST(Merging, WorksOutFromTheRotationsWhatIsAsked) {
    const std::vector<MergeInput> all{
        input("a", 0), input("b", -90), input("c", 360, 1.01), input("d", 45)};
    const Result<Merged> done = merged(all, {});
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->how, "rotations of repeats");
    ASSERT_EQ(done->sample.leds.size(), 3U);  // 0 twice, 45, 270
    EXPECT_EQ(done->sample.leds[1].rotation, 45_deg);
    EXPECT_EQ(done->sample.leds[2].rotation, 270_deg);
    ASSERT_EQ(done->checks.size(), 1U);
    EXPECT_EQ(done->checks[0].name, "repeats");
    EXPECT_EQ(done->checks[0].rotation, Radians(0));
    EXPECT_EQ(done->sample.info.rigSeconds, 8);
    EXPECT_EQ(done->sample.info.name, "a; b; c; d");
    EXPECT_EQ(gradeOf(*done, "isotropy"), proc::Grade::Ok);
    EXPECT_EQ(gradeOf(*done, "plane symmetry"), proc::Grade::Ok);
    EXPECT_EQ(gradeOf(*done, "repeats"), proc::Grade::Ok);
    EXPECT_FALSE(done->notes.empty());  // no budget

    // What was merged can be merged again, and averaged.
    const MergeInput whole{.file = "whole", .sample = done->sample, .values = {}, .band = {}};
    const Result<Merged> isotropic =
        merged({whole, input("e", 90)}, {.plane = true, .isotropic = true, .reciprocal = true});
    ASSERT_TRUE(isotropic) << isotropic.error().message;
    ASSERT_EQ(isotropic->sample.leds.size(), 1U);
    EXPECT_EQ(isotropic->sample.leds[0].rotation, Radians(0));
    EXPECT_EQ(isotropic->checks.size(), 3U);
    EXPECT_EQ(isotropic->sample.info.extra.at("averaged"), "isotropic,plane,reciprocal");
    const double u = isotropic->sample.leds[0].bands[0].uRandom[5000];
    EXPECT_LT(u, 0.45 * whole.sample->leds[1].bands[0].uRandom[5000]);  // 4 rotations, 2 sides

    // The two sides are one value by now: no average makes it better, and what was done stays.
    MergeInput sides{.file = "sides", .sample = isotropic->sample, .values = {}, .band = {}};
    expectRefused({sides}, {.plane = true}, {"'sides'", "averaged by --plane already"});
    sides.sample->info.extra["averaged"] = "plane";
    const Result<Merged> more = merged({sides}, {.reciprocal = true});
    ASSERT_TRUE(more) << more.error().message;
    EXPECT_EQ(more->sample.info.extra.at("averaged"), "plane,reciprocal");
}

/// After an average all agree: what was found before it is what the sample is judged by.
TEST(Merging, WarnsOfWhatWasAveragedThoughItWasNotAlike) {
    MergeInput skew = input("b", 90);
    for (proc::CellSamples& cells : skew.sample->leds[0].bands) {
        for (std::size_t i = 0; i < cells.size(); ++i)
            cells.f[i] *= 1 + 0.6 * proc::CellGrid::centre(i).y();
    }
    const Result<Merged> done = merged({input("a", 0), skew}, {.plane = true, .isotropic = true});
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(gradeOf(*done, "isotropy"), proc::Grade::Warned);
    EXPECT_EQ(gradeOf(*done, "plane symmetry"), proc::Grade::Warned);
}

TEST(Merging, RefusesWhatContradictsAndSaysWhatResolvesIt) {
    expectRefused({input("a", 0)}, {}, {"'a'", "one sample", "--plane"});
    expectRefused({input("a", 0), input("b", 0)}, {.isotropic = true}, {"--rotation"});
    std::vector<MergeInput> two{input("a", 0), input("b", 90)};
    two[1].sample->info.truthSpec = "model:lambert";
    expectRefused(two, {}, {"'a'", "'b'", "not one sample"});
    two[1] = input("b", 90);
    two[1].sample->info.rigSerial = "R2";
    expectRefused(two, {}, {"R1", "R2", "--any-calibration"});
    EXPECT_TRUE(merged(two, {.anyCalibration = true}));
    two[1] = input("b", 90);
    two[1].sample->info.calibrationId = "4+5+6";
    const auto other = merged(two, {});
    ASSERT_TRUE(other);
    EXPECT_EQ(other->sample.info.calibrationId, "1+2+3; 4+5+6");
    EXPECT_NE(other->notes.back().find("2 calibrations"), std::string::npos);
    expectRefused({bandOnly("a", Band::R), input("b", 0)}, {}, {"bands"});
    expectRefused({bandOnly("a", Band::R), bandOnly("b", Band::G)}, {}, {"three files", "2"});
    expectRefused({bandOnly("a", Band::R), bandOnly("b", Band::G), bandOnly("c", Band::G)},
                  {},
                  {"'b'", "'c'", "both of band g"});
}

TEST(Merging, ThreeBandsFindTheirPartnersAndEstimateWhatOneLacks) {
    std::vector<MergeInput> bands{
        bandOnly("b", Band::B), bandOnly("r", Band::R), bandOnly("g", Band::G)};
    proc::CellSamples& green = bands[2].sample->leds[0].bands[1];
    const double lost = green.f[9000];
    green.f[9000] = green.uRandom[9000] = green.uSystematic[9000] = std::nan("");
    green.flags[9000] = Flags{Flag::Saturated};
    const Result<Merged> done = merged(bands, {});
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->how, "channels");
    EXPECT_EQ((*done->channels)[1].estimated, 1U);
    EXPECT_EQ((*done->channels)[0].estimated, 0U);
    EXPECT_EQ((*done->channels)[0].missing, 0U);
    const proc::CellSamples& cells = done->sample.leds[0].bands[1];
    EXPECT_NEAR(cells.f[9000], lost, 0.01 * lost);
    EXPECT_EQ(cells.flags[9000], (Flags{Flag::Saturated, Flag::Interpolated}));
    EXPECT_GT(cells.uRandom[9000], 0);
    EXPECT_EQ(cells.f[9001], bands[2].sample->leds[0].bands[1].f[9001]);
    EXPECT_TRUE(proc::encodeGonio(done->sample));

    // They are held to what any files are, and judged by all three whatever is averaged.
    std::vector<proc::Verdict> drifted{
        {.name = "drift", .grade = proc::Grade::Warned, .figure = {}, .evidence = {}, .next = {}}};
    bands[2].sample->info.qcVerdicts = proc::verdictsText(drifted);
    const Result<Merged> sides = merged(bands, {.plane = true});
    ASSERT_TRUE(sides) << sides.error().message;
    EXPECT_EQ(gradeOf(*sides, "drift"), proc::Grade::Warned);
    bands[2].sample->info.rigSerial = "R2";
    expectRefused(bands, {}, {"R1", "R2", "--any-calibration"});
    EXPECT_TRUE(merged(bands, {.anyCalibration = true}));
}

TEST(Merging, ScatteredBandsMeetAtTheirPairs) {
    const test::TempFolder folder;
    const std::string head = "theta_i,phi_i,theta_o,phi_o,f\n";
    ASSERT_TRUE(
        proc::writeFile(folder / "paint_R.csv", head + "20,0,30,180,0.5\n20,0,32,180,-0.25\n"));
    ASSERT_TRUE(proc::writeFile(folder / "paint_G.csv",
                                "theta_i,phi_i,theta_o,phi_o,f,flags\n"
                                "20,0,30,180,0.75,1\n20,0,60,10,0.125,5\n20,0,32,180,9,3\n"));
    ASSERT_TRUE(proc::writeFile(folder / "paint-Blue.csv",
                                head + "20,0,30,180,1\n20,0,32,180,2\n20,0,30.0625,180,1.5\n"));
    const auto inputs = readMergeInputs({(folder / "paint_G.csv").string(),
                                         (folder / "paint-Blue.csv").string(),
                                         (folder / "paint_R.csv").string()},
                                        {});
    ASSERT_TRUE(inputs) << inputs.error().message;
    const Result<Merged> done = merged(*inputs, {});
    ASSERT_TRUE(done) << done.error().message;
    // 32 degrees: green was saturated, and is estimated from 30; 60 degrees: only green was there;
    // blue measured twice near 30 degrees.
    EXPECT_EQ(channelCsv(done->rows),
              "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b,flags_r,flags_g,flags_b\n"
              "20,0,30,180,0.5,0.75,1,1,1,1\n"
              "20,0,32,180,-0.25,0.75,2,1,64,1\n"
              "20,0,60,10,,0.125,,0,5,0\n"
              "20,0,30.0625,180,0.5,0.75,1.5,1,1,1\n");
    EXPECT_EQ((*done->channels)[2].partners, 3U);
    ASSERT_TRUE(proc::writeFile(folder / "paint.csv", head + "20,0,30,180,0.5\n"));
    const auto unnamed = readMergeInputs({(folder / "paint.csv").string()}, {});
    ASSERT_FALSE(unnamed);
    EXPECT_NE(unnamed.error().message.find("of which band"), std::string::npos)
        << unnamed.error().message;
}

TEST(Merging, TheSameFileTwiceCountsOnce) {
    const test::TempFolder folder;
    for (const char* name : {"a.gonio", "b.gonio"})
        ASSERT_TRUE(proc::writeGonio(folder / name, *input("a", 0).sample));
    const auto inputs =
        readMergeInputs({(folder / "a.gonio").string(), (folder / "b.gonio").string()}, {});
    ASSERT_TRUE(inputs);
    ASSERT_EQ(inputs->size(), 1U);
    expectRefused(*inputs, {}, {"one sample"});
}

}  // namespace
}  // namespace gonio::daemon
