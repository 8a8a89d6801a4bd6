#include "proc/report/svg.h"

#include <gtest/gtest.h>

#include "tests/report/pictures.h"
#include "tests/report/xml.h"

namespace gonio::proc {
namespace {

using test::readXml;
using test::Xml;

TEST(XmlReader, TakesWhatIsWellFormed) {
    const Xml xml = readXml("<a x=\"1\" y=\"\"><b/>t &lt;&amp;<c z=\"&quot;\">u</c></a>\n");
    EXPECT_EQ(xml.fault, "");
    ASSERT_EQ(xml.elements.size(), 3U);
    EXPECT_EQ(xml.elements[0].text, "t <&");
    EXPECT_EQ(xml.elements[2].at("z"), "\"");
}

TEST(XmlReader, SeesEachKindOfFault) {
    for (const char* bad : {"",
                            "t",
                            "<a>",
                            "<a></b>",
                            "<a><b></a></b>",
                            "</a>",
                            "<a/><a/>",
                            "<a/>t",
                            "<a x=1/>",
                            "<a x=\"1/>",
                            "<a x=\"<\"/>",
                            "<a x=\"1\"y=\"2\"/>",
                            "<a x=\"1\" x=\"2\"/>",
                            "<a x/>",
                            "<a",
                            "<>",
                            "<a>&</a>",
                            "<a>&x;</a>",
                            "<a>\x01</a>"}) {
        EXPECT_NE(readXml(bad).fault, "") << bad;
    }
}

TEST(Svg, IsAWhiteSheetOfItsSize) {
    const Xml xml = test::readPicture(Svg(120, 40.5).document());
    ASSERT_EQ(xml.elements.size(), 2U);
    EXPECT_EQ(xml.elements[0].name, "svg");
    EXPECT_EQ(xml.elements[0].at("xmlns"), "http://www.w3.org/2000/svg");
    EXPECT_EQ(xml.elements[0].at("viewBox"), "0 0 120.0 40.5");
    EXPECT_EQ(xml.elements[1].at("fill"), "#fff");
}

TEST(Svg, DrawsInTheOrderOfTheCalls) {
    Svg svg(100, 100);
    svg.line({1, 2}, {3, 4}, {.colour = "#111", .width = 2, .dash = "3 3"});
    svg.polyline({{5, 6}, {7, 8}, {9, 10}}, {});
    svg.polygon({{11, 12}, {13, 14}, {15, 16}}, "#222", 0.25);
    svg.circle({50, 51}, 7, {});
    svg.rectangle({20, 21}, {22, 23}, "#333");
    svg.runs("M1 1.5h3", "#444");
    svg.text({30, 31}, "words", Anchor::End, 9);
    const Xml xml = test::readPicture(svg.document());
    ASSERT_EQ(xml.elements.size(), 2U + 7);
    EXPECT_EQ(xml.elements[2].at("points"), "1.0,2.0 3.0,4.0 ");
    EXPECT_EQ(xml.elements[2].at("stroke-dasharray"), "3 3");
    EXPECT_EQ(xml.elements[3].attributes.count("stroke-dasharray"), 0U);
    EXPECT_EQ(xml.elements[4].at("fill-opacity"), "0.25");
    EXPECT_EQ(xml.elements[5].at("r"), "7.0");
    EXPECT_EQ(xml.elements[6].at("height"), "23.0");
    EXPECT_EQ(xml.elements[7].at("d"), "M1 1.5h3");
    EXPECT_EQ(xml.elements[7].at("shape-rendering"), "crispEdges");
    EXPECT_EQ(xml.elements[8].at("text-anchor"), "end");
    EXPECT_EQ(xml.elements[8].text, "words");
}

std::string throughText(std::string_view words) {
    Svg svg(1000, 100);
    svg.text({0, 20}, words);
    const Xml xml = readXml(svg.document());
    EXPECT_EQ(xml.fault, "") << words;
    return xml.fault.empty() ? xml.all("text").at(0).text : "";
}

TEST(Svg, TextComesBackAsItWent) {
    for (const char* words : {"",
                              "plain",
                              "</text><script>",
                              "a & b &amp; \"c\" 'd' > e",
                              "]]>",
                              "\u03b8 22.5\u00b0 \u20ac \U0001F52C"}) {
        EXPECT_EQ(throughText(words), words);
    }
}

TEST(Svg, WhatNoXmlMayHoldBecomesAQuestionMark) {
    using namespace std::string_view_literals;
    EXPECT_EQ(throughText("a\0b\x01\x1f"sv), "a?b??");
    EXPECT_EQ(throughText("caf\xe9"), "caf?");  // Latin-1
    EXPECT_EQ(throughText("a\x80z"), "a?z");    // a continuation alone
    EXPECT_EQ(throughText("\xc3"), "?");        // cut in the middle of a letter
    EXPECT_EQ(throughText("\xe2\x82"), "??");   //
    EXPECT_EQ(throughText("\xc0\xaf"), "??");   // overlong '/'
    EXPECT_EQ(throughText("\xe0\x80\xaf").find('/'), std::string::npos);
    EXPECT_EQ(throughText("\xed\xa0\x80"), "?");      // a surrogate
    EXPECT_EQ(throughText("\xef\xbf\xbe"), "?");      // U+FFFE
    EXPECT_EQ(throughText("\xf4\x90\x80\x80"), "?");  // beyond U+10FFFF
    EXPECT_EQ(throughText("\xed\x9f\xbf\xee\x80\x80\xf4\x8f\xbf\xbd"),
              "\xed\x9f\xbf\xee\x80\x80\xf4\x8f\xbf\xbd");  // beside each edge
}

std::string throughTitle(const std::string& words) {
    Svg svg(300, 100);
    svg.title({40, 24}, words);
    return test::readPicture(svg.document()).all("text").at(0).text;
}

TEST(Svg, ATitleIsCutWhereThePictureEnds) {
    EXPECT_EQ(throughTitle("AnoBlack"), "AnoBlack");
    const std::size_t room = throughTitle(std::string(1000, 'W')).size();
    EXPECT_EQ(room, 26U);  // 260 units of 0.65 x 15
    EXPECT_EQ(throughTitle(std::string(room, 'W')), std::string(room, 'W'));
    EXPECT_EQ(throughTitle(std::string(room + 1, 'W')), std::string(room - 3, 'W') + "...");
}

TEST(Svg, ATitleIsCutBetweenLettersAndNeverInOne) {
    std::string thetas;
    for (int i = 0; i < 40; ++i) thetas += "\u03b8";
    Svg svg(300, 100);
    svg.title({40, 24}, thetas);
    const std::string text = readXml(svg.document()).all("text").at(0).text;
    EXPECT_EQ(text, thetas.substr(0, std::size_t{2} * 23) + "...");
}

TEST(Svg, ATitleWithoutRoomIsStillADocument) {
    Svg svg(10, 30);
    svg.title({40, 24}, "beside the picture");
    EXPECT_EQ(readXml(svg.document()).fault, "");
}

}  // namespace
}  // namespace gonio::proc
