#include "proc/formats/sniff.h"

#include <cctype>
#include <string>

#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kHead = std::size_t{64} << 10U;

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

/// Does a line of the lower-case text begin with this word?
bool hasLine(std::string_view text, std::string_view word) {
    for (std::size_t at = text.find(word); at != std::string_view::npos;
         at = text.find(word, at + 1)) {
        const std::size_t line = text.find_last_not_of(" \t", at == 0 ? 0 : at - 1);
        const bool first =
            at == 0 || line == std::string_view::npos || text[line] == '\n' || text[line] == '\r';
        const std::size_t end = at + word.size();
        if (first && (end == text.size() || std::isspace(static_cast<unsigned char>(text[end])))) {
            return true;
        }
    }
    return false;
}

FileKind byExtension(const std::filesystem::path& path) {
    const std::string extension = lower(path.extension().string());
    if (extension == ".gonio") return FileKind::Gonio;
    if (extension == ".graw") return FileKind::Graw;
    if (extension == ".bsdf") return FileKind::Zemax;
    if (extension == ".csv") return FileKind::PointsCsv;
    return FileKind::Unknown;
}

FileKind exrKind(std::string_view head, const std::filesystem::path& path) {
    if (contains(head, kSampleSchema)) return FileKind::Gonio;
    if (contains(head, kRawSchema)) return FileKind::Graw;
    const FileKind named = byExtension(path);  // a long attribute can push the schema out of sight
    return named == FileKind::Gonio || named == FileKind::Graw ? named : FileKind::OtherExr;
}

}  // namespace

std::string_view name(FileKind kind) {
    switch (kind) {
        case FileKind::Gonio: return "gonio sample";
        case FileKind::Graw: return "gonio raw capture";
        case FileKind::Zemax: return "Zemax BSDF";
        case FileKind::PointsCsv: return "CSV of directions";
        case FileKind::LightTools: return "LightTools BSDF";
        case FileKind::Rgl: return "RGL tensor file";
        case FileKind::OtherExr: return "OpenEXR picture";
        case FileKind::Unknown: break;
    }
    return "unknown format";
}

FileKind sniff(std::string_view head, const std::filesystem::path& path) {
    if (head.starts_with("\x76\x2f\x31\x01")) return exrKind(head, path);
    if (head.starts_with(std::string_view("tensor_file\0", 12))) return FileKind::Rgl;
    const std::string text = lower(std::string(head.substr(0, kHead)));
    if (hasLine(text, "angleofincidence")) return FileKind::Zemax;
    if (hasLine(text, "aoi") && hasLine(text, "side")) return FileKind::LightTools;
    if (contains(text, "theta_i") || contains(text, "wi_x")) return FileKind::PointsCsv;
    return byExtension(path);
}

Result<FileKind> sniffFile(const std::filesystem::path& path) {
    const Result<std::string> head = readHead(path, kHead);
    if (!head) return head.error();
    return sniff(*head, path);
}

}  // namespace gonio::proc
