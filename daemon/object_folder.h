#pragma once
// Files named by their content, written so that a name never stands for half a file: into a
// temporary, fdatasync, rename, fsync of the folder. When put() has returned, the bytes survive
// kill -9 and power loss; when it has not, there is nothing under the name, or all of it. The same
// bytes are kept once.

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "proc/core/result.h"

namespace gonio::daemon {

class ObjectFolder {
public:
    /// Made when it is not there.
    [[nodiscard]] static Result<ObjectFolder> open(const std::filesystem::path& folder);
    /// To look for what is in it; nothing is made.
    explicit ObjectFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Takes away what a run that died left half written. Nobody else may be writing.
    Result<void> sweep() const;

    /// The name: 64 hexadecimal digits and the extension (".gonio").
    [[nodiscard]] Result<std::string> put(std::string_view bytes, std::string_view extension) const;
    [[nodiscard]] std::filesystem::path pathOf(const std::string& name) const;

private:
    std::filesystem::path folder_;
};

}  // namespace gonio::daemon
