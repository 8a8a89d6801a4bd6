#include "proc/formats/named_band.h"

#include <gtest/gtest.h>

#include <vector>

namespace gonio::proc {
namespace {

TEST(NamedBand, IsTheLastWordOfTheNameThatNamesOne) {
    EXPECT_EQ(bandOfName("x/paint_R.bsdf"), Band::R);
    EXPECT_EQ(bandOfName("red-cup Green.bsdf"), Band::G);
    EXPECT_EQ(bandOfName("g/Blue.bsdf"), Band::B);
    EXPECT_EQ(bandOfName("grey.bsdf"), std::nullopt);
}

TEST(NamedBand, IsWithin25NanometresOfTheWavelength) {
    EXPECT_EQ(bandOfWavelength(525), Band::G);
    EXPECT_EQ(bandOfWavelength(550), Band::G);
    EXPECT_EQ(bandOfWavelength(560), std::nullopt);
}

TEST(NamedBand, ReadsTheWavelengthFromWhatFilesSay) {
    const auto told = [](const std::string& comment) {
        return wavelengthIn(std::vector<std::string>{"a comment", comment});
    };
    EXPECT_EQ(told("Wavelength (nm) = 525"), 525);
    EXPECT_EQ(told("  Wavelength (nm) =525.0 "), 525);
    EXPECT_EQ(told("Light source: red laser (650 nm, 3.5mm spot diam.)"), 650);
    EXPECT_EQ(told("Light source: a lamp"), std::nullopt);
    EXPECT_EQ(told("Wavelength (nm) = red"), std::nullopt);
    EXPECT_EQ(told("Focal length 650 nm"), std::nullopt);
}

}  // namespace
}  // namespace gonio::proc
