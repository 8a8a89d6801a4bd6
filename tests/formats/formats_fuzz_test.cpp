// Small valid files, damaged: bits flipped, cut, pieces doubled or lost, numbers replaced. No crash
// (sanitizers watch), and either one line that says why not, or a value that can be written and
// read again.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdlib>
#include <random>

#include "proc/formats/exr_parts.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/points_csv.h"
#include "proc/formats/sniff.h"
#include "proc/formats/zemax.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"

namespace gonio::proc {
namespace {

using test::refuses;

int cases(int usual) { return std::getenv("GONIO_NIGHTLY") != nullptr ? 8 * usual : usual; }

std::size_t below(std::mt19937_64& random, std::size_t count) {
    return static_cast<std::size_t>(random() % count);
}

/// Puts a number of another size or kind where one stands.
void replaceNumber(std::string& text, std::mt19937_64& random) {
    constexpr std::string_view kNumbers[] = {
        "0",    "-1",     "-0",         "1.5",        "90",     "180",    "1e300",
        "nan",  "inf",    "4294967296", "2147483648", "65536",  "1e999",  "9223372036854775807",
        "1e-5", "banana", "",           "359.999",    "5e-324", "1e308,", "18446744073709551615"};
    const auto isDigit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    const std::size_t start = below(random, text.size());
    const auto digit =
        std::find_if(text.begin() + static_cast<std::ptrdiff_t>(start), text.end(), isDigit);
    const auto end = std::find_if_not(digit, text.end(), isDigit);
    text.replace(digit, end, kNumbers[below(random, std::size(kNumbers))]);
}

void mutateOnce(std::string& text, std::mt19937_64& random) {
    if (text.empty()) return;
    const std::size_t at = below(random, text.size());
    const std::size_t size = 1 + below(random, 40);
    switch (random() % 6) {
        case 0: text[at] = static_cast<char>(text[at] ^ (1 << (random() % 8))); break;
        case 1: text[at] = static_cast<char>(random()); break;
        case 2: text.insert(below(random, text.size()), text.substr(at, size)); break;
        case 3: text.erase(at, size); break;
        case 4:
            if (random() % 4 == 0) text.resize(at);
            break;
        default: replaceNumber(text, random);
    }
}

std::string mutated(std::string text, std::mt19937_64& random) {
    for (std::uint64_t k = 1 + random() % 4; k > 0; --k) mutateOnce(text, random);
    return text;
}

/// Bytes changed and words overwritten, mostly in the headers; rarely any other length.
std::string mutatedBytes(std::string bytes, std::mt19937_64& random) {
    constexpr std::size_t kHeaders = 1500;
    for (std::uint64_t k = 1 + random() % 3; k > 0; --k) {
        const std::size_t reach =
            random() % 4 != 0 ? std::min(kHeaders, bytes.size()) : bytes.size();
        const std::size_t at = below(random, reach);
        switch (random() % 8) {
            case 0: mutateOnce(bytes, random); break;
            case 1:
            case 2: {
                constexpr std::string_view kWords[] = {"\xff\xff\xff\xff", "\xff\xff\xff\x7f"};
                const auto word = kWords[random() % 2].substr(0, bytes.size() - at);
                bytes.replace(at, word.size(), word);
                break;
            }
            case 3: bytes[at] = static_cast<char>(random()); break;
            default: bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
        }
        if (bytes.empty()) return bytes;
    }
    return bytes;
}

/// The attributes and the structure of a sound OpenEXR file, mutated; empty where it has none.
std::string mutatedParts(std::vector<ExrPart> parts, std::mt19937_64& random) {
    for (std::uint64_t k = 1 + random() % 2; k > 0; --k) {
        ExrPart& part = parts[below(random, parts.size())];
        auto text = part.text.begin();
        std::advance(text, below(random, part.text.size()));
        switch (random() % 8) {
            case 0: part.name = mutated(part.name, random); break;
            case 1: part.floats.erase(part.floats.begin()); break;
            case 2:
                part.floats.begin()->second.back() =
                    std::bit_cast<float>(static_cast<std::uint32_t>(random()));
                break;
            case 3: part.counts.begin()->second.front() ^= 1U << (random() % 32); break;
            default: text->second = mutated(text->second, random);
        }
        if (part.floats.empty()) break;
    }
    const auto bytes = encodeExr(parts);
    return bytes ? *bytes : "";
}

TEST(FormatsFuzz, ZemaxIsRefusedOrWrittenAgain) {
    std::mt19937_64 random(31);
    int accepted = 0;
    for (int i = 0; i < cases(100'000); ++i) {
        const std::string text = mutated(test::smallZemax(), random);
        const auto table = parseZemax(text, "in");
        if (!table) {
            ASSERT_TRUE(refuses(table, {"zemax: in: line "})) << text;
            continue;
        }
        ++accepted;
        const Written once = writeZemax(*table);
        ASSERT_TRUE(once.loss.items.empty()) << text;
        const auto back = parseZemax(once.bytes, "out");
        ASSERT_TRUE(back) << back.error().message << "\n" << text;
        ASSERT_EQ(writeZemax(*back).bytes, once.bytes) << text;
    }
    EXPECT_GT(accepted, cases(1'000)) << "mutations must leave something to read";
}

TEST(FormatsFuzz, PointsAreRefusedOrAnsweredAndReadAgain) {
    std::mt19937_64 random(32);
    int accepted = 0;
    for (int i = 0; i < cases(100'000); ++i) {
        const std::string text = mutated(test::smallPoints(), random);
        const auto points = parsePoints(text, "in");
        if (!points) {
            ASSERT_TRUE(refuses(points, {"csv: in: line "})) << text;
            continue;
        }
        ++accepted;
        ASSERT_EQ(points->rows.size(), points->pairs.size());
        const std::vector<Answer> answers(points->pairs.size());
        const std::string out = evalCsv(*points, answers, BandCount::One);
        const auto back = parsePoints(out, "out");
        ASSERT_TRUE(back) << back.error().message << "\n" << text << "\n" << out;
        ASSERT_EQ(back->pairs.size(), points->pairs.size()) << text;
        ASSERT_EQ(back->columns.size(), points->columns.size() + 3) << text;
    }
    EXPECT_GT(accepted, cases(1'000)) << "mutations must leave something to read";
}

TEST(FormatsFuzz, SamplesAreRefusedOrWrittenAgain) {
    std::mt19937_64 random(33);
    const std::string sound = *encodeGonio(test::smallSample());
    const auto parts = *decodeExr(sound, {.largest = {360, 90}, .parts = 1});
    int accepted = 0;
    for (int i = 0; i < cases(1'200); ++i) {
        const std::string bytes =
            random() % 4 == 0 ? mutatedParts(parts, random) : mutatedBytes(sound, random);
        const auto set = decodeGonio(bytes, "in");
        if (!set) {
            ASSERT_TRUE(refuses(set, {"gonio: in: "})) << "case " << i;
            continue;
        }
        ++accepted;
        if (random() % 4 != 0) continue;  // writing takes the time of many readings
        const auto once = encodeGonio(*set);
        ASSERT_TRUE(once) << once.error().message << ", case " << i;
        ASSERT_TRUE(decodeGonio(*once, "out")) << "case " << i;
    }
    EXPECT_GT(accepted, cases(12)) << "mutations must leave something to read";
}

TEST(FormatsFuzz, RawCapturesAreRefusedOrWrittenAgain) {
    std::mt19937_64 random(34);
    const std::string sound = *encodeGraw(test::smallCapture());
    const auto parts = *decodeExr(sound, {.largest = {4, 3}, .parts = 3});
    int accepted = 0;
    for (int i = 0; i < cases(5'000); ++i) {
        const std::string bytes =
            random() % 2 == 0 ? mutatedParts(parts, random) : mutatedBytes(sound, random);
        const auto capture = decodeGraw(bytes, "in");
        if (!capture) {
            ASSERT_TRUE(refuses(capture, {"graw: in: "})) << "case " << i;
            continue;
        }
        ++accepted;
        const auto once = encodeGraw(*capture);
        ASSERT_TRUE(once) << once.error().message << ", case " << i;
        const auto back = decodeGraw(*once, "out");
        ASSERT_TRUE(back) << back.error().message << ", case " << i;
        ASSERT_EQ(*encodeGraw(*back), *once) << "case " << i;
    }
    EXPECT_GT(accepted, cases(50)) << "mutations must leave something to read";
}

TEST(FormatsFuzz, SniffAlwaysHasAName) {
    std::mt19937_64 random(35);
    const std::string heads[] = {test::smallZemax(),
                                 test::smallPoints(),
                                 encodeGraw(test::smallCapture())->substr(0, 4000),
                                 std::string("tensor_file\0\1\0", 14),
                                 "Aoi 10\nSide Front\n"};
    for (int i = 0; i < cases(50'000); ++i) {
        const std::string head = mutated(heads[below(random, std::size(heads))], random);
        const std::string path = mutated("some folder/file.bsdf", random);
        const auto found = sniff(head, head.size(), path);
        ASSERT_TRUE(!found || !name(*found).empty());
    }
}

}  // namespace
}  // namespace gonio::proc
