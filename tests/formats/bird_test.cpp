#include "proc/formats/bird.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/formats/refusal.h"
#include "tests/formats/row_lists.h"
#include "tests/formats/small_files.h"

namespace gonio::proc {
namespace {

using test::expectSameRows;
using test::refuses;
using test::replaced;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Two pairs, two wavelengths, as a laboratory writes them.
std::string smallBird() {
    return R"({
 "metadata": {
  "schema": "https://example.org/schema",
  "id": "https://example.org/file",
  "type": "BRDF",
  "timestamp": "2022-01-14T12:00:00+02:00",
  "provenance": {"organization": "A laboratory", "email": "a@example.org"},
  "description": "Two pairs.",
  "method": "measurement",
  "instrumentation": {"name": "gonio", "detection_system": {
   "name": "d", "sensors": [{"name": "photodiode"}],
   "solid_angle": {"value": 0.002, "unit": "sr"}}},
  "software": {"name": "LabView", "version": "2.4"},
  "sample": {"name": "tile", "properties_symmetry": "isotropic"},
  "environment": {"temperature": {"value": 23.2, "unit": "°C"}}
 },
 "data": {
  "wavelength_i": {"unit": "nm", "values": [550, 650, 550, 650]},
  "theta_i": {"unit": "°", "values": [45, 45, 45, 45]},
  "phi_i": {"unit": "deg", "values": [0, 0, 0, 0]},
  "theta_r": {"values": [10, 10, 20, 20], "unit": "deg"},
  "phi_r": {"unit": "deg", "values": [60, 60, 300, 300]},
  "BRDF": {"unit": "1/sr", "values": [0.25, 0.26, 0.5, 0.51]},
  "uBRDF": {"unit": "%", "values": [1, 1, 2, 2]}
 }
}
)";
}

FileRead<BrdfRows> parsed(const std::string& text) {
    auto read = parseBird(text, "in.brdf");
    EXPECT_TRUE(read) << read.error().message;
    return read ? std::move(*read) : FileRead<BrdfRows>{};
}
std::string written(const FileRead<BrdfRows>& read) {
    return writeBird(read.content, read.about)->bytes;
}

TEST(Bird, ReadsWhatALaboratoryWrites) {
    const FileRead<BrdfRows> read = parsed(smallBird());
    const BrdfRows& rows = read.content;
    EXPECT_EQ(rows.channels, (std::vector<Channel>{{"", 550}, {"", 650}}));
    ASSERT_EQ(rows.pairs.size(), 2U);
    EXPECT_EQ(rows.f, (std::vector<double>{0.25, 0.26, 0.5, 0.51}));
    EXPECT_NEAR(rows.uRandom[3], 0.0102, 1e-17);  // 2 % of 0.51: an ulp
    EXPECT_TRUE(rows.uSystematic.empty());
    EXPECT_TRUE(rows.isotropic);
    EXPECT_NEAR(rows.pairs[1].out.theta().degrees(), 20, 1e-12);
    EXPECT_NEAR(rows.pairs[1].out.phi().degrees(), 300, 1e-12);
    EXPECT_EQ(read.about.at(key::kSample), "tile");
    EXPECT_EQ(read.about.at(key::kSoftware), "2.4");
    EXPECT_EQ(read.about.at(key::kSolidAngle), "0.002");
    EXPECT_EQ(read.about.at(key::kDate), "2022-01-14T12:00:00+02:00");
    EXPECT_EQ(read.about.at("bird.provenance.organization"), "A laboratory");
    EXPECT_EQ(read.about.at("bird.environment.temperature.value"), "23.2");
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_NE(read.warnings[0].find("k = 1"), std::string::npos);
}

TEST(Bird, WritesTheSameBytesAgain) {
    for (const BrdfRows& rows : {test::measuredRows(), test::asymmetricRows(30)}) {
        Metadata about;
        about.set(key::kSample, "tile \"7\"");
        about.set(key::kDate, "2026-01-31T12:00:00Z");
        about.set("extra.a", "b\\c\nd");
        about.comments = {"a line", "", "another: one"};
        const std::string once = writeBird(rows, about)->bytes;
        const FileRead<BrdfRows> back = parsed(once);
        expectSameRows(back.content, rows);
        EXPECT_EQ(back.about, about);
        EXPECT_TRUE(back.warnings.empty());
        EXPECT_EQ(written(back), once);
    }
    const std::string foreign = written(parsed(smallBird()));
    EXPECT_EQ(written(parsed(foreign)), foreign);
}

