#pragma once
// What a daemon is told: by its configuration file (goniod.toml), and over that by its command
// line.

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/api/socket_path.h"
#include "proc/core/result.h"

namespace gonio::daemon {

/// Empty members have not been told.
struct DaemonOptions {
    std::string rig;  ///< "sim", "usb", "usb:SERIAL" or "replay:FILE"
    std::filesystem::path store;
    std::filesystem::path socket;
    std::filesystem::path profile;
    std::filesystem::path record;  ///< where the rig's traffic is recorded
    std::filesystem::path faults;  ///< a fault script for the simulated rig; empty: none
    std::string socketMode;        ///< "0600" (default) or "0660"
    /// How long a job waits for a rig that was lost, or must not light; 600 unless told.
    std::optional<double> comebackSeconds{};
};

/// Keys rig, store, socket, socket_mode, profile, record, faults, comeback_seconds, all optional.
/// File error that names the file and the key.
[[nodiscard]] Result<DaemonOptions> readDaemonOptions(const std::filesystem::path& file);

/// Each member of `first`; where that is empty, of `second`.
[[nodiscard]] DaemonOptions overlaid(DaemonOptions first, const DaemonOptions& second);

/// "usb:SERIAL" -> SERIAL, "replay:FILE" -> FILE. Usage error unless `rig` is one of these, sim or
/// usb.
struct RigChoice {
    bool simulated = false;
    std::optional<std::string> serial{};
    std::filesystem::path replay{};  ///< empty: a rig
};
[[nodiscard]] Result<RigChoice> parseRigChoice(const std::string& rig);

/// Usage error when the recording that is played would be recorded into.
[[nodiscard]] Result<void> checkRecord(const RigChoice& rig, const std::filesystem::path& record);

/// Who may connect: the daemon's user, or its group too. Usage error for anything else.
[[nodiscard]] Result<SocketAccess> parseSocketMode(const std::string& mode);

}  // namespace gonio::daemon
