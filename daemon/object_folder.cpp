#include "daemon/object_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "daemon/digest.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kHalf = ".half";

Error failed(const std::string& what, const fs::path& path) {
    const ErrorKind kind = errno == EACCES || errno == EROFS ? ErrorKind::Busy : ErrorKind::File;
    return {kind, "store: " + what + " " + path.string() + ": " + std::strerror(errno)};
}

/// An open file; closed with it.
class Descriptor {
public:
    Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags, 0644)) {}
    ~Descriptor() {
        if (fd_ >= 0) ::close(fd_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] bool ok() const { return fd_ >= 0; }

private:
    int fd_;
};

Result<void> syncFolder(const fs::path& folder) {
    const Descriptor opened(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (!opened.ok() || ::fsync(opened.get()) != 0) return failed("cannot sync", folder);
    return {};
}

Result<void> writeSynced(const fs::path& path, std::string_view bytes) {
    const Descriptor file(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
    if (!file.ok()) return failed("cannot write", path);
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.get(), bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return failed("cannot write", path);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (::fdatasync(file.get()) != 0) return failed("cannot sync", path);
    return {};
}

/// One for each process, so that two writers of the same content do not share it.
fs::path halfOf(const fs::path& path) {
    fs::path half = path;
    half += "." + std::to_string(::getpid());
    half += kHalf;
    return half;
}

Result<void> makeFolder(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) fs::create_directories(folder, error);
    if (error) {
        errno = error.value();
        return failed("cannot make", folder);
    }
    return syncFolder(folder.parent_path());
}

}  // namespace

Result<ObjectFolder> ObjectFolder::open(const fs::path& folder) {
    if (Result<void> made = makeFolder(folder); !made) return made.error();
    return ObjectFolder(folder);
}

Result<void> ObjectFolder::sweep() const {
    std::error_code failedAt, ignored;
    for (fs::recursive_directory_iterator it(folder_, failedAt), end; !failedAt && it != end;
         it.increment(failedAt)) {
        if (it->path().extension() == kHalf) fs::remove(it->path(), ignored);
    }
    if (!failedAt) return {};
    errno = failedAt.value();
    return failed("cannot look through", folder_);
}

Result<std::string> ObjectFolder::put(std::string_view bytes, std::string_view extension) const {
    const std::string name = digestOf(bytes) + std::string(extension);
    const fs::path path = pathOf(name);
    if (Result<void> made = makeFolder(path.parent_path()); !made) return made.error();
    std::error_code ignored;
    if (fs::exists(path, ignored)) {  // of a run that may have died before it synced the folder
        if (Result<void> synced = syncFolder(path.parent_path()); !synced) return synced.error();
        return name;
    }
    const fs::path half = halfOf(path);
    if (Result<void> written = writeSynced(half, bytes); !written) {
        fs::remove(half, ignored);
        return written.error();
    }
    if (::rename(half.c_str(), path.c_str()) != 0) {
        Error error = failed("cannot rename to", path);
        fs::remove(half, ignored);
        return error;
    }
    if (Result<void> synced = syncFolder(path.parent_path()); !synced) return synced.error();
    return name;
}

fs::path ObjectFolder::pathOf(const std::string& name) const {
    return folder_ / name.substr(0, 2) / name;
}

}  // namespace gonio::daemon
