#include "tests/formats/readers.h"

#include "proc/formats/brdf_file.h"
#include "proc/formats/format.h"
#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/points_csv.h"
#include "proc/formats/sniff.h"
#include "tests/formats/small_files.h"

namespace gonio::test {
namespace {

using proc::Format;

std::string xyzZemax() {
    const std::string mono = replaced(smallZemax(), "Content  Monochrome", "Content  XYZ");
    const std::size_t data = mono.find("Monochrome\n");
    const std::string section = mono.substr(data + std::string_view("Monochrome\n").size());
    return mono.substr(0, data) + "TristimulusX\n" + section + "TristimulusY\n" + section +
           "TristimulusZ\n" + section;
}

/// Empty for a format of which there is none yet.
std::vector<std::string> soundFiles(Format format) {
    switch (format) {
        case Format::Gonio: return {*proc::encodeGonio(smallSample())};
        case Format::Graw: return {*proc::encodeGraw(smallCapture())};
        case Format::Zemax:
            return {smallZemax(),
                    xyzZemax(),
                    replaced(replaced(smallZemax(), "PlaneSymmetrical", "ASymmetrical4D"),
                             "# a comment",
                             "# Wavelength (nm) = 525")};
        default: return {};
    }
}

bool isText(Format format) {
    switch (format) {
        case Format::Gonio:
        case Format::Graw:
        case Format::Merl:
        case Format::Utia:
        case Format::Rgl:
        case Format::Mbsdf:
        case Format::ExrTiles:
        case Format::ExrAtlas: return false;
        default: return true;
    }
}

/// A format's reader is there unless it says that it is none for these bytes.
bool isRead(Format format) {
    if (format == Format::Graw) return true;
    const auto read = proc::decodeBrdf(format, "", "none");
    return read || read.error().kind != ErrorKind::Usage;
}

template <class T>
std::optional<Error> complaint(const Result<T>& result) {
    if (result) return std::nullopt;
    return result.error();
}

std::optional<Error> complaintOfFormat(Format format, std::string_view bytes) {
    if (format == Format::Graw) return complaint(proc::decodeGraw(bytes, "in"));
    const auto file = proc::decodeBrdf(format, bytes, "in");
    if (!file) return file.error();
    (void)proc::channelsOf(*file);
    (void)proc::incidencesOf(*file);
    return std::nullopt;
}

}  // namespace

std::vector<Reader> readers() {
    std::vector<Reader> all;
    for (const proc::FormatFacts& facts : proc::formats()) {
        if (!isRead(facts.format)) continue;
        all.push_back({std::string(facts.name), soundFiles(facts.format), isText(facts.format)});
    }
    all.push_back({"points", {smallPoints()}, true});
    all.push_back({"sniff", {smallZemax(), smallPoints()}, true});
    return all;
}

std::optional<Error> complaintOf(std::string_view reader, std::string_view bytes) {
    if (reader == "points") return complaint(proc::parsePoints(bytes, "in"));
    if (reader == "sniff") {
        (void)proc::sniff(bytes, bytes.size(), "in.bsdf");
        (void)proc::sniff(bytes, bytes.size(), "in.csv");
        return std::nullopt;
    }
    const auto format = proc::parseFormat(reader);
    return format ? complaintOfFormat(*format, bytes) : format.error();
}

}  // namespace gonio::test
