#include "proc/report/slice_plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <set>

#include "tests/report/pictures.h"

namespace gonio::proc {
namespace {

using test::Answering;
using test::pointsOf;
using test::readPicture;
using test::same;
using test::Xml;
using test::XmlElement;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kRed = "#c0392b";
constexpr const char* kGreen = "#1e8449";
constexpr const char* kBlue = "#1f5fa8";
constexpr const char* kMono = "#2c3e50";
constexpr double kRounding = 0.051;  // coordinates have one decimal
const std::vector<Radians> kFour{0_deg, 20_deg, 40_deg, 60_deg};

Xml sliceOf(const Answering& scatterer, const std::vector<Radians>& incidences = {30_deg}) {
    return readPicture(slicePlots(scatterer, {.title = "a sample", .incidences = incidences}));
}

Answering::Function everywhere(double f) {
    return [f](const LightView&) { return same(f); };
}

/// theta_o with the sign of the plot: negative on the light's side.
double signedDegrees(const LightView& pair) {
    return pair.out.x() > 0 ? -pair.out.theta().degrees() : pair.out.theta().degrees();
}

/// The curves of one colour; the legend's swatch, which stands above the panels, left out.
std::vector<std::vector<Point>> curvesOf(const Xml& xml, const std::string& colour) {
    std::vector<std::vector<Point>> curves;
    for (const XmlElement& line : xml.all("polyline")) {
        if (line.at("stroke") == colour && pointsOf(line).at(0).y > 80)
            curves.push_back(pointsOf(line));
    }
    return curves;
}

std::vector<XmlElement> textsOf(const Xml& xml, const std::string& words) {
    std::vector<XmlElement> found;
    for (const XmlElement& text : xml.all("text")) {
        if (text.text == words) found.push_back(text);
    }
    return found;
}

/// Where an angle stands in the first panel, by the labels of its axis.
double xOf(const Xml& xml, double degrees) {
    const double left = textsOf(xml, "-90").at(0).number("x");
    const double right = textsOf(xml, "90").at(0).number("x");
    return left + (right - left) * (degrees + 90) / 180;
}

/// Where a value stands, by the labels of two decades, which lie 4 above their texts.
double yOf(const Xml& xml, double f) {
    const double one = textsOf(xml, "1e0").at(0).number("y") - 4;
    const double tenth = textsOf(xml, "1e-1").at(0).number("y") - 4;
    return one + (one - tenth) * std::log10(f);
}

TEST(SlicePlot, HasACurveForEachIncidenceAndBand) {
    const Xml colour = sliceOf(Answering(everywhere(0.1)), kFour);
    for (const char* ink : {kRed, kGreen, kBlue}) EXPECT_EQ(curvesOf(colour, ink).size(), 4U);
    const Xml mono = sliceOf(Answering(everywhere(0.1), BandCount::One), kFour);
    EXPECT_EQ(curvesOf(mono, kMono).size(), 4U);
    EXPECT_TRUE(curvesOf(mono, kBlue).empty());
    EXPECT_EQ(textsOf(mono, "monochrome").size(), 1U);
}

TEST(SlicePlot, CurvesThatCoincideAllShow) {
    std::set<std::string> dashes;
    for (const XmlElement& line : sliceOf(Answering(everywhere(0.1))).all("polyline")) {
        if (line.at("stroke") == kRed || line.at("stroke") == kGreen || line.at("stroke") == kBlue)
            dashes.insert(line.at("stroke") + line.at("stroke-dasharray"));
    }
    EXPECT_EQ(dashes.size(), 3U);
    EXPECT_TRUE(dashes.contains(kRed));  // the lowest is solid, those above it are not
}

TEST(SlicePlot, WithoutIncidencesIsAHeadingAlone) {
    const Xml xml = sliceOf(Answering(everywhere(0.1)), {});
    EXPECT_TRUE(curvesOf(xml, kRed).empty());
    EXPECT_EQ(xml.all("text").at(0).text, "a sample");
    EXPECT_TRUE(textsOf(xml, "0").empty());
}

TEST(SlicePlot, ASingleIncidenceTakesHalfTheWidth) {
    const double one = sliceOf(Answering(everywhere(0.1)), {0_deg}).elements.at(0).number("width");
    const double two =
        sliceOf(Answering(everywhere(0.1)), {0_deg, 20_deg}).elements.at(0).number("width");
    EXPECT_LT(one, 0.6 * two);
}

TEST(SlicePlot, LeftIsTheLightsSide) {
    const Answering lit([](const LightView& pair) {
        return pair.out.x() * pair.in.x() > 1e-9 ? same(0.1) : test::nothing();
    });
    const Xml xml = sliceOf(lit, {30_deg});
    const auto curves = curvesOf(xml, kGreen);
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_NEAR(curves[0].front().x, xOf(xml, -89.5), kRounding);
    EXPECT_NEAR(curves[0].back().x, xOf(xml, -0.5), kRounding);
    // The line that marks the light stands there too.
    const auto light = curvesOf(xml, "#d35400");
    ASSERT_EQ(light.size(), 1U);
    EXPECT_NEAR(light[0].front().x, xOf(xml, -30), kRounding);
}

TEST(SlicePlot, LightBelowTheHorizonHasNoLine) {
    EXPECT_TRUE(curvesOf(sliceOf(Answering(everywhere(0.1)), {120_deg}), "#d35400").empty());
}

TEST(SlicePlot, FollowsFOnALogarithmicAxis) {
    const auto f = [](double degrees) { return std::pow(10, -1 - degrees / 90); };
    const Answering slope([&](const LightView& pair) { return same(f(signedDegrees(pair))); });
    const Xml xml = sliceOf(slope);
    const auto curves = curvesOf(xml, kRed);
    ASSERT_EQ(curves.size(), 1U);
    ASSERT_EQ(curves[0].size(), 359U);  // -89.5 to 89.5 in half degrees
    for (std::size_t i = 0; i < curves[0].size(); ++i) {
        const double degrees = -89.5 + 0.5 * static_cast<double>(i);
        EXPECT_NEAR(curves[0][i].x, xOf(xml, degrees), kRounding);
        // The labels' own places are rounded too, and stretched to the second decade.
        EXPECT_NEAR(curves[0][i].y, yOf(xml, f(degrees)), 4 * kRounding);
    }
}

TEST(SlicePlot, AGapBreaksTheCurve) {
    const Answering hole([](const LightView& pair) {
        return pair.out.theta() < 10.1_deg ? test::nothing() : same(0.1);
    });
    const Xml xml = sliceOf(hole);
    const auto curves = curvesOf(xml, kBlue);
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_NEAR(curves[0].back().x, xOf(xml, -10.5), kRounding);
    EXPECT_NEAR(curves[1].front().x, xOf(xml, 10.5), kRounding);
}

TEST(SlicePlot, WhatIsNoFiniteNumberAboveZeroBreaksTheCurve) {
    for (double f : {0.0, -0.1, kNan, kInf, -kInf}) {
        const Answering hole([f](const LightView& pair) {
            Answer answer = same(0.1);
            if (pair.out.theta() < 10_deg) answer.f[Band::G] = f;
            return answer;
        });
        const Xml xml = sliceOf(hole);
        EXPECT_EQ(curvesOf(xml, kGreen).size(), 2U) << f;
        EXPECT_EQ(curvesOf(xml, kRed).size(), 1U) << f;  // the other bands stay whole
    }
}

TEST(SlicePlot, NoAnswerAndNothingPositiveAreEmptyPanels) {
    for (const auto& f :
         {everywhere(-1), Answering::Function([](const LightView&) { return test::nothing(); })}) {
        const Xml xml = sliceOf(Answering(f), kFour);
        for (const char* ink : {kRed, kGreen, kBlue}) EXPECT_TRUE(curvesOf(xml, ink).empty());
        EXPECT_TRUE(xml.all("polygon").empty());
        EXPECT_EQ(textsOf(xml, "-90").size(), 4U);
    }
}

TEST(SlicePlot, AnAnswerAloneIsAsWideAsItsStep) {
    const Answering one([](const LightView& pair) {
        return std::abs(signedDegrees(pair) - 30) < 0.1 ? same(0.1) : test::nothing();
    });
    const Xml xml = sliceOf(one);
    const auto curves = curvesOf(xml, kRed);
    ASSERT_EQ(curves.size(), 1U);
    ASSERT_EQ(curves[0].size(), 2U);
    EXPECT_NEAR(curves[0][0].x, xOf(xml, 29.75), kRounding);
    EXPECT_NEAR(curves[0][1].x, xOf(xml, 30.25), kRounding);
}

/// f = 0.4 with these uncertainties.
Answer withU(std::optional<double> random, std::optional<double> systematic) {
    Answer answer = same(0.4);
    if (random) answer.uRandom = LedBands::all(*random);
    if (systematic) answer.uSystematic = LedBands::all(*systematic);
    return answer;
}

TEST(SlicePlot, ShadesPlusMinusTwoCombinedUncertainties) {
    const Answering known([](const LightView&) { return withU(0.03, 0.04); });
    const Xml xml = sliceOf(known);
    ASSERT_EQ(xml.all("polygon").size(), 3U);
    EXPECT_EQ(textsOf(xml, "shaded: +- 2 u").size(), 1U);
    for (const XmlElement& band : xml.all("polygon")) {
        const auto outline = pointsOf(band);
        ASSERT_EQ(outline.size(), 2U * 359);
        for (std::size_t i = 0; i < outline.size(); ++i) {
            // u = hypot(0.03, 0.04) = 0.05.
            EXPECT_NEAR(outline[i].y, yOf(xml, i < 359 ? 0.5 : 0.3), 4 * kRounding);
        }
    }
}

TEST(SlicePlot, EitherPartOfTheUncertaintyIsEnough) {
    const Xml random = sliceOf(Answering([](const LightView&) { return withU(0.05, {}); }));
    const Xml systematic = sliceOf(Answering([](const LightView&) { return withU({}, 0.05); }));
    ASSERT_EQ(random.all("polygon").size(), 3U);
    EXPECT_EQ(random.all("polygon").at(0).at("points"),
              systematic.all("polygon").at(0).at("points"));
}

TEST(SlicePlot, ShadesNothingWhereUIsNotKnown) {
    const Xml unknown = sliceOf(Answering([](const LightView&) { return withU({}, {}); }), kFour);
    EXPECT_TRUE(unknown.all("polygon").empty());
    EXPECT_TRUE(textsOf(unknown, "shaded: +- 2 u").empty());
    for (double u : {kNan, kInf}) {
        const Xml xml = sliceOf(Answering([u](const LightView&) { return withU(u, 0.01); }));
        EXPECT_TRUE(xml.all("polygon").empty()) << u;
    }
}

TEST(SlicePlot, TheShadeEndsWhereKnowledgeOfUEnds) {
    const Answering half(
        [](const LightView& pair) {
            const double at = signedDegrees(pair);
            return at < -40 || at > 20 ? withU(0.05, 0.0) : withU({}, {});
        },
        BandCount::One);
    const Xml xml = sliceOf(half);
    EXPECT_EQ(curvesOf(xml, kMono).size(), 1U);  // the curve itself goes on
    const auto bands = xml.all("polygon");
    ASSERT_EQ(bands.size(), 2U);
    for (const Point& p : pointsOf(bands[0])) EXPECT_LE(p.x, xOf(xml, -40.5) + kRounding);
    for (const Point& p : pointsOf(bands[1])) EXPECT_GE(p.x, xOf(xml, 20) - kRounding);
}

TEST(SlicePlot, AShadeBelowZeroEndsAtTheBottom) {
    const Answering uncertain([](const LightView&) { return withU(10, 0); });
    const Xml xml = sliceOf(uncertain);
    const auto outline = pointsOf(xml.all("polygon").at(0));
    EXPECT_NEAR(outline.front().y, yOf(xml, 1), kRounding);   // 20.4 is above the axis
    EXPECT_NEAR(outline.back().y, yOf(xml, 0.1), kRounding);  // and -19.6 below it
}

TEST(SlicePlot, BelowEightDecadesACurveRunsAlongTheBottom) {
    const Answering steep(
        [](const LightView& pair) { return same(signedDegrees(pair) < 0 ? 1e-100 : 1); });
    const Xml xml = sliceOf(steep);
    EXPECT_EQ(textsOf(xml, "1e-8").size(), 1U);
    EXPECT_TRUE(textsOf(xml, "1e-9").empty());
    EXPECT_NEAR(
        curvesOf(xml, kRed).at(0).front().y, textsOf(xml, "1e-8").at(0).number("y") - 4, kRounding);
}

TEST(SlicePlot, HoldsTheSmallestAndTheLargestNumbers) {
    for (double f : {5e-324, DBL_MIN, 1e-30, 1e30, DBL_MAX}) {
        const Answering extreme([f](const LightView&) {
            Answer answer = same(f);
            answer.uRandom = LedBands::all(f);
            return answer;
        });
        EXPECT_EQ(curvesOf(sliceOf(extreme), kRed).size(), 1U) << f;
    }
}

TEST(SlicePlot, AnyTitleFits) {
    const std::string title = "<&\"'> " + std::string(500, 'M');
    for (const auto& incidences : {std::vector<Radians>{0_deg}, kFour}) {
        const Answering scatterer([](const LightView&) { return withU(0.05, 0); });
        const Xml xml = readPicture(slicePlots(scatterer, {title, incidences}));
        EXPECT_TRUE(xml.all("text").at(0).text.starts_with("<&\"'> MMM"));
    }
}

}  // namespace
}  // namespace gonio::proc
