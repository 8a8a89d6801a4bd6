#include "daemon/object_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "daemon/digest.h"
#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

std::string read(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Digest, IsThatOfTheStandardsExamples) {
    EXPECT_EQ(digestOf(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(digestOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ObjectFolder, GivesBackWhatItKept) {
    const test::TempFolder folder;
    const auto objects = ObjectFolder::open(folder / "objects");
    ASSERT_TRUE(objects) << objects.error().message;
    const std::string bytes("a\0b\n", 4);
    const auto name = objects->put(bytes, ".graw");
    ASSERT_TRUE(name) << name.error().message;
    EXPECT_EQ(*name, digestOf(bytes) + ".graw");
    EXPECT_EQ(read(objects->pathOf(*name)), bytes);
    EXPECT_EQ(*objects->put(bytes, ".graw"), *name);
    const auto empty = objects->put("", ".x");
    ASSERT_TRUE(empty);
    EXPECT_EQ(read(objects->pathOf(*empty)), "");
}

TEST(ObjectFolder, TakesAwayWhatADeadRunLeftHalfWritten) {
    const test::TempFolder folder;
    const auto objects = ObjectFolder::open(folder.path());
    ASSERT_TRUE(objects);
    const auto name = objects->put("whole", ".x");
    ASSERT_TRUE(name);
    const auto half = folder / "ab/abcdef.x.2147483646.half";
    std::filesystem::create_directories(half.parent_path());
    std::ofstream(half) << "ha";
    ASSERT_TRUE(ObjectFolder::open(folder.path()));
    EXPECT_TRUE(std::filesystem::exists(half)) << "it may be another's that writes";
    ASSERT_TRUE(objects->sweep());
    EXPECT_FALSE(std::filesystem::exists(half));
    EXPECT_EQ(read(objects->pathOf(*name)), "whole");
}

TEST(ObjectFolder, CannotSweepWhereThereIsNone) {
    const test::TempFolder folder;
    const Result<void> swept = ObjectFolder(folder / "none").sweep();
    ASSERT_FALSE(swept);
    EXPECT_NE(swept.error().message.find("none"), std::string::npos);
}

TEST(ObjectFolder, NamesAPlaceWhereItCannotBe) {
    const auto objects = ObjectFolder::open("/dev/full/objects");
    ASSERT_FALSE(objects);
    EXPECT_NE(objects.error().message.find("/dev/full/objects"), std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
