// A row says only what it means: anything else in it is refused. And what it wants and does not get
// is complained of.

#include "tests/faults/row.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <optional>

#include "tests/faults/measurement.h"
#include "tests/faults/row_seeds.h"

namespace gonio::fault_test {
namespace {

using namespace std::chrono_literals;

std::string refusal(const std::string& text) {
    try {
        (void)parseRow("X", text);
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

/// What a row of these lines complains of.
std::string complaintsOf(const std::string& lines, const Outcome& outcome) {
    std::string all;
    for (const std::string& one : complaints(parseRow("X", lines), outcome, {})) all += one + "; ";
    return all;
}

TEST(FaultRowText, WhatItDoesNotKnowItRefuses) {
    const std::string sound = "at 0s unplug\n#! verdict completed\n";
    ASSERT_EQ(refusal(sound), "");
    for (const char* line : {"#! verdict complete",
                             "#! verdict completed at last",
                             "#! count lostChunk = 1",
                             "#! count lostChunks == 1",
                             "#! count lostChunks < 1",
                             "#! count lostChunks = many",
                             "#! count lostChunks =",
                             "#! count lostChunks = 1 2",
                             "#! event seven",
                             "#! detected 300",
                             "#! detected 0ms",
                             "#! noticed soon",
                             "#! reclaimed 2s 3s",
                             "#! waive lostChunks",
                             "#! waive lostChunks 0 for nothing",
                             "#! waive lostChunk -1",
                             "#! when led-count-none says led_count",
                             "#! only guest",
                             "#! says",
                             "#! wishes it well",
                             "#!"})
        EXPECT_NE(refusal(sound + line + "\n"), "") << line;
    EXPECT_NE(refusal("at 0s unplug\n"), "");
    EXPECT_NE(refusal("at 0s malform roi-none or malform chunk-none\n#! verdict refused\n"
                      "#! when roi-none says roi_step\n"),
              "");
}

TEST(FaultRowText, EveryScriptIsSound) {
    for (const char* door : {"inproc", "umockdev"}) EXPECT_GT(rowNames(door).size(), 30U) << door;
}

TEST(FaultRowText, EachMalformationIsPlayedByItself) {
    const Row row = parseRow("X",
                             "at 0s malform roi-none or malform chunk-none\n#! verdict refused\n"
                             "#! when roi-none says roi_step\n#! when chunk-none says max_chunk\n");
    const auto variants = variantsOf(row);
    ASSERT_EQ(variants.size(), 2U);
    EXPECT_EQ(variants[0].script.rules[0].faults.size(), 1U);
    EXPECT_EQ(variants[0].script.rules[0].faults[0].name, "chunk-none");
    EXPECT_EQ(variants[1].script.rules[0].faults[0].name, "roi-none");
}

TEST(FaultRowComplaints, ATimeLimitIsKeptExactlyOrTenTimesInRealTime) {
    const std::string lines = "#! verdict interrupted\n#! detected 300ms\n#! reclaimed 2s\n";
    Outcome outcome{.verdict = "interrupted", .detected = 300ms, .reclaimed = 2s};
    EXPECT_EQ(complaintsOf(lines, outcome), "");
    outcome.detected += 1ns;
    EXPECT_NE(complaintsOf(lines, outcome).find("to the comeback"), std::string::npos);
    outcome.slack = 10;
    EXPECT_EQ(complaintsOf(lines, outcome), "");
    outcome.reclaimed = 20s + 1ns;
    EXPECT_NE(complaintsOf(lines, outcome).find("to the claim"), std::string::npos);
    outcome.reclaimed = 0s;
    EXPECT_NE(complaintsOf(lines, outcome).find("no time from the plug"), std::string::npos);
}

TEST(FaultRowComplaints, NoCallGoesOnPastItsDeadline) {
    Outcome outcome{.verdict = "completed", .longestCall = 1100ms};
    EXPECT_EQ(complaintsOf("#! verdict completed\n", outcome), "");
    outcome.longestCall += 1ns;
    EXPECT_NE(complaintsOf("#! verdict completed\n", outcome), "");
}

TEST(FaultRowComplaints, AWaiverIsUsedExactly) {
    const std::string lines = "#! verdict completed\n#! waive lostChunks -1 in flight\n";
    Outcome outcome{.verdict = "completed"};
    outcome.counts = {{"lostChunks", 2}, {"did stall bulk", 3}};
    EXPECT_EQ(complaintsOf(lines, outcome), "");
    outcome.counts["lostChunks"] = 3;
    EXPECT_NE(complaintsOf(lines, outcome), "") << "it excuses nothing";
    outcome.counts["lostChunks"] = 1;
    EXPECT_NE(complaintsOf(lines, outcome), "");
    EXPECT_NE(complaintsOf("#! verdict completed\n#! waive stale 1\n", {.verdict = "completed"}),
              "");
}

TEST(FaultRowComplaints, ARefusalForAnotherReasonIsNone) {
    const std::string lines =
        "at 0s malform roi-none\n#! verdict refused\n#! when roi-none says roi_step\n";
    Outcome outcome{.verdict = "refused", .said = "it has no roi_step", .malformed = {"roi-none"}};
    EXPECT_EQ(complaintsOf(lines, outcome), "");
    outcome.said = "it does not answer";
    EXPECT_NE(complaintsOf(lines, outcome), "");
    outcome.said = "roi_step\nand more";
    EXPECT_NE(complaintsOf(lines, outcome), "");
    outcome.malformed.clear();
    EXPECT_NE(complaintsOf(lines, outcome), "");
}

TEST(FaultRowComplaints, WhatNobodyCountsIsAsked) {
    Outcome outcome{.verdict = "completed"};
    EXPECT_NE(complaintsOf("#! verdict completed\n#! count repeats = 0\n", outcome), "");
    outcome.counts = {{"repeats", 0}};
    EXPECT_EQ(complaintsOf("#! verdict completed\n#! count repeats = 0\n", outcome), "");
    outcome.counts = {{"repeat", 0}};
    EXPECT_NE(complaintsOf("#! verdict completed\n", outcome), "");
}

TEST(FaultRowSeeds, NoSeedAtAllIsRefused) {
    std::map<const char*, std::optional<std::string>> asked;
    for (const char* variable : {"GONIO_FAULT_SEEDS", "GONIO_FAULT_SEED"}) {
        const char* text = std::getenv(variable);
        asked[variable] = text ? std::optional<std::string>(text) : std::nullopt;
    }
    for (const char* variable : {"GONIO_FAULT_SEEDS", "GONIO_FAULT_SEED"}) {
        for (const char* text : {"0", "-1", "many", "", "3x", "99999999999999999999"}) {
            ASSERT_EQ(setenv(variable, text, 1), 0);
            EXPECT_THROW((void)seedsOf(1), std::runtime_error) << variable << "=" << text;
        }
        ASSERT_EQ(setenv(variable, "3", 1), 0);
        EXPECT_EQ(seedsOf(1).last, 3);
        ASSERT_EQ(unsetenv(variable), 0);
    }
    // The rows of this process are played with what was asked for.
    for (const auto& [variable, text] : asked) {
        if (text) {
            ASSERT_EQ(setenv(variable, text->c_str(), 1), 0);
        }
    }
}

}  // namespace
}  // namespace gonio::fault_test
