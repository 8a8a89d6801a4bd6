#include "proc/formats/merl.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "proc/formats/little_endian.h"
#include "proc/formats/merl_planes.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kHeader = 3 * sizeof(std::int32_t);
constexpr std::size_t kWholeCircle = 360;
constexpr std::string_view kBandNames = "RGB";

Error failed(std::string_view name, const std::string& what) {
    return {ErrorKind::File, "merl: " + std::string(name) + ": " + what};
}

/// The axes of a file whose length they explain.
Result<HalfDifferenceTable> axesOf(std::string_view bytes, std::string_view name) {
    if (bytes.size() < kHeader) {
        return failed(name, std::to_string(bytes.size()) + " bytes, wanted a header of 12");
    }
    std::array<std::int32_t, 3> counts{};
    std::string shape;
    std::size_t size = 3 * sizeof(double);
    bool sound = true;
    for (std::size_t i = 0; i < 3; ++i) {
        counts[i] = littleAt<std::int32_t>(bytes, i * sizeof(std::int32_t));
        shape += (i > 0 ? " x " : "") + std::to_string(counts[i]);
        const auto count = static_cast<std::size_t>(std::max(counts[i], 0));
        sound = sound && count > 0 && !__builtin_mul_overflow(size, count, &size);
    }
    if (!sound || size > std::numeric_limits<std::size_t>::max() - kHeader) {
        return failed(name,
                      "header has " + shape + " values, wanted three counts such as 90 x 90 x 180");
    }
    if (bytes.size() != kHeader + size) {
        return failed(name,
                      std::to_string(bytes.size()) + " bytes, " + shape + " want " +
                          std::to_string(kHeader + size));
    }
    HalfDifferenceTable table;
    table.thetaHalfCount = static_cast<std::size_t>(counts[0]);
    table.thetaDiffCount = static_cast<std::size_t>(counts[1]);
    table.phiDiffCount = static_cast<std::size_t>(counts[2]);
    table.wholeCircle = table.phiDiffCount == kWholeCircle;
    return table;
}

/// Where the first value of a plane that is no number stands.
Error notFinite(std::string_view name, std::size_t band, std::string_view plane) {
    std::size_t at = 0;
    while (std::isfinite(littleAt<double>(plane, at))) at += sizeof(double);
    return failed(name,
                  "plane " + std::string(kBandNames.substr(band, 1)) + ", value " +
                      std::to_string(at / sizeof(double)) + " is not a finite number");
}

/// Of the numbers that read back as f the smallest, where there is one; else one that reads back as
/// a neighbour of f.
double storedOf(double f, double scale) {
    constexpr double kUp = std::numeric_limits<double>::infinity();
    const auto among = [scale](double wanted) {
        double stored = std::nextafter(wanted / scale, 0);
        for (int i = 0; i < 3; ++i, stored = std::nextafter(stored, kUp)) {
            if (stored * scale == wanted) return stored;
        }
        return -1.0;
    };
    if (const double exact = among(f); exact >= 0) return exact;
    return std::max(among((f / scale) * scale), 0.0);
}

/// What lies below the horizon is missing in every table: no loss.
void appendPlane(Written& out, const HalfDifferenceTable& table, std::size_t band) {
    const double scale = kMerlScale[band];
    std::size_t missing = 0;
    std::size_t negative = 0;
    for (std::size_t i = 0; i < table.planes[band].size(); ++i) {
        const double f = table.planes[band][i];
        const bool none = !std::isfinite(f) || !std::isfinite(f / scale);
        missing += none && aboveHorizon(table.pairAt(table.nodeAt(i))) ? 1U : 0U;
        negative += !none && f < 0 ? 1U : 0U;
        appendLittle(out.bytes, none || f < 0 ? -1.0 : storedOf(f, scale));
    }
    out.loss.add(Loss::Masked, "nodes without a finite value, written as -1", missing);
    out.loss.add(Loss::Masked, "negative values, which the format takes for none", negative);
}

}  // namespace

Result<FileRead<HalfDifferenceTable>> parseMerl(std::string_view bytes, std::string_view name) {
    auto table = axesOf(bytes, name);
    if (!table) return table.error();
    FileRead<HalfDifferenceTable> read{.content = std::move(*table), .about = {}};
    const std::size_t planeBytes = read.content.nodeCount() * sizeof(double);
    std::size_t negative = 0;
    for (std::size_t band = 0; band < 3; ++band) {
        const std::string_view raw = bytes.substr(kHeader + band * planeBytes, planeBytes);
        MerlPlane plane = decodeMerlPlane(raw, kMerlScale[band]);
        if (!plane.finite) return notFinite(name, band, raw);
        negative += plane.negative;
        read.content.planes[band] = std::move(plane.f);
    }
    if (negative > 0) {
        read.warnings.push_back(std::to_string(negative) + " negative values: no data there");
    }
    return read;
}

Written writeMerl(const HalfDifferenceTable& table, const Metadata& about) {
    Written out;
    out.bytes.reserve(kHeader + 3 * table.nodeCount() * sizeof(double));
    for (const std::size_t count :
         {table.thetaHalfCount, table.thetaDiffCount, table.phiDiffCount}) {
        appendLittle(out.bytes, static_cast<std::int32_t>(count));
    }
    for (std::size_t band = 0; band < 3; ++band) {
        appendPlane(out, table, band);
    }
    out.loss.add(Loss::Dropped, "metadata entries", about.values.size() + about.comments.size());
    return out;
}

}  // namespace gonio::proc
