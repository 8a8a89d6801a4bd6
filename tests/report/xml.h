#pragma once
// A small, strict reader of the XML that our plots are: elements, attributes, text and the four
// entities that they use. Anything else, and anything out of balance, is a fault.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::test {

struct XmlElement {
    std::string name;
    std::map<std::string, std::string> attributes;
    std::string text;  ///< directly inside it

    [[nodiscard]] std::string at(const std::string& key) const {
        const auto found = attributes.find(key);
        return found == attributes.end() ? "" : found->second;
    }
    [[nodiscard]] double number(const std::string& key) const { return std::stod(at(key)); }
};

struct Xml {
    std::vector<XmlElement> elements;  ///< in the order of their start tags
    std::string fault;                 ///< empty: well-formed

    [[nodiscard]] std::vector<XmlElement> all(std::string_view name) const {
        std::vector<XmlElement> found;
        for (const XmlElement& e : elements) {
            if (e.name == name) found.push_back(e);
        }
        return found;
    }
};

class XmlReader {
public:
    explicit XmlReader(std::string_view text) : rest_(text) {}

    [[nodiscard]] Xml read() {
        while (xml_.fault.empty() && !rest_.empty()) {
            if (rest_.starts_with("</")) {
                endTag();
            } else if (rest_.front() == '<') {
                startTag();
            } else {
                characters();
            }
        }
        if (xml_.fault.empty() && (!open_.empty() || xml_.elements.empty()))
            xml_.fault = "an element is not closed";
        return std::move(xml_);
    }

private:
    void fail(const std::string& why) {
        if (xml_.fault.empty())
            xml_.fault = why + " before '" + std::string(rest_.substr(0, 20)) + "'";
    }
    std::string_view take(std::size_t count) {
        const std::string_view head = rest_.substr(0, count);
        rest_.remove_prefix(head.size());
        return head;
    }
    bool skip(std::string_view word) {
        const bool there = rest_.starts_with(word);
        if (there) rest_.remove_prefix(word.size());
        return there;
    }
    std::string name() {
        std::size_t length = 0;
        const auto letter = [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                   c == '-';
        };
        while (length < rest_.size() && letter(rest_[length])) ++length;
        if (length == 0) fail("no name");
        return std::string(take(length));
    }
    bool space() {
        const std::size_t before = rest_.size();
        while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\n')) rest_.remove_prefix(1);
        return rest_.size() != before;
    }
    /// Entities resolved; ends before `stop` or '<'.
    std::string value(char stop) {
        std::string out;
        while (xml_.fault.empty() && !rest_.empty() && rest_[0] != stop && rest_[0] != '<') {
            if (static_cast<unsigned char>(rest_[0]) < 0x20 && rest_[0] != '\n') {
                fail("a control character");
            } else if (rest_[0] != '&') {
                out += take(1);
            } else if (skip("&amp;")) {
                out += '&';
            } else if (skip("&lt;")) {
                out += '<';
            } else if (skip("&gt;")) {
                out += '>';
            } else if (skip("&quot;")) {
                out += '"';
            } else {
                fail("a bare '&'");
            }
        }
        return out;
    }
    void startTag() {
        take(1);
        XmlElement element;
        element.name = name();
        if (open_.empty() && !xml_.elements.empty()) fail("a second root");
        while (xml_.fault.empty() && space() && !rest_.starts_with(">") &&
               !rest_.starts_with("/>")) {
            const std::string key = name();
            if (!skip("=\"")) fail("no value");
            const std::string content = value('"');
            if (!skip("\"")) fail("a value that does not end");
            if (!element.attributes.emplace(key, content).second) fail("an attribute twice");
        }
        const bool empty = skip("/>");
        if (!empty && !skip(">")) fail("a tag that does not end");
        if (!empty) open_.push_back(xml_.elements.size());
        xml_.elements.push_back(std::move(element));
    }
    void endTag() {
        take(2);
        const std::string closed = name();
        if (!skip(">")) fail("a tag that does not end");
        if (open_.empty() || xml_.elements[open_.back()].name != closed) {
            fail("</" + closed + "> closes nothing");
            return;
        }
        open_.pop_back();
    }
    void characters() {
        const std::string text = value('<');
        if (!open_.empty()) {
            xml_.elements[open_.back()].text += text;
        } else if (text.find_first_not_of("\n") != std::string::npos) {
            fail("text outside the root");
        }
    }

    std::string_view rest_;
    std::vector<std::size_t> open_;
    Xml xml_;
};

inline Xml readXml(std::string_view text) { return XmlReader(text).read(); }

}  // namespace gonio::test
