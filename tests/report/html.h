#pragma once
// What holds of every HTML page that we write.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/report/xml.h"

namespace gonio::test {

/// Well-formed behind its first line, without script, and asking for nothing from elsewhere.
inline Xml readHtml(const std::string& document) {
    const std::string first = "<!DOCTYPE html>\n";
    EXPECT_TRUE(document.starts_with(first));
    Xml xml = readXml(document.substr(std::min(first.size(), document.size())));
    EXPECT_EQ(xml.fault, "");
    for (const XmlElement& element : xml.elements) {
        EXPECT_NE(element.name, "script");
        for (const auto& [key, value] : element.attributes) {
            EXPECT_FALSE(key.starts_with("on")) << key;
            EXPECT_NE(key, "src");
            const bool within = value.starts_with("#") || value.starts_with("data:image/png;");
            EXPECT_TRUE(key != "href" || within) << value;
        }
        if (element.name != "style") continue;
        EXPECT_EQ(element.text.find("url("), std::string::npos);
        EXPECT_EQ(element.text.find("@import"), std::string::npos);
    }
    return xml;
}

/// All words that a reader sees, with a blank between elements.
inline std::string wordsOf(const Xml& xml) {
    std::string words;
    for (const XmlElement& element : xml.elements) words += element.text + " ";
    return words;
}

}  // namespace gonio::test
