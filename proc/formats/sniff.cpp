#include "proc/formats/sniff.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string>
#include <vector>

#include "proc/formats/csv_rows.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/rt300s.h"
#include "proc/formats/stil_text.h"
#include "proc/formats/text_lines.h"
#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kHead = std::size_t{64} << 10U;
constexpr std::string_view kExrMagic("\x76\x2f\x31\x01");
constexpr std::uintmax_t kUtiaBytes = std::uintmax_t{3} * 6 * 48 * 6 * 48 * 8;

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

bool isSpace(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// Does a line of the lower-case text begin with this word?
bool hasLine(std::string_view text, std::string_view word) {
    for (std::size_t at = text.find(word); at != std::string_view::npos;
         at = text.find(word, at + 1)) {
        const std::size_t line = text.find_last_not_of(" \t", at == 0 ? 0 : at - 1);
        const bool first =
            at == 0 || line == std::string_view::npos || text[line] == '\n' || text[line] == '\r';
        const std::size_t end = at + word.size();
        if (first && (end == text.size() || isSpace(text[end]))) return true;
    }
    return false;
}

std::optional<Format> byExtension(const std::filesystem::path& path) {
    const std::string extension = lower(path.extension().string());
    if (extension == ".gonio") return Format::Gonio;
    if (extension == ".graw") return Format::Graw;
    if (extension == ".bsdf") return Format::Zemax;
    if (extension == ".csv") return Format::Csv;
    if (extension == ".json") return Format::Bird;
    if (extension == ".astm") return Format::Astm;
    if (extension == ".mbsdf") return Format::Mbsdf;
    if (extension == ".ssdd") return Format::Ssdd;
    if (extension == ".pab") return Format::Pab;
    if (extension == ".alta") return Format::Alta;
    if (extension == ".binary") return Format::Merl;
    if (extension == ".anisotropicbsdf") return Format::Speos;
    return std::nullopt;
}

std::optional<Format> exrFormat(std::string_view head, const std::filesystem::path& path) {
    if (contains(head, kSampleSchema)) return Format::Gonio;
    if (contains(head, kRawSchema)) return Format::Graw;
    if (contains(head, "gonioAtlas")) return Format::ExrAtlas;
    if (contains(head, "bsdfTileAngles")) return Format::ExrTiles;
    // A long attribute can push the schema out of sight.
    const auto named = byExtension(path);
    return named == Format::Gonio || named == Format::Graw ? named : std::nullopt;
}

/// dims as three int32, and planes of that many doubles behind them.
bool isMerl(std::string_view head, std::uintmax_t bytes) {
    std::uint32_t dims[3] = {};
    if (head.size() < sizeof(dims)) return false;
    std::memcpy(dims, head.data(), sizeof(dims));
    std::uintmax_t values = 3;
    for (const std::uint32_t dim : dims) {
        if (dim == 0 || dim > 100'000) return false;
        values *= dim;
    }
    return values < (std::uintmax_t{1} << 40U) && bytes == sizeof(dims) + values * 8;
}

std::optional<Format> binaryFormat(std::string_view head,
                                   std::uintmax_t bytes,
                                   const std::filesystem::path& path) {
    if (head.starts_with(kExrMagic)) return exrFormat(head, path);
    if (head.starts_with(std::string_view("tensor_file\0", 12))) return Format::Rgl;
    if (head.starts_with("NVIDIA ARC MBSDF")) return Format::Mbsdf;
    if (isMerl(head, bytes)) return Format::Merl;
    if (bytes == kUtiaBytes) return Format::Utia;
    return std::nullopt;
}

/// The fields of the first line that is neither empty nor a comment.
std::vector<std::string_view> headerFields(std::string_view text) {
    TextLines lines(text);
    while (const auto line = lines.next()) {
        const std::string_view content = trimmed(*line);
        if (!content.empty() && content.front() != '#') return csvFields(content);
    }
    return {};
}

/// Tables between commas tell by the names of their columns.
std::optional<Format> byColumns(std::string_view text) {
    const std::vector<std::string_view> fields = headerFields(text);
    const auto has = [&](std::string_view name) {
        return std::find(fields.begin(), fields.end(), name) != fields.end();
    };
    if (has("azimuth_deg") && has("incidence_deg") && has("receive_deg")) return Format::Rt300s;
    if (has("theta_i") || has("wi_x")) return Format::Csv;
    // With other separators it is ours all the same: its reader says what is wrong.
    const bool ours =
        !fields.empty() && (fields[0].starts_with("theta_i") || fields[0].starts_with("wi_x"));
    return ours ? std::optional(Format::Csv) : std::nullopt;
}

bool isJdvOfBrdf(std::string_view text) {
    return isJdv(text) && contains(lower(text.substr(0, text.find_first_of("\r\n"))), "rt-300s");
}

/// Of `text` in lower case; what names and comments say counts for nothing. Words that only one
/// format has come first.
std::optional<Format> textFormat(std::string_view text, std::string_view asItIs) {
    if (text.starts_with("optis - ")) return Format::Speos;
    const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    if (text.substr(first).starts_with('<') && contains(text, "<windowelement")) {
        return Format::Klems;
    }
    if (text.substr(first).starts_with('{')) return Format::Bird;
    if (hasLine(text, "vars")) return Format::Astm;
    if (const auto table = byColumns(text)) return table;
    if (isJdvOfBrdf(asItIs)) return Format::Rt300s;
    if (isStilText(asItIs)) return Format::LightTools;
    if (hasLine(text, "data_type") || hasLine(text, "param0_list")) return Format::Ssdd;
    if (hasLine(text, "#param_in") || hasLine(text, "#dim")) return Format::Alta;
    if (hasLine(text, "#format:")) return Format::Pab;
    if (hasLine(text, "angleofincidence")) return Format::Zemax;
    if (hasLine(text, "aoi") && hasLine(text, "side")) return Format::LightTools;
    return std::nullopt;
}

}  // namespace

std::optional<Format> sniff(std::string_view head,
                            std::uintmax_t bytes,
                            const std::filesystem::path& path) {
    if (const auto binary = binaryFormat(head, bytes, path)) return binary;
    if (head.starts_with(kExrMagic)) return std::nullopt;
    std::string text = lower(head.substr(0, kHead));
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    if (const auto format = textFormat(text, head.substr(0, kHead))) return format;
    return byExtension(path);
}

Result<Format> sniffFile(const std::filesystem::path& path) {
    const Result<std::string> head = readHead(path, kHead);
    if (!head) return head.error();
    std::error_code unreadable;
    const std::uintmax_t bytes = std::filesystem::file_size(path, unreadable);
    if (const auto format = sniff(*head, bytes, path)) return *format;
    const bool picture = head->starts_with(kExrMagic);
    return Error{ErrorKind::File,
                 "read " + path.string() + ": cannot be read as a BRDF: " +
                     (picture ? "an OpenEXR picture without one"
                              : "unknown format; if it is one of ours, --from names it")};
}

}  // namespace gonio::proc
