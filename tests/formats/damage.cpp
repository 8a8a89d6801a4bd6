#include "tests/formats/damage.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

namespace gonio::test {
namespace {

constexpr std::size_t kMegabyte = 1'000'000;

/// Of every kind of text, and what nests in some.
constexpr std::string_view kWords[] = {"[",  "{\"a\":", "<a>",  "(",         "#",   "\"", "\\",
                                       "\n", "\r",      "\t",   ",",         ";",   "1 ", "1\n",
                                       "1,", "&",       "<!--", "a=\"b\"\n", "[1,", "- "};

struct Span {
    std::size_t begin = 0, end = 0;
};

std::string with(std::string_view sound, Span span, std::string_view instead) {
    std::string bytes(sound.substr(0, span.begin));
    return bytes.append(instead).append(sound.substr(span.end));
}

/// At most `most` of them, evenly.
std::vector<Span> some(const std::vector<Span>& all, std::size_t most) {
    std::vector<Span> chosen;
    for (std::size_t i = 0; i < std::min(most, all.size()); ++i) {
        chosen.push_back(all[all.size() <= most ? i : i * all.size() / most]);
    }
    return chosen;
}

std::vector<Span> numbersOf(std::string_view text) {
    const auto inNumber = [](char c) {
        return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.';
    };
    std::vector<Span> spans;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t begin = i;
        while (i < text.size() && inNumber(text[i])) ++i;
        if (i > begin) spans.push_back({begin, i});
        if (i == begin) ++i;
    }
    return spans;
}

/// With their ends.
std::vector<Span> linesOf(std::string_view text) {
    std::vector<Span> spans;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        spans.push_back({begin, end});
        begin = end;
    }
    return spans;
}

std::set<std::string> wordsOf(std::string_view text) {
    std::set<std::string> words;
    std::string word;
    for (const char c : text) {
        if (std::isspace(static_cast<unsigned char>(c)) == 0) {
            word += c;
        } else if (!word.empty()) {
            words.insert(std::exchange(word, ""));
        }
    }
    return words;
}

std::string repeated(std::string_view word) {
    std::string bytes;
    bytes.reserve(kMegabyte);
    while (bytes.size() + word.size() <= kMegabyte) bytes += word;
    return bytes;
}

std::string replacedAll(std::string_view text, std::string_view from, std::string_view to) {
    std::string out;
    for (std::size_t at = 0;;) {
        const std::size_t next = text.find(from, at);
        out += text.substr(at, next - at);
        if (next == std::string_view::npos) return out;
        out += to;
        at = next + from.size();
    }
}

std::string inQuotes(std::string_view word) { return "'" + std::string(word.substr(0, 20)) + "'"; }

}  // namespace

std::vector<Damaged> truncated(std::string_view sound) {
    std::vector<Damaged> all;
    for (std::size_t part = 0; part < 50; ++part) {
        const std::size_t length = sound.size() * part / 50;
        all.push_back({"the first " + std::to_string(length) + " bytes",
                       std::string(sound.substr(0, length))});
    }
    for (std::size_t less = 1; less <= std::min<std::size_t>(8, sound.size()); ++less) {
        all.push_back({"without the last " + std::to_string(less) + " bytes",
                       std::string(sound.substr(0, sound.size() - less))});
    }
    return all;
}

std::vector<Damaged> extended(std::string_view sound) {
    using namespace std::string_literals;
    std::vector<Damaged> all;
    const std::string file(sound);
    for (const std::string& junk : {"junk"s, " 1"s, "\n1 2 3\n"s, "\0"s, "\xff\xfe"s, file}) {
        all.push_back({"with " + std::to_string(junk.size()) + " bytes behind", file + junk});
    }
    for (const std::string& mark : {"\xef\xbb\xbf"s, "\xff\xfe"s, " \n"s, "\0"s, "junk\n"s}) {
        all.push_back({"with " + std::to_string(mark.size()) + " bytes before", mark + file});
    }
    all.push_back({"empty", ""});
    all.push_back({"a byte order mark", "\xef\xbb\xbf"});
    all.push_back({"zeros", std::string(kMegabyte, '\0')});
    return all;
}

