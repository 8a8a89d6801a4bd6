// A disk that is full in the middle of a write: the old file stays as it was, and nothing half
// written beside it. On a small tmpfs of its own where the system lets a test mount one, and under
// a limit on the size of files everywhere.

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>

#include "proc/formats/file_bytes.h"
#include "tests/support/temp_folder.h"

namespace gonio::proc {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

constexpr int kNotPossible = 77;

/// In a process of its own: what it limits or mounts ends with it. Its exit code; what fails in it
/// it says on stderr.
int inAProcess(const std::function<int()>& work) {
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child == 0) ::_exit(work());
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int complain(const std::string& what) {
    std::fputs((what + "\n").c_str(), stderr);
    return 1;
}

/// The file of `folder` holds `before`; a write of `size` bytes must fail for this reason.
int failsAndLeaves(const fs::path& folder,
                   const std::string& before,
                   std::size_t size,
                   std::string_view reason) {
    const auto written = writeFile(folder / "file", std::string(size, 'x'));
    const std::string of = std::to_string(size) + " bytes: ";
    if (written) return complain(of + "were written");
    if (written.error().message.find(reason) == std::string::npos) {
        return complain(of + written.error().message);
    }
    const auto after = readFile(folder / "file");
    if (!after || *after != before) return complain(of + "the old file is another one");
    const auto entries = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    return entries == 1 ? 0 : complain(of + "something is left beside the file");
}

/// Root of a user namespace, who is the user outside.
bool becomeRootInside() {
    const std::string user = "0 " + std::to_string(::getuid()) + " 1";
    const std::string group = "0 " + std::to_string(::getgid()) + " 1";
    const auto put = [](const char* file, const std::string& text) {
        std::ofstream out(file);
        return static_cast<bool>(out << text << std::flush);
    };
    return ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0 && put("/proc/self/uid_map", user) &&
           put("/proc/self/setgroups", "deny") && put("/proc/self/gid_map", group);
}

bool mountTmpfs(const fs::path& where, const char* size) {
    if (::unshare(CLONE_NEWNS) != 0 && !becomeRootInside()) return false;
    (void)::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    return ::mount("tmpfs", where.c_str(), "tmpfs", 0, size) == 0;
}

TEST(FullDisk, LeavesTheOldFileWholeOnASmallTmpfs) {
    const TempFolder folder;
    const int code = inAProcess([&] {
        if (!mountTmpfs(folder.path(), "size=256k")) return kNotPossible;
        const std::string before(100'000, 'o');
        if (!writeFile(folder / "file", before)) return complain("the old file was not written");
        for (const std::size_t size : {200'000U, 160'000U, 1'000'000U, 50'000'000U}) {
            if (failsAndLeaves(folder.path(), before, size, "No space left") != 0) return 1;
        }
        const std::string after(100'000, 'n');  // both fit at once
        if (!writeFile(folder / "file", after)) return complain("what fits was not written");
        return *readFile(folder / "file") == after ? 0 : complain("what fits was written wrong");
    });
    if (code == kNotPossible) GTEST_SKIP() << "no tmpfs can be mounted here";
    EXPECT_EQ(code, 0);
}

TEST(FullDisk, LeavesTheOldFileWholeWhereverAWriteStops) {
    const TempFolder folder;
    const std::string before(1000, 'o');
    ASSERT_TRUE(writeFile(folder / "file", before));
    EXPECT_EQ(inAProcess([&] {
                  std::signal(SIGXFSZ, SIG_IGN);
                  for (const rlim_t most : {0U, 1U, 4095U, 4096U, 8191U, 65'536U, 99'999U}) {
                      const rlimit limit{most, RLIM_INFINITY};
                      if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return complain("no limit");
                      if (failsAndLeaves(folder.path(), before, 100'000, "too large") != 0)
                          return 1;
                  }
                  return 0;
              }),
              0);
    EXPECT_EQ(*readFile(folder / "file"), before);
    EXPECT_TRUE(writeFile(folder / "file", std::string(100'000, 'n')));
}

TEST(FullDisk, IsNoFileWhereNoneWas) {
    const TempFolder folder;
    EXPECT_EQ(inAProcess([&] {
                  std::signal(SIGXFSZ, SIG_IGN);
                  const rlimit limit{10, RLIM_INFINITY};
                  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return complain("no limit");
                  return writeFile(folder / "file", std::string(100, 'x')) ? 1 : 0;
              }),
              0);
    EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace gonio::proc
