#include "daemon/device_holders.h"

#include <algorithm>
#include <fstream>
#include <set>

#include "proc/core/number_text.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

std::string programOf(const fs::path& process) {
    std::ifstream in(process / "comm");
    std::string name;
    std::getline(in, name);
    return name.empty() ? "a program" : name;
}

/// Which of the nodes the process has open. False in `seen`: it may not be looked into.
struct OpenNodes {
    std::set<std::string> nodes;
    bool seen = true;
};
OpenNodes openNodes(const fs::path& process, const std::vector<std::string>& nodes) {
    std::error_code failed;
    OpenNodes open;
    fs::directory_iterator files(process / "fd", failed);
    if (failed) {
        // One that has ended meanwhile is no secret.
        open.seen = failed != std::errc::permission_denied;
        return open;
    }
    for (; files != fs::directory_iterator(); files.increment(failed)) {
        const fs::path target = fs::read_symlink(files->path(), failed);
        if (!failed && std::find(nodes.begin(), nodes.end(), target.string()) != nodes.end())
            open.nodes.insert(target.string());
    }
    return open;
}

}  // namespace

DeviceHolders holdersOf(const std::vector<std::string>& nodes, const fs::path& root, int self) {
    DeviceHolders found;
    std::error_code failed;
    for (fs::directory_iterator process(root / "proc", failed);
         !failed && process != fs::directory_iterator();
         process.increment(failed)) {
        const auto pid = parseInteger(process->path().filename().string());
        if (!pid || *pid == self) continue;
        const OpenNodes open = openNodes(process->path(), nodes);
        if (!open.seen) ++found.unseen;
        for (const std::string& node : open.nodes) {
            found.holders.push_back({.pid = static_cast<int>(*pid),
                                     .program = programOf(process->path()),
                                     .node = node});
        }
    }
    std::sort(found.holders.begin(), found.holders.end(), [](const auto& a, const auto& b) {
        return std::tie(a.pid, a.node) < std::tie(b.pid, b.node);
    });
    return found;
}

}  // namespace gonio::daemon
