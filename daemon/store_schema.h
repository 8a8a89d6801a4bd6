#pragma once
// The tables of a store's gonio.db and how they came about: one migration for each schema version,
// never changed once it is on the main line.

#include <filesystem>

#include "daemon/database.h"

namespace gonio::daemon {

/// gonio.db of the store at `root`, which is there.
[[nodiscard]] Result<Database> openStoreDatabase(const std::filesystem::path& root);
/// The same, for those who only look. File error when there is no store.
[[nodiscard]] Result<Database> openStoreToRead(const std::filesystem::path& root);

}  // namespace gonio::daemon
