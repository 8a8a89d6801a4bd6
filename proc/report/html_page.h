#pragma once
// One HTML file that needs nothing else: no script, no network, its styles within. Readable in
// light and dark, prints on A4. It is well-formed XML behind its first line. All words are escaped
// here.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::proc {

/// How a cell of a table looks.
enum class CellTone {
    Plain,
    Good,
    Doubtful,
    Bad
};

struct HtmlCell {
    std::string words;
    CellTone tone = CellTone::Plain;
};

struct HtmlTable {
    std::string caption;
    std::vector<std::string> head;
    std::vector<std::vector<HtmlCell>> rows;  ///< the first cell of each heads its row

    void add(const std::vector<std::string>& words);
};

/// Names and what they are; without a heading row.
using Facts = std::vector<std::pair<std::string, std::string>>;

class HtmlPage {
public:
    explicit HtmlPage(std::string_view title);

    /// Begins a part; `id` is for the list of contents: letters and '-'.
    void section(std::string_view id, std::string_view heading);
    void heading(std::string_view words);
    void paragraph(std::string_view words);
    /// Of a table without rows its caption as a paragraph, "none".
    void table(const HtmlTable& table);
    void facts(const Facts& facts);
    /// An SVG document; what it shows stands below.
    void figure(std::string_view svg, std::string_view caption);

    /// The whole document.
    [[nodiscard]] std::string document() const;

private:
    std::string title_;
    std::string contents_;
    std::string body_;
    bool open_ = false;
};

}  // namespace gonio::proc
