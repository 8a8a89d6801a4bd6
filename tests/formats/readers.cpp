#include "tests/formats/readers.h"

#include <algorithm>
#include <array>

#include "proc/formats/alta.h"
#include "proc/formats/astm.h"
#include "proc/formats/bird.h"
#include "proc/formats/exr_atlas.h"
#include "proc/formats/exr_tiles.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/klems.h"
#include "proc/formats/lighttools.h"
#include "proc/formats/mbsdf.h"
#include "proc/formats/merl.h"
#include "proc/formats/pab.h"
#include "proc/formats/points_csv.h"
#include "proc/formats/rgl.h"
#include "proc/formats/rt300s_brdf.h"
#include "proc/formats/scattered_csv.h"
#include "proc/formats/sniff.h"
#include "proc/formats/speos.h"
#include "proc/formats/ssdd.h"
#include "proc/formats/stil_text.h"
#include "proc/formats/utia.h"
#include "proc/formats/zemax.h"
#include "tests/formats/sound_files.h"

namespace gonio::test {
namespace {

using Complaint = std::optional<Error>;
using Bytes = std::string_view;

/// What a writer made; none where it refused.
std::optional<std::string> bytesOf(const proc::Written& written) { return written.bytes; }
std::optional<std::string> bytesOf(const Result<proc::Written>& written) {
    return written ? std::optional(written->bytes) : std::nullopt;
}
std::optional<std::string> bytesOf(const std::optional<std::string>& written) { return written; }
std::optional<std::string> bytesOf(const Result<std::string>& written) {
    return written ? std::optional(*written) : std::nullopt;
}

/// What a reader made of the bytes, written and read again.
template <class Read, class Write>
Complaint thereAndBack(Bytes bytes, const Read& read, const Write& write) {
    const auto table = read(bytes, "in");
    if (!table) return table.error();
    const auto written = bytesOf(write(*table));
    if (!written) return std::nullopt;
    const auto back = read(*written, "in");
    if (back) return std::nullopt;
    return Error{ErrorKind::Internal, "does not read what it wrote: " + back.error().message};
}

/// The same for a reader that gives the metadata beside the table, and a writer that takes them.
template <class Read, class Write>
Complaint withMetadata(Bytes bytes, const Read& read, const Write& write) {
    return thereAndBack(
        bytes, read, [&](const auto& file) { return write(file.content, file.about); });
}

/// A reader without a writer.
template <class Read>
Complaint only(Bytes bytes, const Read& read) {
    const auto table = read(bytes, "in");
    return table ? Complaint() : table.error();
}

Complaint gonio(Bytes bytes) { return thereAndBack(bytes, proc::decodeGonio, proc::encodeGonio); }
Complaint graw(Bytes bytes) { return thereAndBack(bytes, proc::decodeGraw, proc::encodeGraw); }
Complaint zemax(Bytes bytes) {
    return thereAndBack(bytes, proc::parseZemax, [](const auto& t) { return proc::writeZemax(t); });
}
Complaint lightTools(Bytes bytes) {
    return withMetadata(
        bytes,
        [](auto text, auto name) { return proc::parseLightTools(text, name); },
        proc::writeLightTools);
}
Complaint merl(Bytes bytes) { return withMetadata(bytes, proc::parseMerl, proc::writeMerl); }
Complaint utia(Bytes bytes) {
    return withMetadata(
        bytes, [](auto b, auto name) { return proc::parseUtia(b, name); }, proc::writeUtia);
}
Complaint rgl(Bytes bytes) { return withMetadata(bytes, proc::parseRgl, proc::writeRgl); }
Complaint bird(Bytes bytes) { return withMetadata(bytes, proc::parseBird, proc::writeBird); }
Complaint speos(Bytes bytes) {
    const Complaint isotropic = withMetadata(bytes, proc::parseSpeos, proc::writeSpeosBrdf);
    return isotropic ? isotropic
                     : withMetadata(bytes, proc::parseSpeos, proc::writeSpeosAnisotropic);
}
Complaint mbsdf(Bytes bytes) { return withMetadata(bytes, proc::parseMbsdf, proc::writeMbsdf); }
Complaint ssdd(Bytes bytes) {
    return withMetadata(
        bytes, proc::parseSsdd, [](const proc::SsddTable& table, const proc::Metadata& about) {
            const auto* spherical = std::get_if<proc::SphericalTable>(&table);
            return proc::writeSsdd(spherical ? *spherical : proc::SphericalTable(), about);
        });
}
Complaint csv(Bytes bytes) {
    return withMetadata(bytes, proc::parseScatteredCsv, proc::writeScatteredCsv);
}
Complaint astm(Bytes bytes) { return withMetadata(bytes, proc::parseAstm, proc::writeAstm); }
Complaint pab(Bytes bytes) {
    const auto first = [](const auto& rows, const auto& about) -> std::optional<std::string> {
        const auto written = proc::writePab(rows, about);
        if (!written) return std::nullopt;
        return written->files[0].bytes;
    };
    return withMetadata(bytes, proc::parsePab, first);
}
Complaint alta(Bytes bytes) { return withMetadata(bytes, proc::parseAlta, proc::writeAlta); }
Complaint exrTiles(Bytes bytes) {
    return withMetadata(bytes, proc::decodeExrTiles, [](const auto& table, const auto& about) {
        return proc::encodeExrTiles(table, about);
    });
}
Complaint exrAtlas(Bytes bytes) {
    return thereAndBack(bytes, proc::decodeExrAtlas, [](const auto& files) {
        std::vector<proc::AtlasSample> samples;
        for (const auto& file : files) samples.push_back({file.content, file.about});
        return proc::encodeExrAtlas(samples);
    });
}
Complaint klems(Bytes bytes) { return only(bytes, proc::parseKlems); }
/// Both kinds of file that the format has.
Complaint rt300s(Bytes bytes) {
    if (!proc::isJdv(bytes)) return only(bytes, proc::parseRt300sCsv);
    const auto blocks = proc::parseJdv(bytes, "in");
    if (!blocks) return blocks.error();
    (void)proc::tableOfJdv(blocks->content);
    return std::nullopt;
}
Complaint stil(Bytes bytes) { return only(bytes, proc::parseStilText); }
Complaint points(Bytes bytes) { return only(bytes, proc::parsePoints); }
Complaint sniff(Bytes bytes) {
    for (const char* path : {"in.bsdf", "in.csv", "in"}) {
        (void)proc::sniff(bytes, bytes.size(), path);
    }
    return std::nullopt;
}

constexpr std::array kReaders{
    Reader{"gonio", false, soundGonio, gonio},
    Reader{"graw", false, soundGraw, graw},
    Reader{"zemax", true, soundZemax, zemax},
    Reader{"lighttools", true, soundLightTools, lightTools},
    Reader{"merl", false, soundMerl, merl},
    Reader{"utia", false, soundUtia, utia},
    Reader{"rgl", false, soundRgl, rgl},
    Reader{"bird", true, soundBird, bird},
    Reader{"speos", true, soundSpeos, speos},
    Reader{"mbsdf", false, soundMbsdf, mbsdf},
    Reader{"ssdd", true, soundSsdd, ssdd},
    Reader{"astm", true, soundAstm, astm},
    Reader{"pab", true, soundPab, pab},
    Reader{"alta", true, soundAlta, alta},
    Reader{"csv", true, soundCsv, csv},
    Reader{"exr-tiles", false, soundExrTiles, exrTiles},
    Reader{"exr-atlas", false, soundExrAtlas, exrAtlas},
    Reader{"rt300s", true, soundRt300s, rt300s},
    Reader{"klems", true, soundKlems, klems},
    Reader{"stil", true, soundStil, stil},
    Reader{"points", true, soundPoints, points},
    Reader{"sniff", true, soundHeads, sniff},
};

}  // namespace

std::span<const Reader> readers() { return kReaders; }

const Reader* readerOf(std::string_view name) {
    const auto* found = std::find_if(
        kReaders.begin(), kReaders.end(), [&](const Reader& each) { return each.name == name; });
    return found == kReaders.end() ? nullptr : found;
}

}  // namespace gonio::test
