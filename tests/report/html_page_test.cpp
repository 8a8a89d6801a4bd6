#include "proc/report/html_page.h"

#include <gtest/gtest.h>

#include "tests/report/html.h"

namespace gonio::proc {
namespace {

using test::readHtml;
using test::Xml;

TEST(HtmlPage, IsWellFormedAndNeedsNothingElse) {
    HtmlPage page("A title");
    page.section("one", "First");
    page.heading("within");
    page.paragraph("words");
    HtmlTable table{.caption = "a table", .head = {"name", "value"}, .rows = {}};
    table.add({"x", "1"});
    table.rows.push_back({{"y"}, {"bad", CellTone::Bad}});
    page.table(table);
    page.facts({{"key", "fact"}});
    page.section("two", "Second");
    page.figure("<svg xmlns=\"http://www.w3.org/2000/svg\"><g/></svg>", "a picture");
    const Xml xml = readHtml(page.document());
    EXPECT_EQ(xml.all("section").size(), 2U);
    EXPECT_EQ(xml.all("a").at(1).at("href"), "#two");
    EXPECT_EQ(xml.all("title").at(0).text, "A title");
    EXPECT_EQ(xml.all("th").size(), 2U + 2 + 1);
    EXPECT_EQ(xml.all("td").at(1).at("class"), "bad");
    EXPECT_EQ(xml.all("figcaption").at(0).text, "a picture");
    EXPECT_EQ(readHtml(HtmlPage("empty").document()).all("section").size(), 0U);
}

TEST(HtmlPage, EscapesAllWordsAndSaysThatATableIsEmpty) {
    const std::string hostile = "</table><script>alert(\"1\")</script>&amp; \xC3\xA9\x01\xFF";
    const std::string shown = "</table><script>alert(\"1\")</script>&amp; \xC3\xA9??";
    HtmlPage page(hostile);
    page.section("a\"b", hostile);
    page.heading(hostile);
    page.paragraph(hostile);
    page.facts({{hostile, hostile}});
    HtmlTable table{.caption = hostile, .head = {hostile}, .rows = {}};
    page.table(table);
    table.add({hostile, hostile});
    page.table(table);
    const Xml xml = readHtml(page.document());
    EXPECT_TRUE(xml.all("script").empty());
    for (const char* name : {"title", "h1", "h2", "h3", "a", "caption", "td", "th"})
        EXPECT_EQ(xml.all(name).at(0).text, shown) << name;
    EXPECT_EQ(xml.all("p").at(0).text, shown);
    EXPECT_EQ(xml.all("p").at(1).text, shown + ": none");
}

}  // namespace
}  // namespace gonio::proc
