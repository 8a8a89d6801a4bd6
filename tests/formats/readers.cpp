#include "tests/formats/readers.h"

#include <algorithm>
#include <array>

#include "proc/formats/gonio_exr.h"
#include "proc/formats/graw_exr.h"
#include "proc/formats/mbsdf.h"
#include "proc/formats/merl.h"
#include "proc/formats/points_csv.h"
#include "proc/formats/sniff.h"
#include "proc/formats/utia.h"
#include "proc/formats/zemax.h"
#include "tests/formats/small_files.h"

namespace gonio::test {
namespace {

using Complaint = std::optional<Error>;
using Files = std::vector<std::string>;

std::string bytesOf(const proc::Written& written) { return written.bytes; }
std::string bytesOf(const std::string& bytes) { return bytes; }

/// What a reader made of the bytes, written and read again. A writer may refuse.
template <class Read, class Write>
Complaint thereAndBack(std::string_view bytes, const Read& read, const Write& write) {
    const auto table = read(bytes);
    if (!table) return table.error();
    const auto written = write(*table);
    if (!written) return std::nullopt;
    const auto back = read(bytesOf(*written));
    if (back) return std::nullopt;
    return Error{ErrorKind::Internal, "does not read what it wrote: " + back.error().message};
}

// --- .gonio, .graw ---

Complaint gonio(std::string_view bytes) {
    return thereAndBack(
        bytes, [](auto b) { return proc::decodeGonio(b, "in"); }, proc::encodeGonio);
}
Files soundGonio() { return {*proc::encodeGonio(smallSample())}; }

Complaint graw(std::string_view bytes) {
    return thereAndBack(
        bytes, [](auto b) { return proc::decodeGraw(b, "in"); }, proc::encodeGraw);
}
Files soundGraw() { return {*proc::encodeGraw(smallCapture())}; }

// --- Zemax ---

Complaint zemax(std::string_view bytes) {
    return thereAndBack(
        bytes,
        [](auto b) { return proc::parseZemax(b, "in"); },
        [](const auto& table) { return std::optional(proc::writeZemax(table)); });
}
Files soundZemax() {
    const std::string mono = smallZemax();
    const std::size_t data = mono.find("\nMonochrome\n") + 1;
    const std::string section = mono.substr(mono.find("DataBegin"));
    return {mono,
            replaced(mono.substr(0, data), "Monochrome", "XYZ") + "TristimulusX\n" + section +
                "TristimulusY\n" + section + "TristimulusZ\n" + section,
            replaced(mono, "PlaneSymmetrical", "ASymmetrical4D")};
}

// --- MERL, UTIA, .mbsdf ---

Complaint merl(std::string_view bytes) {
    return thereAndBack(
        bytes,
        [](auto b) { return proc::parseMerl(b, "in"); },
        [](const auto& file) { return std::optional(proc::writeMerl(file.content, file.about)); });
}
/// Of 3 x 2 x 4 cells: 588 bytes.
Files soundMerl() {
    std::string bytes;
    for (const char count : {'\3', '\2', '\4'}) bytes += std::string{count, 0, 0, 0};
    for (int i = 0; i < 3 * 24; ++i) {
        const double value = i % 7 == 0 ? -1 : 100.0 + i;
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);  // NOLINT
    }
    return {bytes};
}

Complaint utia(std::string_view bytes) {
    return thereAndBack(
        bytes,
        [](auto b) { return proc::parseUtia(b, "in"); },
        [](const auto& file) { return proc::writeUtia(file.content, file.about); });
}
Files soundUtia() { return {proc::writeUtia(proc::utiaGrid())->bytes}; }

Complaint mbsdf(std::string_view bytes) {
    return thereAndBack(
        bytes,
        [](auto b) { return proc::parseMbsdf(b, "in"); },
        [](const auto& file) { return proc::writeMbsdf(file.content, file.about); });
}
Files soundMbsdf() {
    Files files;
    proc::Metadata about;
    about.set(proc::key::kSample, "a \"test\" tile");
    for (const bool colours : {false, true}) {
        auto channels = colours ? proc::Channel::ofBands() : std::vector<proc::Channel>(1);
        auto table =
            proc::mbsdfGrid(std::move(channels),
                            {.thetas = 3, .azimuths = 4},
                            colours ? std::optional(proc::MbsdfShape{2, 2}) : std::nullopt);
        for (auto& block : table.blocks) std::fill(block.f.begin(), block.f.end(), 0.25);
        files.push_back(proc::writeMbsdf(table, about)->bytes);
    }
    return files;
}

// --- What is no BRDF ---

Complaint points(std::string_view bytes) {
    const auto read = proc::parsePoints(bytes, "in");
    return read ? Complaint() : read.error();
}
Files soundPoints() { return {smallPoints()}; }

Complaint sniff(std::string_view bytes) {
    for (const char* path : {"in.bsdf", "in.csv", "in"}) {
        (void)proc::sniff(bytes, bytes.size(), path);
    }
    return std::nullopt;
}
Files soundHeads() {
    return {
        smallZemax(), smallPoints(), std::string("tensor_file\0\1\0", 14), "AOI 10\nSide Front\n"};
}

constexpr std::array kReaders{
    Reader{"gonio", false, soundGonio, gonio},
    Reader{"graw", false, soundGraw, graw},
    Reader{"zemax", true, soundZemax, zemax},
    Reader{"merl", false, soundMerl, merl},
    Reader{"utia", false, soundUtia, utia},
    Reader{"mbsdf", false, soundMbsdf, mbsdf},
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
