#include "proc/formats/file_bytes.h"

#include <gtest/gtest.h>

#include "tests/formats/refusal.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

namespace fs = std::filesystem;
using test::refuses;
using test::TempFolder;

std::size_t entriesIn(const TempFolder& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

std::string everyByte() {
    std::string bytes;
    for (int i = 0; i < 3 * 256; ++i) bytes += static_cast<char>(i);
    return bytes;
}

TEST(FileBytes, ReadsBackWhatItWrote) {
    const TempFolder folder;
    for (const std::string& bytes : {std::string(), everyByte(), std::string(1 << 20, '\0')}) {
        ASSERT_TRUE(writeFile(folder / "file", bytes));
        const auto back = readFile(folder / "file");
        ASSERT_TRUE(back);
        EXPECT_EQ(*back, bytes);
        EXPECT_EQ(entriesIn(folder), 1U);
    }
}

TEST(FileBytes, ReadsAHeadOfAnyLength) {
    const TempFolder folder;
    ASSERT_TRUE(writeFile(folder / "file", "0123456789"));
    for (const std::size_t count : {std::size_t{0}, std::size_t{9}, std::size_t{10}, SIZE_MAX}) {
        const auto head = readHead(folder / "file", count);
        ASSERT_TRUE(head);
        EXPECT_EQ(*head, std::string("0123456789").substr(0, count));
    }
}

TEST(FileBytes, ReadsUpToTheLimitAndNotAByteMore) {
    const TempFolder folder;
    ASSERT_TRUE(writeFile(folder / "file", "0123456789"));
    EXPECT_TRUE(readFile(folder / "file", 11));
    EXPECT_TRUE(readFile(folder / "file", 10));
    EXPECT_TRUE(refuses(readFile(folder / "file", 9), {"file: 10 bytes, at most 9 are read"}));
}

TEST(FileBytes, RefusesAFileOverTheLimitWithoutReadingIt) {
    const TempFolder folder;
    ASSERT_TRUE(writeFile(folder / "sparse", ""));
    fs::resize_file(folder / "sparse", std::uintmax_t{1} << 40U);  // holes: no room on the disk
    EXPECT_TRUE(refuses(readFile(folder / "sparse"), {"sparse", "1099511627776 bytes"}));
    const auto head = readHead(folder / "sparse", 4);
    ASSERT_TRUE(head);
    EXPECT_EQ(*head, std::string(4, '\0'));
}

TEST(FileBytes, NamesWhatIsMissingOrNotAFile) {
    const TempFolder folder;
    const fs::path missing = folder / "missing";
    EXPECT_TRUE(refuses(readFile(missing), {"read " + missing.string() + ": no such file"}));
    EXPECT_TRUE(refuses(readHead(missing, 1), {missing.string() + ": no such file"}));
    EXPECT_TRUE(refuses(readFile(folder.path()), {folder.path().string() + ": not a file"}));
    EXPECT_TRUE(refuses(readHead(folder.path(), 1), {"not a file"}));
    EXPECT_TRUE(refuses(readFile("/dev/zero"), {"/dev/zero: not a file"}));
    EXPECT_TRUE(refuses(readFile(""), {"no such file"}));
}

TEST(FileBytes, ReplacesAFile) {
    const TempFolder folder;
    ASSERT_TRUE(writeFile(folder / "file", "a longer text than the second"));
    ASSERT_TRUE(writeFile(folder / "file", "short"));
    EXPECT_EQ(*readFile(folder / "file"), "short");
    EXPECT_EQ(entriesIn(folder), 1U);
}

TEST(FileBytes, NamesTheFolderThatIsNotThere) {
    const TempFolder folder;
    const fs::path file = folder / "none" / "file";
    EXPECT_TRUE(refuses(writeFile(file, "x"), {"write " + file.string(), "No such file"}));
    EXPECT_EQ(entriesIn(folder), 0U);
}

TEST(FileBytes, LeavesNoHalfFileWhenTheDiskIsFull) {
    if (!fs::exists("/dev/full")) {
        std::cout << "skipped: no /dev/full here\n";
        return;
    }
    for (const std::size_t size : {std::size_t{10}, std::size_t{1} << 20U}) {
        const TempFolder folder;
        ASSERT_TRUE(writeFile(folder / "file", "as it was"));
        fs::create_symlink("/dev/full", folder / "file.part");
        EXPECT_TRUE(refuses(writeFile(folder / "file", std::string(size, 'x')),
                            {"write ", "file: No space left"}));
        EXPECT_EQ(*readFile(folder / "file"), "as it was");
        EXPECT_EQ(entriesIn(folder), 1U);
    }
}

TEST(FileBytes, LeavesNoHalfFileWhereAFolderStands) {
    const TempFolder folder;
    fs::create_directories(folder / "taken" / "full");
    EXPECT_TRUE(refuses(writeFile(folder / "taken", "x"), {"write ", "taken: "}));
    EXPECT_TRUE(fs::exists(folder / "taken" / "full"));
    EXPECT_EQ(entriesIn(folder), 1U);
}

TEST(FileBytes, KeepsALinkAndReplacesWhatIsBehindIt) {
    const TempFolder folder;
    ASSERT_TRUE(writeFile(folder / "real", "old"));
    fs::create_symlink(folder / "real", folder / "link");
    ASSERT_TRUE(writeFile(folder / "link", "new"));
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(*readFile(folder / "real"), "new");
    EXPECT_EQ(entriesIn(folder), 2U);
}

TEST(FileBytes, WritesIntoADeviceInsteadOfReplacingIt) {
    ASSERT_TRUE(writeFile("/dev/null", "x"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace gonio::proc