std::vector<Damaged> withBadNumbers(std::string_view sound) {
    constexpr std::string_view kBad[] = {"nan",
                                         "inf",
                                         "-inf",
                                         "1e999",
                                         "1,5",
                                         "banana",
                                         "-1",
                                         "0",
                                         "4294967296",
                                         "9223372036854775807",
                                         "18446744073709551616",
                                         "1e300",
                                         "1000000",
                                         "",
                                         "0x10"};
    std::vector<Damaged> all;
    const auto numbers = some(numbersOf(sound), 60);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        for (const std::string_view bad : kBad) {
            all.push_back({"number " + std::to_string(i) + " is " + inQuotes(bad),
                           with(sound, numbers[i], bad)});
        }
    }
    return all;
}

std::vector<Damaged> withBadLines(std::string_view sound) {
    std::vector<Damaged> all;
    const auto lines = some(linesOf(sound), 60);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string line(sound.substr(lines[i].begin, lines[i].end - lines[i].begin));
        all.push_back({"line " + std::to_string(i) + " twice", with(sound, lines[i], line + line)});
        all.push_back({"without line " + std::to_string(i), with(sound, lines[i], "")});
    }
    all.push_back({"lines that end in CR", replacedAll(sound, "\n", "\r")});
    all.push_back({"lines that end in CR LF", replacedAll(sound, "\n", "\r\n")});
    all.push_back({"one line", replacedAll(sound, "\n", " ")});
    all.push_back({"decimal commas", replacedAll(sound, ".", ",")});
    all.push_back({"semicolons", replacedAll(sound, ",", ";")});
    return all;
}

std::vector<Damaged> withBadWords(std::string_view sound) {
    using namespace std::string_literals;
    static const std::string kBad[] = {"\0\0\0\0"s,
                                       "\xff\xff\xff\xff"s,
                                       "\xff\xff\xff\x7f"s,
                                       "\0\0\0\x80"s,
                                       "\0\0\1\0"s,
                                       "\0\0\xc0\x7f"s,
                                       "\0\0\0\0\0\0\xf0\x7f"s,
                                       "\xff\xff\xff\xff\xff\xff\xff\x7f"s};
    const std::size_t head = std::min<std::size_t>(sound.size(), 2048);
    const std::size_t step = std::max<std::size_t>(1, head / (sound.size() > 16'384 ? 24 : 128));
    std::vector<Damaged> all;
    for (std::size_t at = 0; at < sound.size();) {
        for (const std::string& bad : kBad) {
            const std::size_t end = std::min(at + bad.size(), sound.size());
            all.push_back({"other bytes at " + std::to_string(at),
                           with(sound, {at, end}, bad.substr(0, end - at))});
        }
        at += at < head ? step : std::max<std::size_t>(4, sound.size() / 16);
    }
    return all;
}

std::vector<Damaged> withAMegabyteOfOne(std::string_view sound) {
    std::vector<std::string> words(std::begin(kWords), std::end(kWords));
    for (const std::string& word : wordsOf(sound)) {
        if (words.size() < 24) words.push_back(word + (words.size() % 2 == 0 ? " " : "\n"));
    }
    std::vector<Damaged> all;
    const std::size_t line = sound.find('\n', sound.size() / 3);
    const std::size_t middle = line == std::string_view::npos ? sound.size() / 2 : line + 1;
    for (const std::string& word : words) {
        const std::string many = repeated(word);
        all.push_back({"a megabyte of " + inQuotes(word) + " behind", std::string(sound) + many});
        all.push_back(
            {"a megabyte of " + inQuotes(word) + " within", with(sound, {middle, middle}, many)});
    }
    return all;
}

std::vector<Damaged> megabytesOfOne() {
    std::vector<Damaged> all;
    for (const std::string_view word : kWords) {
        all.push_back({"a megabyte of " + inQuotes(word), repeated(word)});
    }
    return all;
}

}  // namespace gonio::test
