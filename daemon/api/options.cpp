#include "daemon/api/options.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>

#include "proc/formats/file_bytes.h"

namespace gonio::daemon {
namespace {

constexpr std::array<std::string_view, 6> kKeys{
    "schema", "rig", "store", "socket", "socket_mode", "profile"};
constexpr std::string_view kSchema = "gonio/goniod/1";

}  // namespace

Result<DaemonOptions> readDaemonOptions(const std::filesystem::path& file) {
    const Result<std::string> text = proc::readFile(file);
    if (!text) return text.error();
    toml::table table;
    try {
        table = toml::parse(*text);
    } catch (const toml::parse_error& error) {
        return Error{ErrorKind::File, file.string() + ": " + std::string(error.description())};
    }
    for (const auto& [key, value] : table) {
        const bool known = std::find(kKeys.begin(), kKeys.end(), key.str()) != kKeys.end();
        if (known && value.is_string()) continue;
        return Error{ErrorKind::File,
                     file.string() + ": key '" + std::string(key.str()) +
                         (known ? "': wanted a text"
                                : "': wanted rig, store, socket, socket_mode or profile")};
    }
    const auto member = [&](std::string_view key) {
        return table[key].value<std::string>().value_or("");
    };
    if (member("schema") != kSchema) {
        return Error{ErrorKind::File,
                     file.string() + ": key 'schema': wanted \"" + std::string(kSchema) + "\""};
    }
    return DaemonOptions{.rig = member("rig"),
                         .store = member("store"),
                         .socket = member("socket"),
                         .profile = member("profile"),
                         .socketMode = member("socket_mode")};
}

DaemonOptions overlaid(DaemonOptions first, const DaemonOptions& second) {
    if (first.rig.empty()) first.rig = second.rig;
    if (first.store.empty()) first.store = second.store;
    if (first.socket.empty()) first.socket = second.socket;
    if (first.profile.empty()) first.profile = second.profile;
    if (first.socketMode.empty()) first.socketMode = second.socketMode;
    return first;
}

Result<RigChoice> parseRigChoice(const std::string& rig) {
    constexpr std::string_view kUsb = "usb:";
    if (rig == "sim") return RigChoice{.simulated = true};
    if (rig == "usb") return RigChoice{};
    if (rig.starts_with(kUsb) && rig.size() > kUsb.size()) {
        return RigChoice{.serial = rig.substr(kUsb.size())};
    }
    return Error{ErrorKind::Usage,
                 rig.empty() ? "which rig? Say --rig sim, --rig usb or --rig usb:SERIAL"
                             : "--rig '" + rig + "': wanted sim, usb or usb:SERIAL"};
}

Result<SocketAccess> parseSocketMode(const std::string& mode) {
    if (mode.empty() || mode == "0600") return SocketAccess::User;
    if (mode == "0660") return SocketAccess::Group;
    return Error{ErrorKind::Usage, "socket_mode '" + mode + "': wanted 0600 or 0660"};
}

}  // namespace gonio::daemon