TEST(Bird, IsAFileThatTheSchemaTakes) {
    BrdfRows rows = test::measuredRows();
    rows.f[3] = -0.125;
    const auto json = nlohmann::json::parse(writeBird(rows, {})->bytes);
    EXPECT_EQ(json.size(), 2U);
    for (const char* required : {"schema",
                                 "id",
                                 "type",
                                 "timestamp",
                                 "provenance",
                                 "description",
                                 "method",
                                 "instrumentation",
                                 "software",
                                 "sample",
                                 "environment"}) {
        EXPECT_TRUE(json["metadata"].contains(required)) << required;
    }
    const std::size_t entries = rows.f.size();
    for (const auto& [name, variable] : json["data"].items()) {
        if (name == "adhoc_variables") continue;
        EXPECT_EQ(variable["values"].size(), entries) << name;
        EXPECT_FALSE(variable.contains("name") || variable.contains("description"));
        for (const double one : variable["values"]) {
            const bool below = !name.starts_with("theta") || one < 90;
            ASSERT_TRUE(one >= 0 && one < 700 && below) << name << " " << one;
        }
    }
    for (const auto& [name, variable] : json["data"]["adhoc_variables"].items()) {
        EXPECT_EQ(variable["values"].size(), entries) << name;
        for (const char* required : {"description", "unit", "type"}) {
            EXPECT_TRUE(variable.contains(required)) << name;
        }
    }
    EXPECT_EQ(json["data"]["BRDF"]["values"][3], 0);
    EXPECT_EQ(json["data"]["adhoc_variables"]["negative"]["values"][3], -0.125);
}

TEST(Bird, KeepsNegativeValuesAndCountsThem) {
    BrdfRows rows = test::asymmetricRows();
    rows.f[3] = -0.125;
    const auto written = writeBird(rows, {});
    ASSERT_TRUE(written);
    const Written& out = *written;
    ASSERT_EQ(out.loss.items.size(), 1U);
    EXPECT_EQ(out.loss.items[0].kind, Loss::Clamped);
    EXPECT_EQ(out.loss.items[0].count, 1U);
    const FileRead<BrdfRows> back = parsed(out.bytes);
    expectSameRows(back.content, rows);
    EXPECT_EQ(back.warnings, std::vector<std::string>{"1 negative values"});
}

TEST(Bird, LeavesOutWhatIsMissingOrBelowAndCountsIt) {
    BrdfRows rows = test::measuredRows();
    rows.f[1] = kNan;
    for (std::size_t c = 0; c < 3; ++c) rows.f[rows.index(5, c)] = kNan;
    rows.flags[rows.index(5, 0)] = Flags{Flag::Blocked};
    rows.pairs[7].out = Direction::fromSpherical(100_deg, 0_deg);
    rows.pairs[8].out = Direction::fromSpherical(Radians(kPi / 2 - 1e-13), 0_deg);
    const auto written = writeBird(rows, {});
    ASSERT_TRUE(written);
    const Written& out = *written;
    EXPECT_EQ(out.loss.items,
              (std::vector<LossReport::Item>{
                  {Loss::Masked, "missing values, left out", 4},
                  {Loss::Dropped, "flags of missing values", 4},
                  {Loss::Dropped, "values at a theta of 90 degrees and more", 6}}));
    const BrdfRows back = parsed(out.bytes).content;
    EXPECT_EQ(back.pairs.size(), rows.pairs.size() - 3);
    EXPECT_EQ(back.f[0], rows.f[0]);
    EXPECT_FALSE(back.hasData(0, 1));
    EXPECT_EQ(back.f[2], rows.f[2]);
}

TEST(Bird, KeepsUncertaintiesOfWhichSomeAreNotKnown) {
    BrdfRows rows = test::measuredRows();
    rows.uRandom[4] = kNan;
    const std::string text = writeBird(rows, {})->bytes;
    EXPECT_EQ(text.find("uBRDF"), std::string::npos);
    expectSameRows(parsed(text).content, rows);
    rows.uSystematic.clear();
    expectSameRows(parsed(writeBird(rows, {})->bytes).content, rows);
    rows.uRandom[4] = 0.5;  // all known: uBRDF alone
    const std::string combined = writeBird(rows, {})->bytes;
    EXPECT_EQ(combined.find("u_random"), std::string::npos);
    expectSameRows(parsed(combined).content, rows);
}

