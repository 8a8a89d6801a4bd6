#include "proc/formats/brdf_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "proc/formats/alta.h"
#include "proc/formats/astm.h"
#include "proc/formats/bird.h"
#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_tiles.h"
#include "proc/formats/file_bytes.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/klems.h"
#include "proc/formats/lighttools.h"
#include "proc/formats/mbsdf.h"
#include "proc/formats/merl.h"
#include "proc/formats/named_band.h"
#include "proc/formats/pab.h"
#include "proc/formats/rgl.h"
#include "proc/formats/rt300s_brdf.h"
#include "proc/formats/scattered_csv.h"
#include "proc/formats/sniff.h"
#include "proc/formats/speos.h"
#include "proc/formats/ssdd.h"
#include "proc/formats/stil_text.h"
#include "proc/formats/utia.h"
#include "proc/formats/zemax.h"

namespace gonio::proc {
namespace {

using Decoder = Result<BrdfFile> (*)(std::string_view bytes, std::string_view name);

Result<BrdfFile> ofGonio(std::string_view bytes, std::string_view name) {
    Result<SampleSet> set = decodeGonio(bytes, name);
    if (!set) return set.error();
    Metadata about = metadataOf(set->info);
    return BrdfFile{.content = std::move(*set), .about = std::move(about)};
}

Result<BrdfFile> ofZemax(std::string_view bytes, std::string_view name) {
    Result<SpecularTable> table = parseZemax(bytes, name);
    if (!table) return table.error();
    Metadata about = metadataOfLines(table->comments);
    return BrdfFile{.content = std::move(*table), .about = std::move(about)};
}

struct Codec {
    Format format;
    Decoder decode;
};

/// A reader whose table, metadata and warnings become the file's.
template <auto parse>
Result<BrdfFile> of(std::string_view bytes, std::string_view name) {
    auto read = parse(bytes, name);
    if (!read) return read.error();
    return BrdfFile{.content = std::move(read->content),
                    .about = std::move(read->about),
                    .warnings = std::move(read->warnings)};
}

auto parseRawUtia(std::string_view bytes, std::string_view name) {
    return parseUtia(bytes, name, UtiaScale::Raw);
}

/// Two texts go by the name: LightTools' own, and the export of an instrument.
auto parseAnyLightTools(std::string_view text, std::string_view name) {
    return isStilText(text) ? parseStilText(text, name) : parseLightTools(text, name);
}

Result<BrdfFile> ofSsdd(std::string_view bytes, std::string_view name) {
    auto read = parseSsdd(bytes, name);
    if (!read) return read.error();
    BrdfFile file{
        .content = {}, .about = std::move(read->about), .warnings = std::move(read->warnings)};
    std::visit([&](auto& table) { file.content = std::move(table); }, read->content);
    return file;
}

/// The only sample of an atlas; several are a Usage error.
Result<BrdfFile> ofAtlas(std::string_view bytes, std::string_view name) {
    auto read = decodeExrAtlas(bytes, name);
    if (!read) return read.error();
    if (read->size() != 1) {
        return Error{ErrorKind::Usage,
                     std::string(name) + ": an atlas of " + std::to_string(read->size()) +
                         " samples, made for shaders; what it was made of can be read instead"};
    }
    FileRead<SpecularTable>& one = read->front();
    return BrdfFile{.content = std::move(one.content),
                    .about = std::move(one.about),
                    .warnings = std::move(one.warnings)};
}

constexpr std::array kCodecs{Codec{Format::Gonio, ofGonio},
                             Codec{Format::Zemax, ofZemax},
                             Codec{Format::LightTools, of<parseAnyLightTools>},
                             Codec{Format::Merl, of<parseMerl>},
                             Codec{Format::Utia, of<parseRawUtia>},
                             Codec{Format::Rgl, of<parseRgl>},
                             Codec{Format::Bird, of<parseBird>},
                             Codec{Format::Speos, of<parseSpeos>},
                             Codec{Format::Mbsdf, of<parseMbsdf>},
                             Codec{Format::Astm, of<parseAstm>},
                             Codec{Format::Ssdd, ofSsdd},
                             Codec{Format::Pab, of<parsePab>},
                             Codec{Format::Alta, of<parseAlta>},
                             Codec{Format::Csv, of<parseScatteredCsv>},
                             Codec{Format::ExrTiles, of<decodeExrTiles>},
                             Codec{Format::ExrAtlas, ofAtlas},
                             Codec{Format::Rt300s, of<parseRt300sTable>},
                             Codec{Format::Klems, of<parseKlems>}};

/// Our own files say where an exact 0 stands for a missing value.
void restoreMissing(BrdfFile& file) {
    auto* table = std::get_if<SphericalTable>(&file.content);
    if (table == nullptr || file.about.at(key::kMissing) != "0") return;
    for (SphericalBlock& block : table->blocks) {
        std::replace(block.f.begin(), block.f.end(), 0.0, std::numeric_limits<double>::quiet_NaN());
    }
    file.about.values.erase(std::string(key::kMissing));
}

/// Of one channel: what its name, its wavelength or the file's name says.
std::optional<Band> soleBand(const std::vector<Channel>& channels,
                             const std::filesystem::path& path) {
    if (channels.size() != 1) return std::nullopt;
    const auto band = bandOfChannel(channels[0]);
    return band || channels[0].nanometres ? band : bandOfName(path);
}

}  // namespace

Result<BrdfFile> decodeBrdf(Format format, std::string_view bytes, std::string_view name) {
    const auto known = std::find_if(
        kCodecs.begin(), kCodecs.end(), [&](const Codec& codec) { return codec.format == format; });
    if (known == kCodecs.end()) {
        return Error{ErrorKind::File,
                     std::string(name) + ": a " + std::string(factsOf(format).title) +
                         " is no BRDF; `gonio info` tells what it holds"};
    }
    Result<BrdfFile> file = known->decode(bytes, name);
    if (!file) return file;
    file->format = format;
    restoreMissing(*file);
    return file;
}

Result<BrdfFile> readBrdf(const std::filesystem::path& path, std::optional<Format> from) {
    if (!from) {
        const Result<Format> found = sniffFile(path);
        if (!found) return found.error();
        from = *found;
    }
    const Result<std::string> bytes = readFile(path);
    if (!bytes) return bytes.error();
    Result<BrdfFile> file = decodeBrdf(*from, *bytes, path.string());
    if (file && !file->band) file->band = soleBand(channelsOf(*file), path);
    return file;
}

std::vector<Channel> channelsOf(const BrdfFile& file) {
    const bool bands = file.as<SampleSet>() != nullptr || file.as<HalfDifferenceTable>() != nullptr;
    if (bands) return Channel::ofBands();
    if (const auto* spherical = file.as<SphericalTable>()) return spherical->channels;
    if (const auto* tensor = file.as<TensorTable>()) return tensor->channels;
    if (const auto* rows = file.as<BrdfRows>()) return rows->channels;
    if (file.as<KlemsTable>() != nullptr) return {Channel{}};
    const auto& table = *file.as<SpecularTable>();
    if (table.colour == TableColour::LedBands) return Channel::ofBands();
    if (table.colour == TableColour::Xyz) return {{"X", {}}, {"Y", {}}, {"Z", {}}};
    const auto nm = wavelengthIn(file.about.comments);
    if (!file.band) return {{"", nm}};
    const Channel band = Channel::of(*file.band);
    return {{band.name, nm ? nm : band.nanometres}};
}

std::vector<Radians> incidencesOf(const BrdfFile& file) {
    std::vector<double> degrees;
    const auto take = [&](double value) { degrees.push_back(std::round(value * 1e6) / 1e6); };
    if (const auto* sample = file.as<SampleSet>()) {
        for (const LedTable& led : sample->leds) take(led.incidence.degrees());
    } else if (const auto* table = file.as<SpecularTable>()) {
        for (const double incidence : table->incidenceDeg) take(incidence);
    } else if (const auto* spherical = file.as<SphericalTable>()) {
        for (const SphericalBlock& block : spherical->blocks) take(block.incidenceDeg);
    } else if (const auto* rows = file.as<BrdfRows>()) {
        for (const LightView& pair : rows->pairs) take(pair.in.theta().degrees());
    }
    std::sort(degrees.begin(), degrees.end());
    degrees.erase(std::unique(degrees.begin(), degrees.end()), degrees.end());
    std::vector<Radians> incidences;
    incidences.reserve(degrees.size());
    for (const double value : degrees) incidences.push_back(Radians::fromDegrees(value));
    return incidences;
}

}  // namespace gonio::proc
