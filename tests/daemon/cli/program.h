#pragma once
// Runs the built `gonio` program as a user would: arguments in, exit code, stdout and stderr out,
// with the seconds and the memory that it took.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"

namespace gonio::test {

struct Ran {
    int exitCode = -1;  ///< 128 + the signal's number when one ended it
    std::string out, err;
    double seconds = 0;
    double mebibytes = 0;  ///< largest resident set
};

inline std::string textOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Without the lines of comments that a CSV begins with, which tell when it was measured.
inline std::string rowsOfCsv(const std::filesystem::path& file) {
    std::string text = textOf(file);
    std::size_t begin = 0;
    while (begin < text.size() && text[begin] == '#') {
        begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
    }
    return text.substr(begin);
}

inline void writeText(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

inline int exitCodeOf(int status) {
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// Starts a program, with nothing on stdin unless a path is given.
inline pid_t spawnProcess(std::vector<std::string> arguments,
                          const std::filesystem::path& out,
                          const std::filesystem::path& err,
                          const std::filesystem::path& in = "/dev/null") {
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int kWrite = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, 0, in.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), kWrite, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), kWrite, 0600);
    pid_t child = 0;
    EXPECT_EQ(posix_spawn(&child, argv.front(), &actions, nullptr, argv.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    return child;
}

/// Runs a program to its end; its output goes through files in `folder`.
inline Ran runProcess(const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder) {
    const auto begin = std::chrono::steady_clock::now();
    const pid_t child = spawnProcess(arguments, folder / "stdout", folder / "stderr");
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    return {.exitCode = exitCodeOf(status),
            .out = textOf(folder / "stdout"),
            .err = textOf(folder / "stderr"),
            .seconds = took.count(),
            .mebibytes = static_cast<double>(usage.ru_maxrss) / 1024};
}

/// The program with a store of its own.
class Program {
public:
    [[nodiscard]] Ran operator()(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(),
                         {GONIO_PROGRAM, "--store", (folder_ / "store").string()});
        return runProcess(arguments, folder_.path());
    }
    /// The daemon, for when it is to refuse; RunningDaemon otherwise.
    [[nodiscard]] Ran daemon(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(),
                         {GONIO_DAEMON, "--store", (folder_ / "store").string()});
        return runProcess(arguments, folder_.path());
    }
    /// A file or folder beside the store.
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
        return folder_ / name;
    }

private:
    TempFolder folder_;
};

}  // namespace gonio::test
