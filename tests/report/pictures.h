#pragma once
// What holds of every plot, and scatterers that answer as a test wants.

#include <gtest/gtest.h>

#include <cctype>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "proc/core/scatterer.h"
#include "proc/report/svg.h"
#include "tests/report/xml.h"

namespace gonio::test {

class Answering : public Scatterer {
public:
    using Function = std::function<Answer(const LightView&)>;
    explicit Answering(Function function, BandCount bands = BandCount::Three)
        : function_(std::move(function)), bands_(bands) {}
    [[nodiscard]] Answer answer(const LightView& pair) const override { return function_(pair); }
    [[nodiscard]] BandCount bandCount() const override { return bands_; }

private:
    Function function_;
    BandCount bands_;
};

inline Answer same(double f) {
    Answer answer;
    answer.f = LedBands::all(f);
    return answer;
}

inline Answer nothing() { return Answer::none({Flag::Blocked}, Source::Measured); }

inline std::vector<proc::Point> pointsOf(const XmlElement& element) {
    std::istringstream text(element.at("points"));
    std::vector<proc::Point> points;
    proc::Point p;
    for (char comma = 0; text >> p.x >> comma >> p.y;) points.push_back(p);
    return points;
}

/// Left and right end of a text: running text in DejaVu Sans takes 0.48 of its size per letter,
/// the widest of our words 0.6.
inline std::pair<double, double> extentOf(const XmlElement& text) {
    const double width = 0.6 * text.number("font-size") * static_cast<double>(text.text.size());
    const double x = text.number("x");
    if (text.at("text-anchor") == "middle") return {x - width / 2, x + width / 2};
    return text.at("text-anchor") == "end" ? std::pair(x - width, x) : std::pair(x, x + width);
}

/// Nothing of the picture is cut off by its edges.
inline void expectInside(const Xml& xml) {
    const double width = xml.elements.at(0).number("width");
    const double height = xml.elements.at(0).number("height");
    const auto expectPoint = [&](double x, double y) {
        EXPECT_TRUE(x >= 0 && x <= width && y >= 0 && y <= height) << x << ", " << y;
    };
    for (const XmlElement& e : xml.elements) {
        for (const proc::Point& p : pointsOf(e)) expectPoint(p.x, p.y);
        if (e.name == "circle") {
            expectPoint(e.number("cx") - e.number("r"), e.number("cy") - e.number("r"));
            expectPoint(e.number("cx") + e.number("r"), e.number("cy") + e.number("r"));
        } else if (e.name == "rect" && !e.at("x").empty()) {
            expectPoint(e.number("x"), e.number("y"));
            expectPoint(e.number("x") + e.number("width"), e.number("y") + e.number("height"));
        } else if (e.name == "text") {
            expectPoint(extentOf(e).first, e.number("y") - e.number("font-size"));
            expectPoint(extentOf(e).second, e.number("y"));
        }
    }
}

/// No two texts of one line lie over each other.
inline void expectTextsApart(const Xml& xml) {
    const std::vector<XmlElement> texts = xml.all("text");
    for (std::size_t i = 0; i < texts.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (texts[i].at("y") != texts[j].at("y")) continue;
            const auto a = extentOf(texts[i]);
            const auto b = extentOf(texts[j]);
            EXPECT_TRUE(a.second < b.first || b.second < a.first)
                << texts[i].text << " over " << texts[j].text;
        }
    }
}

/// Well-formed, whole, legible, and all its numbers are numbers. The titles of tests hold no "nan"
/// or "inf".
inline Xml readPicture(const std::string& document) {
    Xml xml = readXml(document);
    EXPECT_EQ(xml.fault, "");
    std::string lower;
    for (const char c : document) lower += static_cast<char>(std::tolower(c));
    EXPECT_EQ(lower.find("nan"), std::string::npos);
    EXPECT_EQ(lower.find("inf"), std::string::npos);
    expectInside(xml);
    expectTextsApart(xml);
    return xml;
}

}  // namespace gonio::test
