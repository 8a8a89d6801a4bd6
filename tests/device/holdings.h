#pragma once
// What a process may leak: counted before and after.

#include <malloc.h>

#include <cstddef>
#include <filesystem>
#include <string>

namespace gonio::device_test {

/// Of a folder in /proc, but for links to `except`.
inline std::size_t entries(const char* folder, const std::string& except = "") {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::error_code none;
        const auto target = std::filesystem::read_symlink(entry.path(), none);
        if (target.empty() || target != except) ++count;
    }
    return count;
}

struct Holdings {
    // The test bed keeps the master of a terminal for each hidraw node that there ever was.
    std::size_t fds = entries("/proc/self/fd", "/dev/ptmx");
    std::size_t threads = entries("/proc/self/task");
    std::size_t heap = mallinfo2().uordblks;  ///< bytes
};

}  // namespace gonio::device_test
