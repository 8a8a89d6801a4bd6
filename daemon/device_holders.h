#pragma once
// Who has a device open: the files of every process, as /proc shows them. Only root sees those of
// other users; how many could not be looked into is said.

#include <filesystem>
#include <string>
#include <vector>

namespace gonio::daemon {

struct DeviceHolder {
    int pid = 0;
    std::string program;  ///< as the kernel calls it, at most 15 letters
    std::string node;     ///< "/dev/bus/usb/001/007"
    bool operator==(const DeviceHolder&) const = default;
};

struct DeviceHolders {
    std::vector<DeviceHolder> holders;  ///< by pid, one entry for each node
    int unseen = 0;                     ///< processes of others
};

/// `root` stands before /proc; `self` is left out.
[[nodiscard]] DeviceHolders holdersOf(const std::vector<std::string>& nodes,
                                      const std::filesystem::path& root,
                                      int self);

}  // namespace gonio::daemon
