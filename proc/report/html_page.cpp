#include "proc/report/html_page.h"

#include <algorithm>

#include "proc/report/markup_text.h"

namespace gonio::proc {
namespace {

/// Figures keep their white paper in the dark; print is always light.
constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; --ink: #1d2733; --paper: #ffffff; --faint: #5c6773;
  --line: #d5dae0; --shade: #f3f5f7; --good: #1b7f3b; --doubtful: #9a6400; --bad: #b3261e;
  --link: #1f5fa8; }
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #dde3ea; --paper: #14181d; --faint: #9aa5b1; --line: #323a44; --shade: #1d232a;
    --good: #6fcf8b; --doubtful: #f0b453; --bad: #ff8f86; --link: #86b7f0; } }
body { margin: 0 auto; max-width: 60rem; padding: 1.5rem; color: var(--ink);
  background: var(--paper); font: 15px/1.5 system-ui, "DejaVu Sans", Arial, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 .8rem; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 .6rem; padding-top: .5rem;
  border-top: 2px solid var(--line); }
h3 { font-size: 1rem; margin: 1.4rem 0 .4rem; }
p { margin: .5rem 0; max-width: 48rem; }
a { color: var(--link); }
nav { display: flex; flex-wrap: wrap; gap: .2rem 1rem; font-size: .9rem; margin-bottom: 1rem; }
div { overflow-x: auto; }
table { border-collapse: collapse; margin: .6rem 0 1rem; font-size: .87rem;
  font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--faint); padding: .2rem 0; }
th, td { text-align: left; vertical-align: top; padding: .25rem .7rem .25rem .35rem;
  border-bottom: 1px solid var(--line); overflow-wrap: break-word; }
th { font-weight: 600; }
.facts td { overflow-wrap: anywhere; }
.facts th { width: 13rem; }
thead th { background: var(--shade); }
.good { color: var(--good); font-weight: 600; white-space: nowrap; }
.doubtful { color: var(--doubtful); font-weight: 600; white-space: nowrap; }
.bad { color: var(--bad); font-weight: 600; white-space: nowrap; }
figure { margin: 1rem 0; }
figure svg { display: block; box-sizing: border-box; max-width: 100%; height: auto;
  background: #ffffff; border: 1px solid var(--line); }
figcaption { font-size: .87rem; color: var(--faint); max-width: 48rem; margin-top: .3rem; }
@page { size: A4; margin: 16mm 14mm; }
@media print { html { font-size: 10.5px; }
  body { max-width: none; padding: 0; font-size: 1rem; } nav { display: none; }
  div { overflow: visible; } h2, h3, caption { break-after: avoid; }
  tr, figure { break-inside: avoid; } thead { display: table-header-group; }
  figure svg { max-height: 225mm; } a { color: inherit; text-decoration: none; } }
)";

std::string_view className(CellTone tone) {
    switch (tone) {
        case CellTone::Plain: return "";
        case CellTone::Good: return "good";
        case CellTone::Doubtful: return "doubtful";
        case CellTone::Bad: return "bad";
    }
    return "";
}

std::string element(std::string_view name, std::string_view words) {
    const std::string tag(name);
    return "<" + tag + ">" + markupText(words) + "</" + tag + ">";
}

std::string rowHead(std::string_view words) {
    return "<th scope=\"row\">" + markupText(words) + "</th>";
}

std::string rowOf(const std::vector<HtmlCell>& cells) {
    std::string text = "<tr>";
    for (const HtmlCell& cell : cells) {
        const std::string_view tone = className(cell.tone);
        if (&cell == &cells.front()) {
            text += rowHead(cell.words);
        } else {
            text += tone.empty() ? "<td>" : "<td class=\"" + std::string(tone) + "\">";
            text += markupText(cell.words) + "</td>";
        }
    }
    return text + "</tr>\n";
}

}  // namespace

void HtmlTable::add(const std::vector<std::string>& words) {
    std::vector<HtmlCell> row;
    row.reserve(words.size());
    for (const std::string& one : words) row.push_back({one});
    rows.push_back(std::move(row));
}

HtmlPage::HtmlPage(std::string_view title) : title_(title) {}

void HtmlPage::section(std::string_view id, std::string_view heading) {
    const std::string anchor = markupText(id);
    if (open_) body_ += "</section>\n";
    open_ = true;
    contents_ += "<a href=\"#" + anchor + "\">" + markupText(heading) + "</a>\n";
    body_ += "<section id=\"" + anchor + "\">\n" + element("h2", heading) + "\n";
}

void HtmlPage::heading(std::string_view words) { body_ += element("h3", words) + "\n"; }

void HtmlPage::paragraph(std::string_view words) { body_ += element("p", words) + "\n"; }

void HtmlPage::table(const HtmlTable& table) {
    if (table.rows.empty()) {
        paragraph(table.caption + ": none");
        return;
    }
    body_ += "<div><table>\n" + element("caption", table.caption) + "\n<thead><tr>";
    for (const std::string& one : table.head)
        body_ += "<th scope=\"col\">" + markupText(one) + "</th>";
    body_ += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) body_ += rowOf(row);
    body_ += "</tbody></table></div>\n";
}

void HtmlPage::facts(const Facts& facts) {
    if (facts.empty()) return;
    body_ += "<div><table class=\"facts\"><tbody>\n";
    for (const auto& [name, words] : facts)
        body_ += "<tr>" + rowHead(name) + element("td", words) + "</tr>\n";
    body_ += "</tbody></table></div>\n";
}

void HtmlPage::figure(std::string_view svg, std::string_view caption) {
    body_ += "<figure>\n" + std::string(svg) + element("figcaption", caption) + "\n</figure>\n";
}

std::string HtmlPage::document() const {
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n" +
           element("title", title_) + "\n<style>" + std::string(kStyle) + "</style>\n</head>\n" +
           "<body>\n" + element("h1", title_) + "\n<nav>\n" + contents_ + "</nav>\n" + body_ +
           (open_ ? "</section>\n" : "") + "</body>\n</html>\n";
}

}  // namespace gonio::proc
