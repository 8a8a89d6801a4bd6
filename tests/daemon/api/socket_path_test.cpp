#include "daemon/api/socket_path.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <optional>

#include "tests/support/temp_folder.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

TEST(SocketPath, IsTheChosenOneElseTheEnvironmentsElseInTheStore) {
    ::unsetenv("GONIO_SOCKET");
    EXPECT_EQ(socketPath("/a.sock", "/store"), "/a.sock");
    EXPECT_EQ(socketPath({}, "/store"), "/store/goniod.sock");
    ::setenv("GONIO_SOCKET", "/b.sock", 1);
    EXPECT_EQ(socketPath({}, "/store"), "/b.sock");
    EXPECT_EQ(socketPath("/a.sock", "/store"), "/a.sock");
    ::setenv("GONIO_SOCKET", "", 1);
    EXPECT_EQ(socketPath({}, "/store"), "/store/goniod.sock");
    ::unsetenv("GONIO_SOCKET");
}

TEST(SocketPath, Has107BytesAtMost) {
    EXPECT_TRUE(checkSocketPath(std::string(107, 'x')));
    const auto refused = checkSocketPath(std::string(108, 'x'));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::Usage);
    EXPECT_NE(refused.error().message.find("--socket"), std::string::npos);
}

class SocketClaimInFolder : public testing::Test {
protected:
    test::TempFolder folder;
    fs::path socket = folder / "d.sock";
};

TEST_F(SocketClaimInFolder, IsOneDaemonsAtATime) {
    {
        const auto first = SocketClaim::take(socket);
        ASSERT_TRUE(first) << first.error().message;
        const auto second = SocketClaim::take(socket);
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().kind, ErrorKind::Busy);
        EXPECT_NE(second.error().message.find("d.sock"), std::string::npos);
    }
    EXPECT_TRUE(SocketClaim::take(socket));
}

TEST_F(SocketClaimInFolder, OneThatWasRefusedTakesNothingAway) {
    const auto first = SocketClaim::take(socket);
    ASSERT_TRUE(first);
    std::ofstream(socket) << "stands for the socket";
    EXPECT_FALSE(SocketClaim::take(socket));
    EXPECT_TRUE(fs::exists(socket));
}

TEST_F(SocketClaimInFolder, MovesWithItsOwner) {
    std::optional<SocketClaim> kept;
    {
        auto first = SocketClaim::take(socket);
        ASSERT_TRUE(first);
        kept.emplace(std::move(*first));
    }
    EXPECT_FALSE(SocketClaim::take(socket)) << "still held";
    kept.reset();
    EXPECT_TRUE(SocketClaim::take(socket));
}

TEST_F(SocketClaimInFolder, TakesItsSocketWithItAndLeavesTheLock) {
    {
        const auto claim = SocketClaim::take(socket);
        ASSERT_TRUE(claim);
        std::ofstream(socket) << "stands for the socket";
    }
    EXPECT_FALSE(fs::exists(socket));
    EXPECT_TRUE(fs::exists(folder / "d.sock.lock"))
        << "removing it would let two daemons lock two files";
}

TEST_F(SocketClaimInFolder, FileOrFolderInItsPlaceIsLeftAlone) {
    std::ofstream(folder / "file") << "dear";
    fs::create_directory(folder / "folder");
    fs::create_symlink(folder / "file", folder / "link");
    for (const char* name : {"file", "folder", "link"}) {
        const auto claim = SocketClaim::take(folder / name);
        ASSERT_FALSE(claim) << name;
        EXPECT_EQ(claim.error().kind, ErrorKind::Busy);
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    }
    EXPECT_EQ(fs::file_size(folder / "file"), 4U);
}

TEST_F(SocketClaimInFolder, FolderThatIsNotThereIsAFileError) {
    const auto claim = SocketClaim::take(folder / "none/d.sock");
    ASSERT_FALSE(claim);
    EXPECT_EQ(claim.error().kind, ErrorKind::File);
    EXPECT_NE(claim.error().message.find("none/d.sock"), std::string::npos);
}

}  // namespace
}  // namespace gonio::daemon
