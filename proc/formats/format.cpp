#include "proc/formats/format.h"

#include <algorithm>
#include <vector>

#include "proc/formats/words.h"

namespace gonio::proc {
namespace {

constexpr std::array<FormatFacts, kFormatCount> kFormats{{
    {Format::Gonio, "gonio", "gonio sample", ".gonio"},
    {Format::Graw, "graw", "gonio raw capture", ".graw", false},
    {Format::Zemax, "zemax", "Zemax BSDF", ".bsdf"},
    {Format::LightTools, "lighttools", "LightTools BSDF", ".bsdf"},
    {Format::Merl, "merl", "MERL table", ".binary"},
    {Format::Utia, "utia", "UTIA table", ".bin"},
    {Format::Rgl, "rgl", "RGL tensor file", ".bsdf"},
    {Format::Bird, "bird", "BiRD BRDF", ".json"},
    {Format::Astm, "astm", "ASTM table", ".astm"},
    {Format::Speos, "speos", "Speos BSDF", ".brdf"},
    {Format::Mbsdf, "mbsdf", "NVIDIA measured BSDF", ".mbsdf"},
    {Format::Ssdd, "ssdd", "SSDD table", ".ssdd"},
    {Format::Pab, "pab", "pab-opto table", ".pab"},
    {Format::Alta, "alta", "ALTA table", ".alta"},
    {Format::Csv, "csv", "CSV of directions", ".csv"},
    {Format::ExrTiles, "exr-tiles", "EXR tiles", ".exr"},
    {Format::ExrAtlas, "exr-atlas", "EXR atlas", ".exr"},
    {Format::Rt300s, "rt300s", "RT-300S readings", ".csv", false},
    {Format::Klems, "klems", "Klems matrices", ".xml", false},
}};

/// Extensions beside the one that a file gets; an extension that is there twice does not tell.
struct Extension {
    std::string_view extension;
    Format format;
};
constexpr std::array kExtensions{
    Extension{".gonio", Format::Gonio},
    Extension{".graw", Format::Graw},
    Extension{".bsdf", Format::Zemax},  // of its three formats the one that all read
    Extension{".binary", Format::Merl},
    Extension{".bin", Format::Utia},
    Extension{".json", Format::Bird},
    Extension{".brdf", Format::Bird},
    Extension{".brdf", Format::Speos},
    Extension{".astm", Format::Astm},
    Extension{".anisotropicbsdf", Format::Speos},
    Extension{".mbsdf", Format::Mbsdf},
    Extension{".ssdd", Format::Ssdd},
    Extension{".pab", Format::Pab},
    Extension{".alta", Format::Alta},
    Extension{".csv", Format::Csv},
    Extension{".exr", Format::ExrTiles},  // an atlas is made by `gonio atlas`
    Extension{".xml", Format::Klems},
};

std::string namesOf(const std::vector<Format>& several) {
    std::string names;
    for (const Format format : several) {
        names += (names.empty() ? "" : ", ") + std::string(name(format));
    }
    return names;
}

std::vector<Format> thatAreWritten() {
    std::vector<Format> found;
    for (const FormatFacts& facts : kFormats) {
        if (facts.writes) found.push_back(facts.format);
    }
    return found;
}

}  // namespace

std::span<const FormatFacts, kFormatCount> formats() { return kFormats; }

const FormatFacts& factsOf(Format format) { return kFormats[static_cast<std::size_t>(format)]; }

std::string_view name(Format format) { return factsOf(format).name; }

Result<Format> parseFormat(std::string_view text) {
    std::vector<Format> all;
    for (const FormatFacts& facts : kFormats) {
        if (facts.name == text) return facts.format;
        all.push_back(facts.format);
    }
    return Error{ErrorKind::Usage,
                 "format '" + std::string(text) + "' is not known; known: " + namesOf(all)};
}

bool listsDirections(Format format) {
    return format == Format::Bird || format == Format::Astm || format == Format::Pab ||
           format == Format::Alta || format == Format::Csv;
}

Result<Format> formatToWrite(const std::filesystem::path& path) {
    const std::string extension = lower(path.extension().string());
    std::vector<Format> found;
    for (const Extension& known : kExtensions) {
        if (known.extension == extension) found.push_back(known.format);
    }
    const std::string what = "'" + path.string() + "': ";
    if (found.empty()) {
        return Error{
            ErrorKind::Usage,
            what + "its name tells no format: say --to with one of " + namesOf(thatAreWritten())};
    }
    if (found.size() > 1) {
        return Error{
            ErrorKind::Usage,
            what + extension + " is several formats: say --to with one of " + namesOf(found)};
    }
    if (!factsOf(found.front()).writes) {
        return Error{ErrorKind::Usage,
                     what + std::string(factsOf(found.front()).title) +
                         " is only read; say --to with one of " + namesOf(thatAreWritten())};
    }
    return found.front();
}

}  // namespace gonio::proc
