#include "proc/formats/speos.h"

#include <algorithm>

#include "proc/formats/shown.h"
#include "proc/formats/speos_binary.h"
#include "proc/formats/speos_text.h"
#include "proc/formats/words.h"

namespace gonio::proc {

Result<FileRead<SphericalTable>> parseSpeos(std::string_view bytes, std::string_view name) {
    constexpr std::size_t kLongestTitle = 200;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    const std::size_t mark = bytes.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    const std::string_view head = bytes.substr(mark, kLongestTitle);
    const std::size_t end = head.find_first_of("\r\n");
    const std::string_view title = head.substr(0, end);
    const auto refused = [&](const std::string& what) {
        return Error{ErrorKind::File, "speos: " + std::string(name) + ": line 1: " + what};
    };
    const std::string kind = lower(title);
    if (!kind.starts_with("optis - ") || end == std::string_view::npos) {
        return refused(shown(title) + ", wanted 'OPTIS - ...'");
    }
    if (kind.find("simple scattering") != std::string::npos) {
        return refused("a simple scattering surface is a formula without a table: not read");
    }
    const bool anisotropic = kind.find("anisotropic bsdf") != std::string::npos;
    if (!anisotropic && kind.find("brdf") == std::string::npos) {
        return refused(shown(title) + ", wanted a brdf or an Anisotropic BSDF surface file");
    }
    const std::size_t start = mark + end + (head.substr(end).starts_with("\r\n") ? 2 : 1);
    const std::string_view mode = bytes.substr(start, 2);
    const bool text =
        mode.starts_with("0") ||
        (mode.starts_with("1") && mode.find_first_of("\r\n") != std::string_view::npos) ||
        !mode.starts_with("1");
    if (text) {
        return parseSpeosText(bytes, name, anisotropic ? SpeosKind::Anisotropic : SpeosKind::Brdf);
    }
    if (!anisotropic) return refused("a binary brdf file: not known, export it as text");
    if (kind.find("v9.0") == std::string::npos) {
        return refused("a binary file of another version than v9.0: export it as text");
    }
    return parseSpeosBinary(bytes, name, start);
}

}  // namespace gonio::proc