TEST(Bird, KeepsChannelsOfAnyKind) {
    for (const std::vector<Channel>& channels :
         {std::vector<Channel>{{"X", {}}, {"Y", {}}, {"Z", {}}},
          std::vector<Channel>{{"", 400}, {"", 500.5}, {"narrow", 500.5}},
          Channel::ofBands()}) {
        BrdfRows rows = test::asymmetricRows();
        rows.channels = channels;
        expectSameRows(parsed(writeBird(rows, {})->bytes).content, rows);
    }
    BrdfRows one = test::asymmetricRows();
    one.channels = {Channel{}};
    one.f.resize(one.pairs.size());
    const std::string text = writeBird(one, {})->bytes;
    EXPECT_EQ(text.find("wavelength"), std::string::npos);
    expectSameRows(parsed(text).content, one);
}

TEST(Bird, HoldsModelsAtNodesAndTheirMirror) {
    for (const char* spec : {"lambert,albedo=0.5", "ggx,alpha=0.05,f0=0.9"}) {
        const BrdfRows rows = test::modelRows(spec);
        const BrdfRows back = parsed(writeBird(rows, {})->bytes).content;
        expectSameRows(back, rows);
        if (spec[0] == 'g') test::expectPeaksAtTheMirror(back);
    }
}

TEST(Bird, PutsEntriesOfOnePairTogetherInAnyOrder) {
    const BrdfRows fastest = parsed(smallBird()).content;
    // The same four entries, channels slowest, and shuffled.
    for (const std::array<std::size_t, 4>& order :
         {std::array<std::size_t, 4>{0, 2, 1, 3}, std::array<std::size_t, 4>{0, 3, 2, 1}}) {
        auto json = nlohmann::json::parse(smallBird());
        for (auto& [name, variable] : json["data"].items()) {
            const auto values = variable["values"];
            for (std::size_t i = 0; i < 4; ++i) variable["values"][i] = values[order[i]];
        }
        expectSameRows(parsed(json.dump()).content, fastest);
    }
    // A pair that was measured twice stays two.
    auto twice = nlohmann::json::parse(smallBird());
    for (auto& [name, variable] : twice["data"].items()) {
        const auto values = variable["values"];
        for (const auto& one : values) variable["values"].push_back(one);
    }
    const BrdfRows four = parsed(twice.dump()).content;
    ASSERT_EQ(four.pairs.size(), 4U);
    EXPECT_EQ(four.f[4], four.f[0]);
}

TEST(Bird, ReadsRadiansMicrometresAndPolarization) {
    std::string text = replaced(smallBird(),
                                R"("theta_r": {"values": [10, 10, 20, 20], "unit": "deg"})",
                                R"("theta_r": {"values": [0.1, 0.1, 1.5, 1.5], "unit": "rad"},
  "polarization_i": {"notation": "sp", "values": ["s", "s", "u", "u"]},
  "polarization_r": {"notation": "inStokes",
                     "values": [[1, 0, 0, 0], [1, 0, 0, 0], [1, -1, 0, 0], [1, 0, 0, 0]]})");
    text = replaced(text,
                    R"("nm", "values": [550, 650, 550, 650])",
                    R"("μm", "values": [0.55, 0.65, 0.55, 0.65])");
    const BrdfRows rows = parsed(text).content;
    EXPECT_NEAR(rows.pairs[1].out.theta().value(), 1.5, 1e-15);
    ASSERT_EQ(rows.channels.size(), 4U);
    EXPECT_EQ(rows.channels[0], (Channel{"polarization_i=s", 550.0}));
    EXPECT_EQ(rows.channels[2], (Channel{"polarization_r=1,-1,0,0", 550.0}));
    EXPECT_EQ(rows.channels[3], (Channel{"", 650.0}));
}

