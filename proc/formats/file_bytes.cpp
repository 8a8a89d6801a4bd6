#include "proc/formats/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace gonio::proc {
namespace {

namespace fs = std::filesystem;

Error fileError(const std::string& what, const fs::path& path, const std::string& why) {
    return {ErrorKind::File, what + " " + path.string() + ": " + why};
}

std::string lastReason() { return errno == 0 ? "failed" : std::strerror(errno); }

Result<std::string> readUpTo(const fs::path& path, std::size_t count) {
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in) return fileError("read", path, lastReason());
    std::string bytes(count, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(count));
    if (in.bad()) return fileError("read", path, lastReason());
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

Result<std::size_t> regularSize(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) return fileError("read", path, "no such file");
    if (error) return fileError("read", path, error.message());
    if (status.type() != fs::file_type::regular) return fileError("read", path, "not a file");
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) return fileError("read", path, error.message());
    return static_cast<std::size_t>(size);
}

/// `named` stands in errors.
Result<void> writeTo(const fs::path& path, const fs::path& named, std::string_view bytes) {
    errno = 0;
    std::ofstream out(path, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (!out) return fileError("write", named, lastReason());
    return {};
}

}  // namespace

Result<std::string> readFile(const fs::path& path, std::size_t limit) {
    const Result<std::size_t> size = regularSize(path);
    if (!size) return size.error();
    if (*size > limit) {
        return fileError(
            "read",
            path,
            std::to_string(*size) + " bytes, at most " + std::to_string(limit) + " are read");
    }
    return readUpTo(path, *size);
}

Result<std::string> readHead(const fs::path& path, std::size_t count) {
    const Result<std::size_t> size = regularSize(path);
    if (!size) return size.error();
    return readUpTo(path, std::min(*size, count));
}

Result<void> writeFile(const fs::path& given, std::string_view bytes) {
    std::error_code error;
    const fs::file_status status = fs::status(given, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) return writeTo(given, given, bytes);
    // A link stays one: the file behind it is replaced.
    const fs::path path = fs::is_symlink(given, error) ? fs::weakly_canonical(given, error) : given;
    fs::path part = path;
    part += ".part";
    if (Result<void> written = writeTo(part, given, bytes); !written) {
        fs::remove(part, error);
        return written;
    }
    fs::rename(part, path, error);
    if (!error) return {};
    Error failed = fileError("write", given, error.message());
    fs::remove(part, error);
    return failed;
}

}  // namespace gonio::proc
