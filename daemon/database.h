#pragma once
// The only door to SQLite: one database file in WAL mode with synchronous=FULL, so that a committed
// transaction survives power loss. Failures become Errors that name the file; a database held by
// another for more than a second is Busy: a writer that has a rig must come back to it.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "proc/core/result.h"

struct sqlite3;

namespace gonio::daemon {

using SqlValue = std::variant<std::monostate, std::int64_t, double, std::string>;
using SqlRow = std::vector<SqlValue>;

class Database {
public:
    /// Made when it is not there. `migrations[i]` takes the schema from version i to i + 1; each
    /// runs once, in a transaction of its own. File error for a file that is no database, or one of
    /// a newer program.
    [[nodiscard]] static Result<Database> open(const std::filesystem::path& file,
                                               const std::vector<std::string>& migrations);
    /// Changes nothing, and needs no right to write where another program has it open. File error
    /// when it is not there, or when its schema is not of version `version`.
    [[nodiscard]] static Result<Database> openToRead(const std::filesystem::path& file,
                                                     std::size_t version);

    /// One statement; `values` take the places of its question marks. The rows it gives.
    Result<std::vector<SqlRow>> run(std::string_view statement, const SqlRow& values = {});
    /// All of `work` or, when it returns an error, nothing of it.
    Result<void> transaction(const std::function<Result<void>()>& work);

private:
    struct Close {
        void operator()(sqlite3* handle) const;
    };
    Database(std::unique_ptr<sqlite3, Close> handle, std::filesystem::path file)
        : handle_(std::move(handle)), file_(std::move(file)) {}
    [[nodiscard]] static Result<Database> connect(const std::filesystem::path& file, int flags);
    [[nodiscard]] Result<std::size_t> version();
    [[nodiscard]] Error otherVersion(std::size_t seen, std::size_t known) const;
    [[nodiscard]] Error failed(std::string_view what) const;
    Result<void> execute(const std::string& script);
    Result<void> migrate(const std::vector<std::string>& migrations);

    std::unique_ptr<sqlite3, Close> handle_;
    std::filesystem::path file_;
};

/// What a column holds, or an empty text / 0 where it is NULL or of another kind.
[[nodiscard]] std::string textOf(const SqlValue& value);
[[nodiscard]] std::int64_t integerOf(const SqlValue& value);

}  // namespace gonio::daemon