TEST(Bird, ReadsTheOlderLayouts) {
    const std::string variables =
        R"("variables": [{"name": "theta_i", "type": "number", "unit": "deg"},
         {"name": "phi_i", "unit": "deg"}, {"name": "theta_r", "unit": "deg"},
         {"name": "colour", "type": "string", "unit": ""}, {"name": "phi_r", "unit": "rad"},
         {"name": "BRDF", "unit": "sr-1"}, {"name": "uBRDF", "unit": "sr-1"}])";
    const std::string values =
        R"("values": [[45, 0, 10, "red", 1, 0.25, 0.01], ["45", "0", "20", "red", "2", "0.5", "0"]])";
    for (const bool valuesFirst : {false, true}) {
        const std::string data =
            valuesFirst ? values + ", " + variables : variables + ", " + values;
        const FileRead<BrdfRows> read = parsed(R"({"metadata": {}, "data": {)" + data + "}}");
        ASSERT_EQ(read.content.pairs.size(), 2U);
        EXPECT_EQ(read.content.f, (std::vector<double>{0.25, 0.5}));
        EXPECT_EQ(read.content.uRandom, (std::vector<double>{0.01, 0}));
        EXPECT_NEAR(read.content.pairs[1].out.phi().value(), 2, 1e-15);
    }
    const std::string start = R"({"data": {)" + variables + R"(, "values": [[45, 0, 10, "r", 1)";
    EXPECT_TRUE(refuses(parseBird(start + "]]}}", "in"), {"5 values in a row, there are 7"}));
    EXPECT_TRUE(refuses(parseBird(start + R"(, 1, 1, 1]]}})", "in"), {"more values than"}));
    EXPECT_TRUE(refuses(parseBird(R"({"data": {"values": [[1]]}})", "in"), {"variables"}));
}

TEST(Bird, TakesOneUncertaintyForAll) {
    const std::string text = replaced(replaced(smallBird(), "uBRDF", "wavelength_x"),
                                      R"("BRDF": {"unit": "1/sr")",
                                      R"("BRDF": {"uncertainty": {"value": 2, "unit": "%"},
   "unit": "1/sr")");
    const FileRead<BrdfRows> read = parsed(text);
    EXPECT_NEAR(read.content.uRandom[2], 0.01, 1e-17);
    EXPECT_EQ(read.warnings[0], "passed over the variable 'wavelength_x'");
}

TEST(Bird, ReadsAnyLineEndsAndAByteOrderMark) {
    std::string returns = smallBird();
    for (char& c : returns) c = c == '\n' ? '\r' : c;
    expectSameRows(parsed("\xEF\xBB\xBF" + returns).content, parsed(smallBird()).content);
    EXPECT_TRUE(refuses(parseBird(replaced(returns, "0.25, ", "0.25 "), "in"), {"line 23"}));
}

TEST(Bird, RefusesATextCutAtAnyByte) {
    const std::string text = smallBird();
    for (std::size_t size = 0; size + 2 < text.size(); ++size) {
        EXPECT_TRUE(refuses(parseBird(text.substr(0, size), "cut.brdf"), {"bird: cut.brdf: line "}))
            << size;
    }
}

TEST(Bird, RefusesWhatIsNoFiniteNumber) {
    for (const char* word :
         {"banana", "nan", "NaN", "inf", "-inf", "1e999", "0x10", "1.5.2", "null", "\"1\"", "+1"}) {
        const std::string text = replaced(smallBird(), "0.26", word);
        EXPECT_TRUE(refuses(parseBird(text, "in.brdf"), {"bird: in.brdf: line 23: "})) << word;
    }
    EXPECT_TRUE(refuses(parseBird(replaced(smallBird(), "0.26", "0,26"), "in"),
                        {"theta_i: 4 values, BRDF has 5"}));
}

