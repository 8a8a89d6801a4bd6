#pragma once
// Ways to damage a file, all of them: each gives a list of files to read.

#include <string>
#include <string_view>
#include <vector>

namespace gonio::test {

struct Damaged {
    std::string what;  ///< "number 3 is nan"
    std::string bytes;
};

/// Ends at every 50th of its length.
[[nodiscard]] std::vector<Damaged> truncated(std::string_view sound);
/// Junk after the end, itself again, a zero byte; a byte order mark before it; nothing at all.
[[nodiscard]] std::vector<Damaged> extended(std::string_view sound);
/// Each number (of a long file, 60 of them) that is none, too large, negative, or with a comma.
[[nodiscard]] std::vector<Damaged> withBadNumbers(std::string_view sound);
/// Each line (of a long file, 60 of them) given twice or left out; other line ends.
[[nodiscard]] std::vector<Damaged> withBadLines(std::string_view sound);
/// Words of the first two kilobytes, and some after, that are 0, -1, the largest, NaN.
[[nodiscard]] std::vector<Damaged> withBadWords(std::string_view sound);
/// A megabyte of one word, of the file's own or one that nests, after the file and within.
[[nodiscard]] std::vector<Damaged> withAMegabyteOfOne(std::string_view sound);
/// Nothing but a megabyte of one word.
[[nodiscard]] std::vector<Damaged> megabytesOfOne();

}  // namespace gonio::test
