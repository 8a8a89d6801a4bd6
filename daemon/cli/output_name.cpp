#include "daemon/cli/output_name.h"

#include <algorithm>
#include <cctype>

namespace gonio::daemon {

std::string titleOf(const std::string& f, const Material& material) {
    if (material.sample != nullptr && !material.sample->info.name.empty()) {
        return material.sample->info.name;
    }
    if (material.kind == "model") return f.substr(f.find(':') + 1);
    return std::filesystem::path(f).stem().string();
}

std::string fileNameOf(std::string title) {
    constexpr std::size_t kLongest = 80;
    title.resize(std::min(title.size(), kLongest));
    for (char& c : title) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' ||
                           c == '_' || c == '-' || c == '+';
        if (!plain) c = '-';
    }
    return title;
}

}  // namespace gonio::daemon
