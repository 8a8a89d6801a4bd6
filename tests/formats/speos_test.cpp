#include "proc/formats/speos.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "proc/formats/file_bytes.h"
#include "proc/table/block_integral.h"
#include "tests/formats/refusal.h"
#include "tests/formats/small_files.h"
#include "tests/formats/spherical_files.h"
#include "tests/support/data_file.h"

namespace gonio::proc {
namespace {

using test::refuses;
using test::replaced;
using test::SphericalShape;
using test::sphericalTable;
using test::steps;

FileRead<SphericalTable> parsed(std::string_view text) {
    auto read = parseSpeos(text, "in");
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    return read ? std::move(*read) : FileRead<SphericalTable>{.content = {}, .about = {}};
}

/// Two incidences, one wavelength; phis on line 14, rows on 15 and 16.
std::string brdf() {
    return "OPTIS - brdf surface file v8.0\n"
           "0\n"
           "a comment\n"
           "8\n"
           "two\nline\n"
           "1\t0\n"
           "1\n"
           "2\t1\n"
           "10\t30\n"
           "525\n"
           "40\n2\t3\n\t0\t120\t240\n0\t0.1\t0.1\t0.1\n90\t0.2\t0.3\t0.4\n"
           "50\n2\t3\n\t0\t120\t240\n0\t0.5\t0.5\t0.5\n90\t0.6\t0.7\t0.8\n";
}

/// Two anisotropy angles with one incidence each, intensities.
std::string anisotropic() {
    return "OPTIS - Anisotropic BSDF surface file v8.0\n"
           "0\n"
           "Comment\n"
           "0\n\n"
           "0\t1\t0\n"
           "1\t0\n"
           "0\n"
           "2\n0\t90\n"
           "1\n10\n"
           "1\n20\n"
           "10\t0\n"
           "a spectrum\n"
           "2\n400\t50\n700\t60\n"
           "2\t2\n\t0\t180\n0\t1\t1\n60\t2\t3\n"
           "2\t2\n\t0\t180\n0\t4\t4\n60\t5\t6\n"
           "End of file\n";
}

TEST(SpeosText, PutsEachNumberInItsPlace) {
    const auto read = parsed(brdf());
    const SphericalTable& table = read.content;
    ASSERT_EQ(table.blocks.size(), 2U);
    EXPECT_EQ(table.channels, std::vector<Channel>{Channel::of(Band::G)});
    EXPECT_EQ(table.mirrorAzimuthDeg, 0);
    EXPECT_EQ(table.blocks[1].incidenceDeg, 30);
    EXPECT_EQ(table.blocks[1].tis, 0.5);
    EXPECT_EQ(table.blocks[1].azimuthDeg, (std::vector<double>{0, 120, 240}));
    EXPECT_EQ(table.blocks[1].f, (std::vector<double>{0.5, 0.6, 0.5, 0.7, 0.5, 0.8}));
    EXPECT_EQ(read.about.comments, (std::vector<std::string>{"a comment", "two", "line"}));
}

TEST(SpeosText, DividesIntensitiesByTheCosine) {
    const auto read = parsed(anisotropic());
    const SphericalTable& table = read.content;
    ASSERT_EQ(table.blocks.size(), 2U);
    EXPECT_NEAR(table.blocks[0].f[1], 4, 1e-12);  // 2 / cos 60
    EXPECT_NEAR(table.blocks[1].f[3], 12, 1e-12);
    EXPECT_EQ(table.blocks[1].lightAzimuthDeg, 270);  // the sample turned by 90
    EXPECT_EQ(table.blocks[1].incidenceDeg, 20);
    EXPECT_EQ(read.about.at(kSpeosSpectrum), "400 50, 700 60");
    EXPECT_EQ(read.about.comments, (std::vector<std::string>{"Comment", "a spectrum"}));
    const auto grazing = parsed(replaced(anisotropic(), "\n60\t2\t3", "\n90\t0\t0"));
    EXPECT_TRUE(std::isnan(grazing.content.blocks[0].f[1]));
}

TEST(SpeosText, TakesTheSideOfThePeaksForTheMirror) {
    const auto lobe = [](const LightView& pair, std::size_t) { return test::mirrorLobe(pair, 20); };
    const std::string own = writeSpeosAnisotropic(sphericalTable({}, lobe), {})->bytes;
    EXPECT_EQ(parsed(own).content.mirrorAzimuthDeg, 0);
    const std::string other = replaced(own, "phi 0 is the mirror direction of the light", "?");
    EXPECT_TRUE(parsed(other).warnings.empty());
    SphericalTable turned = sphericalTable({.mirrorAzimuthDeg = 180}, lobe);
    turned.mirrorAzimuthDeg = 0;  // written as it stands: the light at 0
    const std::string foreign = replaced(writeSpeosAnisotropic(turned, {})->bytes,
                                         "phi 0 is the mirror direction of the light",
                                         "?");
    const auto read = parsed(foreign);
    EXPECT_EQ(read.content.mirrorAzimuthDeg, 180);
    ASSERT_FALSE(read.warnings.empty());
    EXPECT_NE(read.warnings[0].find("taken at phi 180"), std::string::npos);
    test::expectPeaksAtMirror(read.content);
}

TEST(SpeosText, KeepsARetroreflectorThatWeWrote) {
    const SphericalTable table = sphericalTable({}, [](const LightView& pair, std::size_t) {
        return test::mirrorLobe({.in = mirrorOf(pair.in), .out = pair.out}, 20);
    });
    const auto read = parsed(writeSpeosAnisotropic(table, {})->bytes);
    test::expectSameAtNodes(table, read.content, 1e-12);
    ASSERT_EQ(read.warnings.size(), 1U);  // of the peaks
}

TEST(SpeosText, WarnsOfTotalsThatAreNotTheTables) {
    const auto lambert = [](const LightView&, std::size_t) { return 0.5 / kPi; };
    const std::string text = writeSpeosBrdf(sphericalTable({}, lambert), {})->bytes;
    EXPECT_TRUE(parsed(text).warnings.empty());
    const auto read = parsed(replaced(text, "\n50\n", "\n25\n"));
    ASSERT_EQ(read.warnings.size(), 1U);
    EXPECT_EQ(read.warnings[0].find("totals of 1 tables differ"), 0U);
}

TEST(SpeosText, RefusesATextCutAnywhere) {
    for (const std::string& text : {brdf(), anisotropic()}) {
        const std::size_t whole = std::min(text.find("End of file"), text.size()) - 4;
        for (std::size_t size = 0; size < whole; ++size) {
            EXPECT_TRUE(refuses(parseSpeos(text.substr(0, size), "cut"), {"speos: cut: line "}))
                << size;
        }
    }
}

TEST(SpeosText, TakesAnyLineEnd) {
    for (const std::string& text : {brdf(), anisotropic()}) {
        for (const char* end : {"\r\n", "\r"}) {
            std::string other;
            for (const char c : text) other += c == '\n' ? std::string(end) : std::string(1, c);
            if (text == brdf()) {  // the description's own line end counts
                other = replaced(other, std::string("8") + end, end[1] != 0 ? "9\r\n" : "8\r");
            }
            EXPECT_EQ(parsed(other).content.blocks[1].f, parsed(text).content.blocks[1].f);
            EXPECT_EQ(parsed(other).about, parsed(text).about);
        }
        EXPECT_EQ(parsed("\xEF\xBB\xBF" + text).content.blocks[1].f,
                  parsed(text).content.blocks[1].f);
    }
}

TEST(SpeosText, RefusesWhatIsNoFiniteNumber) {
    for (const char* word : {"banana", "nan", "inf", "1e999", "0x10", "0,3"}) {
        EXPECT_TRUE(refuses(parseSpeos(replaced(brdf(), "0.3", word), "in"),
                            {"speos: in: line 16: ", word, "the number of value"}));
        for (const char* number : {"\n40\n", "\n525\n", "\n10\t", "\t120\t", "\n90\t"}) {
            const std::string place(number);
            EXPECT_TRUE(refuses(
                parseSpeos(
                    replaced(brdf(), number, place.front() + std::string(word) + place.back()),
                    "in"),
                {word}))
                << number;
        }
    }
}

TEST(SpeosText, RefusesCountsThatTheTextCannotHold) {
    for (const char* count : {"1000000000", "9223372036854775807"}) {
        EXPECT_TRUE(
            refuses(parseSpeos(replaced(brdf(), "2\t1\n", std::string(count) + "\t1\n"), "in"),
                    {count, "are promised"}));
        EXPECT_TRUE(
            refuses(parseSpeos(replaced(brdf(), "40\n2\t3", "40\n2\t" + std::string(count)), "in"),
                    {count, "are promised"}));
        EXPECT_TRUE(
            refuses(parseSpeos(replaced(brdf(), "\n8\n", "\n" + std::string(count) + "\n"), "in"),
                    {count, "description"}));
        EXPECT_TRUE(refuses(
            parseSpeos(replaced(anisotropic(), "\n2\n0\t90", "\n" + std::string(count) + "\n0\t90"),
                       "in"),
            {count, "are promised"}));
    }
    for (const char* count : {"0", "-1", "1.5", "9223372036854775808"}) {
        EXPECT_TRUE(
            refuses(parseSpeos(replaced(brdf(), "40\n2\t3", "40\n2\t" + std::string(count)), "in"),
                    {"the number of phis"}));
    }
}

TEST(SpeosText, RefusesWhatDoesNotFit) {
    EXPECT_TRUE(refuses(parseSpeos("", "in"), {"wanted 'OPTIS - ...'"}));
    EXPECT_TRUE(refuses(parseSpeos(brdf() + "more", "in"), {"'more', wanted nothing after"}));
    EXPECT_TRUE(refuses(parseSpeos(brdf() + "1", "in"), {"'1', wanted nothing after"}));
    EXPECT_TRUE(
        refuses(parseSpeos(replaced(brdf(), "1\t0", "2\t0"), "in"), {"0 or 1 for reflection"}));
    EXPECT_TRUE(refuses(parseSpeos(replaced(brdf(), "1\t0", "0\t0"), "in"), {"neither"}));
    EXPECT_TRUE(refuses(parseSpeos(replaced(brdf(), "10\t30", "30\t10"), "in"), {"must ascend"}));
    EXPECT_TRUE(refuses(parseSpeos(replaced(brdf(), "10\t30", "10\t90"), "in"), {"'90'"}));
    EXPECT_TRUE(
        refuses(parseSpeos(replaced(brdf(), "\t0\t120", "\t130\t120"), "in"), {"must ascend"}));
    EXPECT_TRUE(refuses(parseSpeos(replaced(brdf(), "90\t0.2", "100\t0.2"), "in"), {"at most 90"}));
    EXPECT_TRUE(
        refuses(parseSpeos(replaced(brdf(), "\t120\t", "\t0.0000001\t"), "in"), {"must ascend"}));
    EXPECT_TRUE(refuses(parseSpeos(replaced(anisotropic(), "0\t90\n1", "0\t360\n1"), "in"),
                        {"two equal anisotropy angles"}));
    EXPECT_TRUE(
        refuses(parseSpeos(replaced(brdf(), "1\t0\n", "0\t1\n"), "in"), {"in transmission"}));
    EXPECT_TRUE(
        refuses(parseSpeos(replaced(brdf(), "\n8\n", "\n5\n"), "in"), {"longer than its 5"}));
    EXPECT_TRUE(refuses(parseSpeos(replaced(brdf(), "\n0\n", "\n1\n"), "in"), {"mode 0, text"}));
}

TEST(SpeosText, RefusesADescriptionOfTooManyLines) {
    const std::string text =
        replaced(brdf(), "8\ntwo\nline", "10001\n" + std::string(10'001, '\n'));
    EXPECT_TRUE(refuses(parseSpeos(text, "in"), {"more than 10000 lines"}));
}

TEST(SpeosText, RefusesOtherSurfacesByName) {
    EXPECT_TRUE(refuses(
        parseSpeos("OPTIS - Simple scattering surface file v2.0\nScattering surface\n", "in"),
        {"speos: in: line 1: a simple scattering surface"}));
    EXPECT_TRUE(
        refuses(parseSpeos("OPTIS - Spectrum file v1.0\n0\n", "in"), {"'OPTIS - Spectrum"}));
    EXPECT_TRUE(
        refuses(parseSpeos("OPTIS - brdf surface file v9.0\n1\x03", "in"), {"binary brdf"}));
    EXPECT_TRUE(refuses(parseSpeos("OPTIS - Anisotropic BSDF surface file v7.0\n1\x03", "in"),
                        {"another version"}));
    const auto file = test::dataFile("vendor_exports/L100_2.simplescattering");
    if (!file) return;
    EXPECT_TRUE(refuses(parseSpeos(*readFile(*file), "L100"), {"simple scattering"}));
}

TEST(SpeosWriter, ReadsBackTheSameBytesAndModels) {
    for (const char* spec : {"lambert,albedo=0.3/0.2/0.1", "ggx,alpha=0.3,f0=0.5/0.4/0.3"}) {
        for (const bool symmetrical : {false, true}) {
            const SphericalTable table =
                sphericalTable({.channels = Channel::ofBands(),
                                .planeSymmetrical = symmetrical,
                                .azimuthDeg = steps(0, symmetrical ? 180 : 360, 10),
                                .thetaDeg = steps(0, 85, 5)},
                               test::ModelValue(spec));
            Metadata about;
            about.set(key::kSample, "two\nlines");
            about.comments = {"free text"};
            const auto once = writeSpeosBrdf(table, about);
            ASSERT_TRUE(once);
            EXPECT_TRUE(once->loss.items.empty());
            const auto read = parsed(once->bytes);
            test::expectSameAtNodes(table, read.content, 1e-12);
            EXPECT_EQ(read.about, about);
            EXPECT_EQ(writeSpeosBrdf(read.content, read.about)->bytes, once->bytes);
        }
    }
}

TEST(SpeosWriter, KeepsEveryLightAzimuthOfOneChannel) {
    const SphericalTable table =
        sphericalTable({.channels = Channel::ofBands(),
                        .lightAzimuthDeg = {0, 120, 240},
                        .thetaDeg = steps(0, 85, 5)},
                       [](const LightView& pair, std::size_t channel) {
                           return test::handedValue(pair) / (1.0 + static_cast<double>(channel));
                       });
    const auto once = writeSpeosAnisotropic(table, {});
    ASSERT_TRUE(once);
    EXPECT_EQ(once->loss.items,
              (std::vector<LossReport::Item>{
                  {Loss::Dropped, "blocks of channels beyond the first", 24}}));
    const auto read = parsed(once->bytes);
    SphericalTable first = table;
    std::erase_if(first.blocks, [](const SphericalBlock& block) { return block.channel > 0; });
    first.channels = {Channel{}};
    test::expectSameAtNodes(first, read.content, 1e-12);
    EXPECT_EQ(writeSpeosAnisotropic(read.content, read.about)->bytes, once->bytes);
    EXPECT_EQ(read.about.at(kSpeosSpectrum).substr(0, 4), "465 ");
}

TEST(SpeosWriter, KeepsTransmissionBesideReflection) {
    const auto value = [](const LightView& pair, std::size_t) { return test::handedValue(pair); };
    SphericalTable table = sphericalTable({}, value);
    const SphericalTable behind =
        sphericalTable({.thetaDeg = steps(95, 180, 5), .transmission = true}, value);
    table.blocks.insert(table.blocks.end(), behind.blocks.begin(), behind.blocks.end());
    for (const auto& write : {&writeSpeosBrdf, &writeSpeosAnisotropic}) {
        const auto once = write(table, {});
        ASSERT_TRUE(once);
        const auto read = parsed(once->bytes);
        ASSERT_EQ(read.content.blocks.size(), 8U);
        test::expectSameAtNodes(table, read.content, 1e-12);
        EXPECT_EQ(write(read.content, read.about)->bytes, once->bytes);
    }
}

TEST(SpeosWriter, PutsTheLobeAtTheMirrorDirection) {
    const SphericalTable table = sphericalTable(
        {.mirrorAzimuthDeg = 270, .azimuthDeg = steps(0, 355, 5)},
        [](const LightView& pair, std::size_t) { return test::mirrorLobe(pair, 3); });
    for (const auto& write : {&writeSpeosBrdf, &writeSpeosAnisotropic}) {
        const auto read = parsed(write(table, {})->bytes);
        EXPECT_EQ(read.content.mirrorAzimuthDeg, 0);
        test::expectPeaksAtMirror(read.content);
    }
}

TEST(SpeosWriter, StatesTotalsInPerCent) {
    const auto lambert = [](const LightView&, std::size_t) { return 0.1345 / kPi; };
    const auto text = writeSpeosBrdf(sphericalTable({}, lambert), {})->bytes;
    EXPECT_NE(text.find("\n13.45\n"), std::string::npos);
    EXPECT_NE(text.find("\n550\n"), std::string::npos);
    for (const SphericalBlock& block : parsed(text).content.blocks) {
        EXPECT_NEAR(block.tis, 0.1345, 1e-12);
    }
}

TEST(SpeosWriter, KeepsAStatedTotalThatIsNotTheIntegral) {
    const auto read = parsed(brdf());
    ASSERT_GT(std::abs(blockIntegral(read.content, read.content.blocks[1]) - 0.5), 0.1);
    const auto once = writeSpeosBrdf(read.content, read.about);
    ASSERT_TRUE(once);
    EXPECT_NE(once->bytes.find("\n40\n2\t"), std::string::npos);
    const auto again = parsed(once->bytes);
    EXPECT_EQ(again.content.blocks[1].tis, 0.5);
    EXPECT_EQ(writeSpeosBrdf(again.content, again.about)->bytes, once->bytes);
}

TEST(SpeosWriter, KeepsATotalThatOnlyTheFileTells) {
    // The azimuths leave a gap, so that the table has no integral of its own.
    std::string two = anisotropic();
    for (int i = 0; i < 2; ++i) two = replaced(two, "\t0\t180\n", "\t0\t90\n");
    const std::string one = replaced(two, "2\n400\t50\n700\t60", "1\n525\t50");
    for (const std::string& file : {two, one}) {
        const auto read = parsed(file);
        const auto once = writeSpeosAnisotropic(read.content, read.about);
        ASSERT_TRUE(once);
        EXPECT_NE(once->bytes.find("\t50\n"), std::string::npos);
        const auto again = parsed(once->bytes);
        EXPECT_EQ(writeSpeosAnisotropic(again.content, again.about)->bytes, once->bytes);
    }
}

TEST(SpeosWriter, WritesTotalsOfAnySizeThatItReads) {
    const std::string text =
        writeSpeosBrdf(sphericalTable({}, [](const LightView&, std::size_t) { return 1e200; }), {})
            ->bytes;
    EXPECT_EQ(writeSpeosBrdf(parsed(text).content, parsed(text).about)->bytes, text);
}

TEST(SpeosWriter, ReportsWhatIsLostAndRefusesTheRest) {
    const auto one = [](const LightView&, std::size_t) { return 1.0; };
    SphericalTable table = sphericalTable({.lightAzimuthDeg = {0, 90}}, one);
    table.blocks[1].f[5] = std::nan("");
    const auto written = writeSpeosBrdf(table, {});
    ASSERT_TRUE(written);
    EXPECT_EQ(written->loss.items,
              (std::vector<LossReport::Item>{
                  {Loss::Dropped, "wavelength that is not known, written as 550 nm", 1},
                  {Loss::Dropped,
                   "blocks of other light azimuths, channels or incidences than a file holds",
                   4},
                  {Loss::Masked, "nodes without data, written as 0", 1}}));
    const auto xyz = sphericalTable({.channels = {{"X", {}}, {"Y", {}}, {"Z", {}}}}, one);
    EXPECT_EQ(writeSpeosBrdf(xyz, {}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(writeSpeosAnisotropic(xyz, {}).error().kind, ErrorKind::Usage);
    EXPECT_EQ(writeSpeosBrdf(sphericalTable({.incidenceDeg = {20}}, one), {}).error().kind,
              ErrorKind::Usage);
    EXPECT_EQ(writeSpeosBrdf({}, {}).error().kind, ErrorKind::Usage);
}

/// The binary layout with one incidence of 20 degrees, two thetas and two phis.
class Binary {
public:
    template <class T>
    Binary& put(T value) {
        bytes_.append(reinterpret_cast<const char*>(&value),
                      sizeof value);  // NOLINT(*reinterpret*)
        return *this;
    }
    /// As one LZ4 block of literals.
    Binary& array(const std::vector<double>& values) {
        const std::size_t size = values.size() * sizeof(double);
        std::string block(1, static_cast<char>(size < 15 ? size << 4U : 0xF0U));
        if (size >= 15) block += static_cast<char>(size - 15);
        block.append(reinterpret_cast<const char*>(values.data()), size);  // NOLINT(*reinterpret*)
        put(std::uint64_t{size}).put(std::uint32_t(size)).put(std::uint32_t(block.size()));
        bytes_ += block;
        return *this;
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_ = "OPTIS - Anisotropic BSDF surface file v9.0\n1";
};

std::string binary(std::uint32_t incidences = 1, std::vector<double> rows = {0.1, 0.1, 0.2, 0.3}) {
    Binary file;
    file.put(std::uint32_t{3}).put(std::uint32_t{1}).put('\0').put(0.0).put(1.0).put(0.0);
    file.put(std::uint64_t{0}).put('\1').put('\0').put(1.0).put(1.0).put('\0').put('\0');
    file.put(std::uint32_t{1}).array({0}).put(incidences).array({20});
    file.put(6.0).put(0.0).put(std::uint32_t{0}).put(std::uint32_t{1}).put(525.0).put(40.0);
    file.put(std::uint32_t{2}).put(std::uint32_t{2}).array({0, 60}).array({0, 180}).array(rows);
    for (int i = 0; i < 41; ++i) file.put('\0');
    return file.bytes();
}

TEST(SpeosBinary, PutsEachNumberInItsPlace) {
    const auto read = parsed(binary());
    const SphericalTable& table = read.content;
    ASSERT_EQ(table.blocks.size(), 1U);
    EXPECT_EQ(table.mirrorAzimuthDeg, 180);
    EXPECT_EQ(table.blocks[0].incidenceDeg, 20);
    EXPECT_EQ(table.blocks[0].thetaDeg, (std::vector<double>{0, 60}));
    EXPECT_NEAR(table.blocks[0].f[1], 0.4, 1e-12);
    EXPECT_NEAR(table.blocks[0].f[3], 0.6, 1e-12);
    EXPECT_EQ(read.about.at(kSpeosSpectrum), "525 40");
}

TEST(SpeosBinary, RefusesEveryCutAndJunk) {
    const std::string bytes = binary();
    for (std::size_t size = 44; size < bytes.size(); ++size) {
        EXPECT_TRUE(refuses(parseSpeos(bytes.substr(0, size), "cut"), {"speos: cut: "})) << size;
    }
    EXPECT_TRUE(refuses(parseSpeos(bytes + "x", "in"), {"42 bytes behind the tables, wanted 41"}));
}

TEST(SpeosBinary, RefusesWhatIsNotKnown) {
    const std::string bytes = binary();
    for (const std::size_t field : {44U, 77U, 85U, 86U, 93U, 103U, 104U}) {
        std::string other = bytes;
        other[field] = static_cast<char>(other[field] ^ 0x40);
        EXPECT_TRUE(refuses(parseSpeos(other, "in"), {"speos: in: byte "})) << field;
    }
    EXPECT_TRUE(
        refuses(parseSpeos(binary(2), "in"), {"incidence takes 8 bytes, wanted 8 each of 2"}));
    EXPECT_TRUE(refuses(parseSpeos(binary(4000000000U), "in"), {"wanted 8 each of 4000000000"}));
    EXPECT_TRUE(refuses(parseSpeos(binary(1, {0.1, 0.1, 0.2, std::nan("")}), "in"),
                        {"table holds what is no finite number"}));
}

TEST(SpeosBinary, SurvivesAnyByteChanged) {
    const std::string bytes = binary();
    for (std::size_t at = 43; at < bytes.size(); ++at) {
        for (const int flip : {0x01, 0x80, 0xFF}) {
            std::string other = bytes;
            other[at] = static_cast<char>(other[at] ^ flip);
            const auto read = parseSpeos(other, "in");  // an error or another number
            EXPECT_TRUE(read || refuses(read)) << at;
        }
    }
}

TEST(SpeosBinary, ReadsTheVendorsFile) {
    const auto file = test::dataFile("vendor_exports/R_test.anisotropicbsdf");
    if (!file) return;
    const auto bytes = readFile(*file);
    ASSERT_TRUE(bytes);
    const auto read = parsed(*bytes);
    const SphericalTable& table = read.content;
    ASSERT_EQ(table.blocks.size(), 19U);
    EXPECT_EQ(table.blocks.front().incidenceDeg, 5);
    EXPECT_EQ(table.blocks.back().incidenceDeg, 89);
    EXPECT_EQ(table.blocks[0].thetaDeg.size(), 21U);
    EXPECT_EQ(table.blocks[0].azimuthDeg.size(), 41U);
    EXPECT_EQ(table.mirrorAzimuthDeg, 180);
    EXPECT_TRUE(read.warnings.empty());
    EXPECT_EQ(read.about.at(kSpeosSpectrum), "350 62.27, 1600 62.27");
    EXPECT_EQ(table.blocks[0].f[0], 0.278518);
    // The spectrum is measured at 6 degrees, between the first two tables: it is their integral, so
    // that these are intensities, and nothing was mistaken for something else.
    EXPECT_NEAR(blockIntegral(table, table.blocks[0]), 0.6227, 0.01);
    EXPECT_NEAR(blockIntegral(table, table.blocks[1]), 0.6227, 0.01);
    for (const SphericalBlock& block : table.blocks) {
        EXPECT_LT(blockIntegral(table, block), 1);
        for (std::size_t a = 0; a < 41; ++a) {  // symmetrical about the plane of incidence
            for (std::size_t t = 0; t < 20; ++t) {
                EXPECT_EQ(block.f[block.index(a, t)], block.f[block.index(40 - a, t)]);
            }
        }
    }
}

}  // namespace
}  // namespace gonio::proc
