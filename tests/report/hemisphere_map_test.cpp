#include "proc/report/hemisphere_map.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "proc/report/colour_ramp.h"
#include "tests/report/decoded_png.h"
#include "tests/report/pictures.h"

namespace gonio::proc {
namespace {

using test::Answering;
using test::readPicture;
using test::readXml;
using test::same;
using test::Xml;
using test::XmlElement;

constexpr const char* kGrey = "#d8d8d8";
const std::vector<Radians> kFour{0_deg, 20_deg, 40_deg, 60_deg};
const std::string kDarkest = rampColour(0.5 / 64);
const std::string kLightest = rampColour(63.5 / 64);

Xml mapOf(const Answering& scatterer, const std::vector<Radians>& incidences = {0_deg}) {
    return readPicture(hemisphereMaps(scatterer, {.title = "a sample", .incidences = incidences}));
}

Answering::Function everywhere(double f) {
    return [f](const LightView&) { return same(f); };
}

struct Streak {
    double x = 0, y = 0, length = 0;
    std::string colour;
};

std::vector<Streak> runsOf(const Xml& xml) {
    std::vector<Streak> runs;
    for (const XmlElement& path : xml.all("path")) {
        std::istringstream text(path.at("d"));
        Streak run{.colour = path.at("stroke")};
        double x = 0, y = 0;
        for (char m = 0, h = 0; text >> m >> x >> y >> h;) {
            EXPECT_TRUE((m == 'M' || m == 'm') && h == 'h');
            run.x = m == 'M' ? x : run.x + run.length + x;
            run.y = m == 'M' ? y : run.y + y;
            EXPECT_TRUE(text >> run.length);
            runs.push_back(run);
        }
        EXPECT_TRUE(text.eof());
    }
    return runs;
}

std::set<std::string> coloursOf(const Xml& xml) {
    std::set<std::string> colours;
    for (const Streak& run : runsOf(xml)) colours.insert(run.colour);
    return colours;
}

/// The rims of the panels.
std::vector<XmlElement> rimsOf(const Xml& xml) {
    std::vector<XmlElement> rims;
    for (const XmlElement& circle : xml.all("circle")) {
        if (circle.at("stroke") == "#666") rims.push_back(circle);
    }
    return rims;
}

TEST(HemisphereMap, HasAPanelForEachIncidenceAndBand) {
    EXPECT_EQ(rimsOf(mapOf(Answering(everywhere(0.1)), kFour)).size(), 12U);
    EXPECT_EQ(rimsOf(mapOf(Answering(everywhere(0.1), BandCount::One), kFour)).size(), 4U);
    EXPECT_EQ(rimsOf(mapOf(Answering(everywhere(0.1)), {0_deg})).size(), 3U);
}

TEST(HemisphereMap, WithoutIncidencesIsAHeadingAlone) {
    for (BandCount bands : {BandCount::One, BandCount::Three}) {
        const Xml xml = mapOf(Answering(everywhere(0.1), bands), {});
        EXPECT_TRUE(xml.all("path").empty());
        EXPECT_TRUE(rimsOf(xml).empty());
        EXPECT_EQ(xml.all("text").at(0).text, "a sample");
        EXPECT_EQ(xml.all("rect").size(), 1U);  // the sheet; no scale of nothing
    }
}

TEST(HemisphereMap, EachPixelOfTheDiscIsColouredOnce) {
    int inside = 0;
    for (int y = -90; y <= 90; ++y) {
        for (int x = -90; x <= 90; ++x) inside += x * x + y * y < 90 * 90 ? 1 : 0;
    }
    // Stripes, and a hole: many runs of different colours.
    const Answering stripes([](const LightView& pair) {
        if (std::abs(pair.out.y()) < 0.2) return test::nothing();
        return same(std::exp(5 * std::sin(20 * pair.out.x())));
    });
    const Xml xml = mapOf(stripes);
    std::map<std::pair<double, double>, int> seen;
    for (const Streak& run : runsOf(xml)) {
        for (double x = run.x; x < run.x + run.length; ++x) ++seen[{x, run.y}];
    }
    EXPECT_EQ(seen.size(), 3U * static_cast<std::size_t>(inside));
    for (const auto& [at, count] : seen) ASSERT_EQ(count, 1) << at.first << ", " << at.second;
    EXPECT_GT(coloursOf(xml).size(), 20U);
}

TEST(HemisphereMap, NoAnswerIsGreyAndNeverTheColourOfZero) {
    const Xml none = mapOf(Answering([](const LightView&) { return test::nothing(); }), kFour);
    EXPECT_EQ(coloursOf(none), std::set<std::string>{kGrey});
    EXPECT_EQ(coloursOf(mapOf(Answering(everywhere(0)))), std::set<std::string>{kDarkest});
}

TEST(HemisphereMap, WhatIsNoFiniteNumberIsGrey) {
    for (double f :
         {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(coloursOf(mapOf(Answering(everywhere(f)))), std::set<std::string>{kGrey});
    }
}

TEST(HemisphereMap, AMissingBandLeavesTheOthers) {
    const Answering noGreen([](const LightView&) {
        Answer answer = same(0.1);
        answer.f[Band::G] = std::numeric_limits<double>::quiet_NaN();
        return answer;
    });
    const Xml xml = mapOf(noGreen);
    const std::vector<XmlElement> rims = rimsOf(xml);
    ASSERT_EQ(rims.size(), 3U);
    for (const Streak& run : runsOf(xml)) {
        const bool green = std::abs(run.x - rims[1].number("cx")) <= 91;
        EXPECT_EQ(run.colour == kGrey, green);
    }
}

TEST(HemisphereMap, NegativeValuesTakeTheDarkestColour) {
    const Answering half(
        [](const LightView& pair) { return same(pair.out.y() > 0 ? 0.999 : -0.5); });
    EXPECT_EQ(coloursOf(mapOf(half)), (std::set<std::string>{kDarkest, kLightest}));
    EXPECT_EQ(coloursOf(mapOf(Answering(everywhere(-1)), kFour)), std::set<std::string>{kDarkest});
}

TEST(HemisphereMap, AllPanelsShareOneScale) {
    const Answering dimAtTheNormal(
        [](const LightView& pair) { return same(pair.in.theta() < 1_deg ? 1e-3 : 1); });
    EXPECT_EQ(coloursOf(mapOf(dimAtTheNormal, {0_deg, 60_deg})),
              (std::set<std::string>{kDarkest, kLightest}));
    // Alone, what is 1e-3 everywhere stands at the foot of its own decade.
    const Xml alone = mapOf(dimAtTheNormal, {0_deg});
    std::set<std::string> decades;
    for (const XmlElement& text : alone.all("text")) decades.insert(text.text);
    EXPECT_TRUE(decades.contains("1e-3") && decades.contains("1e-2"));
    EXPECT_FALSE(decades.contains("1e0"));
}

TEST(HemisphereMap, TheScaleSpansNoMoreThanAMillionthOfThePeak) {
    const Answering spike(
        [](const LightView& pair) { return same(pair.out.theta() < 2_deg ? 1e3 : 1e-12); });
    std::set<std::string> texts;
    for (const XmlElement& text : mapOf(spike).all("text")) texts.insert(text.text);
    EXPECT_TRUE(texts.contains("1e3") && texts.contains("1e-3"));
    EXPECT_FALSE(texts.contains("1e-4"));
}

TEST(HemisphereMap, PhiCountsCounterClockwiseFromTheLightOnTheRight) {
    // One quadrant answers: phi in (0, 90), to the right of the middle and above it.
    const Answering quadrant([](const LightView& pair) {
        return pair.out.x() > 1e-9 && pair.out.y() > 1e-9 ? same(1) : test::nothing();
    });
    const Xml xml = mapOf(quadrant, {40_deg});
    const std::vector<XmlElement> rims = rimsOf(xml);
    int coloured = 0;
    for (const Streak& run : runsOf(xml)) {
        if (run.colour == kGrey) continue;
        ++coloured;
        for (const XmlElement& rim : rims) {
            if (std::abs(run.x - rim.number("cx")) > 91) continue;
            EXPECT_GE(run.x, rim.number("cx") - 0.5);
            EXPECT_LT(run.y, rim.number("cy"));
        }
    }
    EXPECT_EQ(coloured, 3 * 89);  // rows of 1 to 89 degrees above the middle
    // The ring about the light, one unit per degree.
    int lights = 0;
    for (const XmlElement& circle : xml.all("circle")) {
        if (circle.at("stroke") != "#d35400") continue;
        const XmlElement& rim = rims.at(static_cast<std::size_t>(lights++));
        EXPECT_NEAR(circle.number("cx") - rim.number("cx"), 40, 1e-9);
        EXPECT_EQ(circle.at("cy"), rim.at("cy"));
    }
    EXPECT_EQ(lights, 3);
}

TEST(HemisphereMap, RadiusIsThetaInEqualSteps) {
    const Answering cap(
        [](const LightView& pair) { return same(pair.out.theta() < 30.5_deg ? 1 : 0.01); });
    double widest = 0;
    for (const Streak& run : runsOf(mapOf(cap))) {
        if (run.colour == kLightest) widest = std::max(widest, run.length);
    }
    EXPECT_EQ(widest, 61);  // -30 to 30 degrees
}

TEST(HemisphereMap, LightBelowTheHorizonHasNoRing) {
    const Xml xml = mapOf(Answering([](const LightView&) { return test::nothing(); }), {120_deg});
    EXPECT_EQ(coloursOf(xml), std::set<std::string>{kGrey});
    for (const XmlElement& circle : xml.all("circle")) EXPECT_NE(circle.at("stroke"), "#d35400");
}

/// Colours of the pixels of each panel, as runs or as a picture within; of none: "".
std::map<std::pair<double, double>, std::string> pixelsOf(const Xml& xml) {
    std::map<std::pair<double, double>, std::string> pixels;
    for (const Streak& run : runsOf(xml)) {
        for (double x = run.x; x < run.x + run.length; ++x) pixels[{x, run.y - 0.5}] = run.colour;
    }
    for (const XmlElement& image : xml.all("image")) {
        const test::Decoded png = test::decodedUri(image.at("href"));
        EXPECT_EQ(png.width, image.number("width"));
        for (std::size_t i = 0; i < png.colours.size(); ++i) {
            if (png.colours[i].empty()) continue;
            const std::size_t across = static_cast<std::size_t>(png.width);
            pixels[{image.number("x") + static_cast<double>(i % across),
                    image.number("y") + static_cast<double>(i / across)}] = png.colours[i];
        }
    }
    return pixels;
}

TEST(HemisphereMap, ThePictureWithinShowsWhatTheRunsShow) {
    const Answering waves([](const LightView& pair) {
        if (std::abs(pair.out.y()) < 0.2) return test::nothing();
        return same(std::exp(5 * std::sin(20 * pair.out.x())));
    });
    const PlotRequest runs{.title = "a sample", .incidences = {0_deg, 40_deg}};
    PlotRequest picture = runs;
    picture.embedded = true;
    const Xml within = readXml(hemisphereMaps(waves, picture));
    EXPECT_EQ(within.fault, "");
    EXPECT_EQ(within.all("image").size(), 6U);
    EXPECT_TRUE(within.all("path").empty());
    EXPECT_EQ(pixelsOf(within), pixelsOf(readXml(hemisphereMaps(waves, runs))));
}

TEST(HemisphereMap, HoldsTheSmallestAndTheLargestNumbers) {
    for (double f : {5e-324, DBL_MIN, 1e-30, 1e30, DBL_MAX}) {
        const Xml xml = mapOf(Answering(everywhere(f)));
        EXPECT_EQ(coloursOf(xml).size(), 1U) << f;
        EXPECT_FALSE(coloursOf(xml).contains(kGrey)) << f;
    }
    const Answering both(
        [](const LightView& pair) { return same(pair.out.x() > 0 ? DBL_MAX : 5e-324); });
    EXPECT_EQ(coloursOf(mapOf(both)).size(), 2U);
}

TEST(HemisphereMap, AnyTitleFits) {
    const std::string title = "<&\"'> " + std::string(500, 'M');
    for (BandCount bands : {BandCount::One, BandCount::Three}) {
        const Answering scatterer(everywhere(0.1), bands);
        const Xml xml = readPicture(hemisphereMaps(scatterer, {title, {22.5_deg}}));
        EXPECT_TRUE(xml.all("text").at(0).text.starts_with("<&\"'> MMM"));
    }
}

}  // namespace
}  // namespace gonio::proc
