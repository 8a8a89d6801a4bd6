#include "proc/formats/foreign_keywords.h"

#include <algorithm>
#include <set>

#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

bool isOneWord(std::string_view text) {
    return !text.empty() && std::none_of(text.begin(), text.end(), [](char c) {
        return static_cast<unsigned char>(c) <= ' ';
    });
}

}  // namespace

std::vector<std::pair<std::string, std::string>> takeForeignKeywords(
    Metadata& rest, std::string_view prefix, std::span<const std::string_view> taken) {
    std::vector<std::pair<std::string, std::string>> keywords;
    std::set<std::string> seen(taken.begin(), taken.end());
    for (auto at = rest.values.begin(); at != rest.values.end();) {
        std::string_view word = at->first;
        const bool foreign = word.starts_with(prefix);
        if (foreign) word.remove_prefix(prefix.size());
        if (foreign && isOneWord(word) && seen.insert(lower(word)).second) {
            keywords.emplace_back(word, std::move(at->second));
            at = rest.values.erase(at);
        } else {
            ++at;
        }
    }
    return keywords;
}

}  // namespace gonio::proc
