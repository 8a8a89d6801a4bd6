#include "daemon/database.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

const std::vector<std::string> kOne{"CREATE TABLE t(a INTEGER PRIMARY KEY, b);"};

std::int64_t count(Database& database) {
    const auto rows = database.run("SELECT count(*) FROM t");
    EXPECT_TRUE(rows);
    return integerOf(rows->front().front());
}

TEST(Database, GivesBackEveryKindOfValue) {
    const test::TempFolder folder;
    auto database = Database::open(folder / "x.db", kOne);
    ASSERT_TRUE(database) << database.error().message;
    const SqlRow values{std::int64_t{1} << 62, 0.1, std::string("a\0'; DROP", 9), std::monostate{}};
    for (const SqlValue& value : values) {
        ASSERT_TRUE(database->run("INSERT INTO t(b) VALUES(?)", {value}));
    }
    const auto rows = database->run("SELECT b FROM t ORDER BY a");
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ((*rows)[i].front(), values[i]);
}

TEST(Database, IsDurableByItsSettings) {
    const test::TempFolder folder;
    auto database = Database::open(folder / "x.db", kOne);
    ASSERT_TRUE(database);
    EXPECT_EQ(textOf(database->run("PRAGMA journal_mode")->front().front()), "wal");
    constexpr std::int64_t kFull = 2;
    EXPECT_EQ(integerOf(database->run("PRAGMA synchronous")->front().front()), kFull);
}

TEST(Database, TransactionIsAllOrNothing) {
    const test::TempFolder folder;
    auto database = Database::open(folder / "x.db", kOne);
    ASSERT_TRUE(database);
    const auto failed = database->transaction([&]() -> Result<void> {
        EXPECT_TRUE(database->run("INSERT INTO t(b) VALUES(1)"));
        return Error{ErrorKind::Quality, "changed my mind"};
    });
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "changed my mind");
    EXPECT_EQ(count(*database), 0);
    ASSERT_TRUE(database->transaction([&]() -> Result<void> {
        EXPECT_TRUE(database->run("INSERT INTO t(b) VALUES(1)"));
        return {};
    }));
    EXPECT_EQ(count(*database), 1);
}

TEST(Database, MigratesOnceAndRefusesANewerSchema) {
    const test::TempFolder folder;
    ASSERT_TRUE(Database::open(folder / "x.db", kOne));
    const std::vector<std::string> two{kOne.front(), "ALTER TABLE t ADD COLUMN c;"};
    {
        auto database = Database::open(folder / "x.db", two);
        ASSERT_TRUE(database) << database.error().message;
        EXPECT_TRUE(database->run("SELECT c FROM t"));
    }
    EXPECT_TRUE(Database::open(folder / "x.db", two));
    const auto older = Database::open(folder / "x.db", kOne);
    ASSERT_FALSE(older);
    EXPECT_EQ(older.error().kind, ErrorKind::File);
    EXPECT_NE(older.error().message.find("newer gonio"), std::string::npos);
}

TEST(Database, OpenedToReadChangesNothingAndSeesWhatIsThere) {
    const test::TempFolder folder;
    EXPECT_FALSE(Database::openToRead(folder / "x.db", 1)) << "there is none";
    EXPECT_FALSE(std::filesystem::exists(folder / "x.db"));
    auto writer = Database::open(folder / "x.db", kOne);
    ASSERT_TRUE(writer) << writer.error().message;
    auto reader = Database::openToRead(folder / "x.db", 1);
    ASSERT_TRUE(reader) << reader.error().message;
    ASSERT_TRUE(writer->run("CREATE TABLE later(x)"));
    EXPECT_TRUE(reader->run("SELECT * FROM later"));
    EXPECT_FALSE(reader->run("DROP TABLE later"));
    for (const auto& [version, said] : {std::pair(0, "newer"), std::pair(2, "older")}) {
        const auto other = Database::openToRead(folder / "x.db", static_cast<std::size_t>(version));
        ASSERT_FALSE(other);
        EXPECT_NE(other.error().message.find(said), std::string::npos) << other.error().message;
    }
}

TEST(Database, NamesTheFileThatIsNone) {
    const test::TempFolder folder;
    std::ofstream(folder / "x.db") << std::string(5000, 'x');
    const auto noDatabase = Database::open(folder / "x.db", kOne);
    ASSERT_FALSE(noDatabase);
    EXPECT_EQ(noDatabase.error().kind, ErrorKind::File);
    EXPECT_NE(noDatabase.error().message.find("x.db"), std::string::npos);
    const auto nowhere = Database::open(folder / "no/x.db", kOne);
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().kind, ErrorKind::Busy);
}

TEST(Database, BadStatementIsAnError) {
    const test::TempFolder folder;
    auto database = Database::open(folder / "x.db", kOne);
    ASSERT_TRUE(database);
    EXPECT_FALSE(database->run("SELEKT 1"));
    EXPECT_FALSE(database->run("INSERT INTO t(a) VALUES(?)", {std::string("banana")}));
}

}  // namespace
}  // namespace gonio::daemon
