#include "sim/faults/fault_script.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "sim/random.h"

namespace gonio::sim {
namespace {

FaultScript parsed(std::string_view text) {
    auto script = FaultScript::parse(text);
    EXPECT_TRUE(script) << script.error().message;
    return script ? std::move(*script) : FaultScript{};
}

std::string refusal(std::string_view text) {
    const auto script = FaultScript::parse(text);
    return script ? std::string() : script.error().message;
}

TEST(FaultScript, ReadsARuleALineAndSkipsComments) {
    const FaultScript script = parsed(
        "# a bad cable\n"
        "seed 7\n"
        "\n"
        "at 1.2s unplug for 300ms   # and back\n"
        "every 2s..3s lose 2..4 chunks or stall bulk\n");
    EXPECT_EQ(script.seed, 7U);
    ASSERT_EQ(script.rules.size(), 2U);
    const FaultRule& first = script.rules[0];
    EXPECT_EQ(first.line, 4);
    EXPECT_EQ(first.when.kind, FaultMoment::Kind::Time);
    EXPECT_DOUBLE_EQ(first.when.value.low, 1.2);
    ASSERT_EQ(first.faults.size(), 1U);
    EXPECT_EQ(first.faults[0].kind, FaultKind::Unplug);
    ASSERT_TRUE(first.faults[0].lasting);
    EXPECT_DOUBLE_EQ(first.faults[0].lasting->high, 0.3);
    const FaultRule& second = script.rules[1];
    EXPECT_DOUBLE_EQ(second.when.value.low, 2);
    EXPECT_DOUBLE_EQ(second.when.value.high, 3);
    ASSERT_EQ(second.faults.size(), 2U);
    EXPECT_DOUBLE_EQ(second.faults[0].count.low, 2);
    EXPECT_DOUBLE_EQ(second.faults[0].count.high, 4);
}

TEST(FaultScript, TheLongestFormThatFitsIsMeant) {
    const FaultScript script = parsed("at 0s hang\nat 0s hang until reset\nat 0s plug as X-1\n");
    EXPECT_EQ(script.rules[0].faults[0].kind, FaultKind::Hang);
    EXPECT_EQ(script.rules[1].faults[0].kind, FaultKind::HangUntilReset);
    EXPECT_EQ(script.rules[2].faults[0].kind, FaultKind::PlugAs);
    EXPECT_EQ(script.rules[2].faults[0].name, "X-1");
}

TEST(FaultScript, KnowsFramesChunksAndCommands) {
    const FaultScript script = parsed(
        "on chunk 3 of frame 2 flip 1 bits in payload\n"
        "on ARM 2 lose ack\n"
        "after command 5 unplug\n"
        "with chance 0.25 per frame black frame\n");
    ASSERT_TRUE(script.rules[0].when.ofFrame);
    EXPECT_DOUBLE_EQ(script.rules[0].when.ofFrame->low, 2);
    EXPECT_EQ(script.rules[1].when.op, driver::Op::Arm);
    EXPECT_EQ(script.rules[2].when.kind, FaultMoment::Kind::AfterCommand);
    EXPECT_DOUBLE_EQ(script.rules[3].when.chance, 0.25);
}

TEST(FaultScript, AnErrorNamesTheLineAndWhatWasWanted) {
    EXPECT_EQ(refusal("at 1s unplug\nat noon unplug\n"),
              "fault script: line 2: \"noon\", wanted a time such as 1.5s or 0.5s..2s");
    EXPECT_NE(refusal("at 1s explode").find("\"explode\""), std::string::npos);
    EXPECT_NE(refusal("at 1s").find("the line ends"), std::string::npos);
    EXPECT_NE(refusal("at 1s unplug now").find("\"now\""), std::string::npos);
    EXPECT_NE(refusal("at 1s malform nose").find("ident-crc"), std::string::npos);
}

TEST(FaultScript, RefusesNumbersThatCannotBe) {
    for (const char* line : {"at 2s..1s unplug",
                             "at -1s unplug",
                             "at 1 unplug",
                             "at nans unplug",
                             "at 1e300s unplug",
                             "every 0s unplug",
                             "on chunk 0 lose chunk",
                             "on chunk 1 of frame 0 lose chunk",
                             "on frame 99999999999999999999 black frame",
                             "on PONG 1 lose ack",
                             "with chance 1.1 per chunk lose chunk",
                             "with chance 0.1 per day lose chunk",
                             "at 1s unplug for -1s",
                             "at 1s unplug for 0s",
                             "at 1s unplug for 0s..1s",
                             "at 1s lose 0 chunks",
                             "at 1s lose 0..2 chunks",
                             "at 1s shorten 0 chunks",
                             "at 1s flip 0 bits in payload",
                             "at 1s flip 0 bits in header",
                             "at 1s burst of 0 bits in payload",
                             "at 1s drop 0 reports",
                             "at 1s pile up 0 reports",
                             "at 1s delay ack 0s",
                             "seed -1",
                             "seed 1 2"}) {
        EXPECT_NE(refusal(line), "") << line;
    }
    EXPECT_NE(refusal(std::string(FaultScript::kMostBytes + 1, '\n')), "");
    EXPECT_EQ(refusal("at 1s memory for 0 transfers"), "") << "none at all is a fault";
}

TEST(FaultScript, TheDocumentHasEveryFaultAndItsExampleIsSound) {
    std::ifstream file(GONIO_SOURCE_DIR "/docs/fault-scripts.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const auto begin = text.find("```\n") + 4;
    EXPECT_EQ(parsed(text.substr(begin, text.find("```", begin) - begin)).rules.size(), 3U);
    for (std::size_t i = 0; i < kFaultKinds; ++i) {
        // Up to where a value stands: "flip" of "flip # bits in payload".
        std::string words(faultName(static_cast<FaultKind>(i)));
        words = words.substr(0, words.find_first_of("#@$"));
        EXPECT_NE(text.find("`" + words), std::string::npos) << words;
    }
}

TEST(FaultScript, EveryFaultCanBeWrittenAsItIsNamed) {
    for (std::size_t i = 0; i < kFaultKinds; ++i) {
        const auto kind = static_cast<FaultKind>(i);
        std::string words;
        for (const char c : std::string(faultName(kind)))
            words += c == '#' ? "2" : c == '@' ? "1s" : c == '$' ? "ident-crc" : std::string(1, c);
        const auto script = FaultScript::parse("at 0s " + words);
        ASSERT_TRUE(script) << script.error().message;
        EXPECT_EQ(script->rules[0].faults[0].kind, kind) << words;
    }
}

TEST(FaultScript, AnyBytesAreAScriptOrAnError) {
    constexpr std::uint64_t kSeed = 20261130;
    constexpr std::string_view kSound =
        "seed 3\nat 0.5s..2s unplug for 1s\non chunk 1..8 of frame 2 burst of 2..32 bits in "
        "payload\nwith chance 0.5 per command delay ack 5ms or lose ack\n";
    int sound = 0;
    for (std::uint64_t round = 0; round < 20'000; ++round) {
        std::string text(kSound);
        const auto at = [&](std::uint64_t k) {
            return static_cast<std::size_t>(uniform(mixed(kSeed, round), k) *
                                            static_cast<double>(text.size()));
        };
        for (std::uint64_t k = 0; k < 3; ++k)
            text[at(2 * k)] = static_cast<char>(uniform(mixed(kSeed, round), 100 + k) * 256);
        text.resize(at(50));
        sound += FaultScript::parse(text) ? 1 : 0;
    }
    EXPECT_GT(sound, 0);
    EXPECT_LT(sound, 20'000);
}

}  // namespace
}  // namespace gonio::sim