TEST(Bird, SaysWhatIsWrong) {
    const auto refused = [](std::string_view from, std::string_view to) {
        return parseBird(replaced(smallBird(), from, to), "in");
    };
    EXPECT_TRUE(refuses(parseBird("", "in"), {"bird: in: line 1: the text ends"}));
    EXPECT_TRUE(refuses(parseBird("[1]", "in"), {"wanted an object"}));
    EXPECT_TRUE(refuses(parseBird("tensor_file", "in"), {"line 1: 'tensor_file'"}));
    EXPECT_TRUE(refuses(parseBird("{}", "in"), {"no data"}));
    EXPECT_TRUE(refuses(parseBird(smallBird() + "x", "in"), {"behind the end: 'x'"}));
    EXPECT_TRUE(refuses(refused("\"phi_r\"", "\"theta_r\""), {"'theta_r' is given twice"}));
    EXPECT_TRUE(refuses(refused("\"phi_r\"", "\"phi_o\""), {"no phi_r"}));
    EXPECT_TRUE(refuses(refused("\"data\"", "\"metadata\""), {"'metadata' is given twice"}));
    EXPECT_TRUE(refuses(refused("[10, 10, 20, 20]", "[10, 10, 20]"), {"theta_r: 3 values"}));
    EXPECT_TRUE(refuses(refused("[10, 10, 20, 20]", "[10, 10, 20, 181]"), {"theta_r: 181"}));
    EXPECT_TRUE(refuses(refused("[10, 10, 20, 20]", "[10, 10, -20, 20]"), {"theta_r: -20"}));
    EXPECT_TRUE(refuses(refused("\"1/sr\"", "\"1/m\""), {"BRDF: unit '1/m'"}));
    EXPECT_TRUE(refuses(refused("\"%\"", "\"pct\""), {"uBRDF: unit 'pct'"}));
    EXPECT_TRUE(refuses(refused("[1, 1, 2, 2]", "[1, 1, -2, 2]"), {"uBRDF: -2"}));
    std::string deep = R"({"metadata": )";
    for (int i = 0; i < 100'000; ++i) deep += "[";
    EXPECT_TRUE(refuses(parseBird(deep, "in"), {"nested deeper than 64"}));
}

TEST(Bird, RefusesFlagsThatAreNoMask) {
    const std::string text = writeBird(test::measuredRows(), {})->bytes;
    for (const char* mask : {"-1", "1.5", "16384", "1e300"}) {
        const std::string wrong =
            replaced(text, "\"values\": [1025", std::string("\"values\": [") + mask);
        EXPECT_TRUE(refuses(parseBird(wrong, "in"), {"flags: ", "a mask"})) << mask;
    }
}

TEST(Bird, RefusesChannelsThatWouldFillNoTable) {
    std::string angles = "0", wavelengths = "1";
    for (int i = 1; i < 5000; ++i) {
        angles += "," + std::to_string(i) + "e-3";
        wavelengths += "," + std::to_string(i + 1);
    }
    const auto variable = [](const std::string& name, const char* unit, const std::string& list) {
        return "\"" + name + R"(": {"unit": ")" + unit + R"(", "values": [)" + list + "]}";
    };
    const std::string text =
        R"({"data": {)" + variable("theta_i", "deg", angles) + "," +
        variable("phi_i", "deg", angles) + "," + variable("theta_r", "deg", angles) + "," +
        variable("phi_r", "deg", angles) + "," + variable("wavelength_i", "nm", wavelengths) + "," +
        variable("BRDF", "1/sr", angles) + "}}";
    EXPECT_TRUE(refuses(parseBird(text, "in"), {"5000 values at 5000 direction pairs"}));
}

TEST(Bird, ChecksAndConvertsThePartsOfAnUncertainty) {
    const auto text = [](const std::string& unit, const std::string& values) {
        return replaced(smallBird(),
                        R"("values": [1, 1, 2, 2]}
 })",
                        R"("values": [1, 1, 2, 2]},
  "adhoc_variables": {
   "u_random": {"unit": ")" +
                            unit + R"(", "values": )" + values + R"(},
   "u_systematic": {"unit": "%", "values": [4, 4, 4, 4]}}
 })");
    };
    const BrdfRows rows = parsed(text("%", "[1, 1, 2, 2]")).content;
    ASSERT_EQ(rows.uRandom.size(), 4U);
    EXPECT_NEAR(rows.uRandom[2], 0.01, 1e-15);
    EXPECT_NEAR(rows.uSystematic[2], 0.02, 1e-15);
    EXPECT_EQ(parsed(text("sr^-1", "[1, 1, 2, 2]")).content.uRandom[2], 2);
    EXPECT_TRUE(refuses(parseBird(text("m", "[1, 1, 2, 2]"), "in"), {"u_random: unit 'm'"}));
    EXPECT_TRUE(
        refuses(parseBird(text("%", "[1, 1, -2, 2]"), "in"), {"u_random: -2, wanted 0 or more"}));
}

// Found by libFuzzer: it was written, and could not be read back.
TEST(Bird, IsNotWrittenWithoutAValue) {
    BrdfRows rows = test::measuredRows();
    for (LightView& pair : rows.pairs) pair.in = Direction::fromSpherical(90_deg, 0_deg);
    const auto out = writeBird(rows, {});
    ASSERT_FALSE(out);
    EXPECT_EQ(out.error().kind, ErrorKind::Usage);
    EXPECT_EQ(out.error().message, "bird: no value at thetas below 90 degrees");
}

}  // namespace
}  // namespace gonio::proc
