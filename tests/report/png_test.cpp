#include "proc/report/png.h"

#include "tests/report/decoded_png.h"

namespace gonio::proc {
namespace {

TEST(Png, ReadsBackAsItsPixels) {
    const IndexedPicture picture{.width = 3,
                                 .height = 2,
                                 .pixels = {0, 1, 2, 2, 1, 0},
                                 .colours = {{255, 0, 16, 255}, {1, 2, 3, 255}, {0, 0, 0, 0}}};
    const auto png = encodePng(picture);
    ASSERT_TRUE(png) << png.error().message;
    const test::Decoded decoded = test::decodedPng(*png);
    EXPECT_EQ(decoded.width, 3);
    EXPECT_EQ(decoded.height, 2);
    EXPECT_EQ(decoded.colours,
              (std::vector<std::string>{"#ff0010", "#010203", "", "", "#010203", "#ff0010"}));
    EXPECT_EQ(*encodePng(picture), *png);
    EXPECT_EQ(test::decodedUri(pngUri(*png)).colours, decoded.colours);
}

TEST(Png, RefusesWhatIsNoPicture) {
    const IndexedPicture good{.width = 1, .height = 1, .pixels = {0}, .colours = {{}}};
    EXPECT_TRUE(encodePng(good));
    IndexedPicture bad = good;
    bad.width = 0;
    EXPECT_FALSE(encodePng(bad));
    bad = good;
    bad.pixels = {1};
    EXPECT_FALSE(encodePng(bad));
    bad = good;
    bad.pixels = {0, 0};
    EXPECT_FALSE(encodePng(bad));
    bad = good;
    bad.colours.clear();
    EXPECT_FALSE(encodePng(bad));
    bad.colours.resize(257);
    EXPECT_FALSE(encodePng(bad));
}

TEST(Png, IsWrittenInBase64) {
    // RFC 4648, 10.
    const std::string head = "data:image/png;base64,";
    EXPECT_EQ(pngUri(""), head);
    EXPECT_EQ(pngUri("f"), head + "Zg==");
    EXPECT_EQ(pngUri("fo"), head + "Zm8=");
    EXPECT_EQ(pngUri("foo"), head + "Zm9v");
    EXPECT_EQ(pngUri("foobar"), head + "Zm9vYmFy");
}

}  // namespace
}  // namespace gonio::proc
