#include "daemon/api/options.h"

#include "daemon/toml_keys.h"

namespace gonio::daemon {
namespace {

constexpr std::string_view kSchema = "gonio/goniod/1";

}  // namespace

Result<DaemonOptions> readDaemonOptions(const std::filesystem::path& file) {
    Result<TomlKeys> read = TomlKeys::read(file, kSchema);
    if (!read) return read.error();
    TomlKeys& keys = *read;
    DaemonOptions options{.rig = keys.textOr("rig", ""),
                          .store = keys.textOr("store", ""),
                          .socket = keys.textOr("socket", ""),
                          .profile = keys.textOr("profile", ""),
                          .record = keys.textOr("record", ""),
                          .faults = keys.textOr("faults", ""),
                          .socketMode = keys.textOr("socket_mode", "")};
    constexpr double kNotTold = -1;
    const double comeback = keys.notNegativeOr("comeback_seconds", kNotTold);
    if (comeback >= 0) options.comebackSeconds = comeback;
    keys.nothingElse();
    if (keys.error()) return *keys.error();
    return options;
}

DaemonOptions overlaid(DaemonOptions first, const DaemonOptions& second) {
    if (first.rig.empty()) first.rig = second.rig;
    if (first.store.empty()) first.store = second.store;
    if (first.socket.empty()) first.socket = second.socket;
    if (first.profile.empty()) first.profile = second.profile;
    if (first.record.empty()) first.record = second.record;
    if (first.faults.empty()) first.faults = second.faults;
    if (first.socketMode.empty()) first.socketMode = second.socketMode;
    if (!first.comebackSeconds) first.comebackSeconds = second.comebackSeconds;
    return first;
}

Result<RigChoice> parseRigChoice(const std::string& rig) {
    constexpr std::string_view kUsb = "usb:", kReplay = "replay:";
    if (rig == "sim") return RigChoice{.simulated = true};
    if (rig == "usb") return RigChoice{};
    if (rig.starts_with(kUsb) && rig.size() > kUsb.size()) {
        return RigChoice{.serial = rig.substr(kUsb.size())};
    }
    if (rig.starts_with(kReplay) && rig.size() > kReplay.size()) {
        return RigChoice{.replay = rig.substr(kReplay.size())};
    }
    return Error{ErrorKind::Usage,
                 rig.empty()
                     ? "which rig? Say --rig sim, --rig usb, --rig usb:SERIAL or --rig replay:FILE"
                     : "--rig '" + rig + "': wanted sim, usb, usb:SERIAL or replay:FILE"};
}

Result<void> checkRecord(const RigChoice& rig, const std::filesystem::path& record) {
    std::error_code missing;
    if (rig.replay.empty() || record.empty()) return {};
    const bool same =
        rig.replay == record || std::filesystem::equivalent(rig.replay, record, missing);
    if (!same) return {};
    return Error{ErrorKind::Usage,
                 "--record " + record.string() +
                     ": this recording is being played; record into another file"};
}

Result<SocketAccess> parseSocketMode(const std::string& mode) {
    if (mode.empty() || mode == "0600") return SocketAccess::User;
    if (mode == "0660") return SocketAccess::Group;
    return Error{ErrorKind::Usage, "socket_mode '" + mode + "': wanted 0600 or 0660"};
}

}  // namespace gonio::daemon
