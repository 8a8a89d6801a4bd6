#include "daemon/store.h"

#include <algorithm>
#include <cstdlib>

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSampleExtension = ".gonio";
constexpr std::string_view kRawExtension = ".graw";

fs::path defaultRoot() {
    const auto variable = [](const char* name) -> std::string {
        const char* value = std::getenv(name);
        return value != nullptr ? value : "";
    };
    if (const std::string set = variable("GONIO_STORE"); !set.empty()) return set;
    if (const std::string data = variable("XDG_DATA_HOME"); !data.empty()) {
        return fs::path(data) / "gonio";
    }
    if (const std::string home = variable("HOME"); !home.empty()) {
        return fs::path(home) / ".local" / "share" / "gonio";
    }
    return ".gonio";
}

bool isSampleName(std::string_view name) {
    const auto alphanumeric = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    return !name.empty() && name.size() <= 64 && alphanumeric(name.front()) &&
           std::all_of(name.begin(), name.end(), [&](char c) {
               return alphanumeric(c) || c == '.' || c == '_' || c == '-';
           });
}

}  // namespace

Result<Store> Store::open(const fs::path& chosen) {
    const fs::path root = chosen.empty() ? defaultRoot() : chosen;
    std::error_code failed;
    fs::create_directories(root / "samples", failed);
    if (failed) {
        return Error{ErrorKind::Busy,
                     "store: cannot make " + root.string() + ": " + failed.message() +
                         "; choose another place with --store DIR"};
    }
    return Store(root);
}

fs::path Store::rig(const std::string& serial) const { return root_ / "rigs" / serial; }

Result<fs::path> Store::sample(std::string_view name, std::string_view extension) const {
    if (!isSampleName(name)) {
        return Error{
            ErrorKind::Usage,
            "sample name '" + std::string(name) +
                "': wanted 1 to 64 letters, digits, '.', '_' or '-', a letter or digit first"};
    }
    return root_ / "samples" / (std::string(name) + std::string(extension));
}

Result<std::string> Store::setAside(const std::string& name) const {
    const auto file = [&](const std::string& of, std::string_view extension) {
        return root_ / "samples" / (of + std::string(extension));
    };
    const auto taken = [&](const std::string& of) {
        return fs::exists(file(of, kSampleExtension)) || fs::exists(file(of, kRawExtension));
    };
    if (!taken(name)) return std::string();
    std::string kept;
    for (int number = 1; kept.empty() || taken(kept); ++number) {
        kept = name + "." + std::to_string(number);
    }
    for (const std::string_view extension : {kRawExtension, kSampleExtension}) {
        if (!fs::exists(file(name, extension))) continue;
        std::error_code failed;
        fs::rename(file(name, extension), file(kept, extension), failed);
        if (failed) {
            return Error{ErrorKind::File,
                         "store: cannot keep the earlier sample '" + name + "' as '" + kept +
                             "': " + failed.message()};
        }
    }
    return kept;
}

std::vector<std::string> Store::sampleNames() const {
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(root_ / "samples", ignored)) {
        if (entry.path().extension() == kSampleExtension)
            names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace gonio::daemon
