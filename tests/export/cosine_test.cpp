#include "proc/export/cosine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "proc/export/conversion.h"
#include "proc/export/source_of.h"

namespace gonio::proc {
namespace {

/// f cos(theta_o) = 0.1 at a view of 60 degrees.
const std::string kAlta =
    "#DIM 3 1\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n"
    "1.0471975511965976 0.5 3 0.1\n";
/// At 60 degrees, and on this side and that of the floor.
const std::string kCsv =
    "theta_i,phi_i,theta_o,phi_o,f,u\n30,0,60,180,0.1,0.01\n30,0,89,180,0.1,0.01\n"
    "30,0,89.5,180,0.1,0.01\n30,0,89.6,180,0,\n30,0,89.6,180,,\n";

BrdfFile decoded(Format format, const std::string& text) {
    auto file = decodeBrdf(format, text, "in");
    EXPECT_TRUE(file) << (file ? "" : file.error().message);
    return file ? std::move(*file) : BrdfFile{};
}
BrdfFile told(BrdfFile file, bool holds) {
    auto made = withCosineTold(std::move(file), holds);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : BrdfFile{};
}
double firstF(const BrdfFile& file) {
    const auto* rows = file.as<BrdfRows>();
    EXPECT_NE(rows, nullptr);
    return rows == nullptr ? std::nan("") : rows->f.front();
}

TEST(Cosine, IsDividedByOnceWhereTheFileSaysThatItIsThere) {
    const BrdfFile file = decoded(Format::Alta, kAlta);
    EXPECT_NEAR(firstF(file), 0.2, 1e-15);
    EXPECT_NEAR(firstF(told(file, true)), 0.2, 1e-15);
    EXPECT_NEAR(firstF(told(file, false)), 0.1, 1e-15);
    EXPECT_NEAR(firstF(told(told(file, false), true)), 0.2, 1e-15);
}

TEST(Cosine, OfADsfIsKnownToo) {
    const BrdfFile file =
        decoded(Format::Pab, "#intheta 30\n#inphi 0\n#format: theta phi DSF\n60 180 0.1\n");
    EXPECT_NEAR(firstF(file), 0.2, 1e-15);
    EXPECT_NEAR(firstF(told(file, true)), 0.2, 1e-15);
    EXPECT_NEAR(firstF(told(file, false)), 0.1, 1e-15);
}

TEST(Cosine, OfASpeosIntensityIsKnownToo) {
    const std::string text =
        "OPTIS - brdf surface file v3.0\n0\n\n0\n\n1 0\nKIND\n1 1\n30\n550\n10\n2 2\n0 180\n"
        "0 0.5 0.5\n60 0.1 0.1\n";
    for (const bool intensity : {true, false}) {
        std::string own = text;
        own.replace(own.find("KIND"), 4, intensity ? "0" : "1");
        const BrdfFile file = decoded(Format::Speos, own);
        ASSERT_NE(file.as<SphericalTable>(), nullptr);
        const auto at60 = [](const BrdfFile& one) {
            const SphericalBlock& block = one.as<SphericalTable>()->blocks.front();
            return block.f[block.index(0, 1)];
        };
        EXPECT_NEAR(at60(file), intensity ? 0.2 : 0.1, 1e-15);
        EXPECT_NEAR(at60(told(file, true)), 0.2, 1e-15);
        EXPECT_NEAR(at60(told(file, false)), 0.1, 1e-15);
    }
}

TEST(Cosine, IsDividedByWhereTheUserSaysSo) {
    const BrdfFile file = decoded(Format::Csv, kCsv);
    EXPECT_EQ(firstF(told(file, false)), 0.1);
    const BrdfFile divided = told(file, true);
    const BrdfRows& rows = *divided.as<BrdfRows>();
    EXPECT_NEAR(rows.f[0], 0.2, 1e-15);
    EXPECT_NEAR(rows.uRandom[0], 0.02, 1e-15);
    EXPECT_NEAR(rows.f[1], 0.1 / std::cos(89 * kPi / 180), 1e-12);
    EXPECT_TRUE(std::isnan(rows.f[2]));
    EXPECT_TRUE(std::isnan(rows.f[3]));
    // A value of 0 loses nothing, and an uncertainty is no value of its own.
    ASSERT_EQ(divided.warnings.size(), 1U);
    EXPECT_TRUE(divided.warnings[0].starts_with("1 values too close to the horizon"));
}

/// What is written is f: told again that it holds the cosine, it is divided.
TEST(Cosine, IsNotSaidOfWhatIsWritten) {
    for (const Format to : {Format::Csv, Format::Alta, Format::Astm, Format::Bird}) {
        const auto source = sourceOf(decoded(Format::Alta, kAlta), {});
        ASSERT_TRUE(source);
        const auto files = convertTo(*source, {.to = to});
        ASSERT_TRUE(files) << files.error().message;
        const BrdfFile back = decoded(to, files->front().bytes);
        EXPECT_EQ(back.about.at(key::kCosine), "") << name(to);
        EXPECT_NEAR(firstF(back), 0.2, 1e-12);
        EXPECT_NEAR(firstF(told(back, true)), 0.4, 1e-12);
    }
}

TEST(Cosine, IsNoQuestionWhereTheFormatAnswersIt) {
    const auto refused = withCosineTold(BrdfFile{.content = SampleSet{}}, true);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    EXPECT_FALSE(
        withCosineTold(BrdfFile{.format = Format::Utia, .content = SphericalTable{}}, true));
}

}  // namespace
}  // namespace gonio::proc
