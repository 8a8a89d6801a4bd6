#include "proc/formats/exr_atlas.h"

#include <algorithm>
#include <cmath>

#include "proc/core/number_text.h"
#include "proc/formats/exr_tile_layout.h"
#include "proc/formats/exr_tile_pixels.h"
#include "proc/formats/metadata_text.h"
#include "proc/table/specular_integral.h"

namespace gonio::proc {
namespace {

constexpr float kMostHalf = 65504;

/// Why a table cannot be in a picture; empty when it can.
std::string complaint(const SpecularTable& table) {
    if (table.colour == TableColour::Xyz) return "CIE XYZ, wanted the LED bands or one band";
    if (table.rotationDeg.size() != 1) return "several rotations, wanted one";
    if (table.incidenceDeg.empty() || !tileSizeOf(table)) {
        return "the axes are not the centres of a tile's pixels";
    }
    if (table.planes.size() != planeCount(table.colour)) return "planes that are not its colour's";
    for (const TablePlane& plane : table.planes) {
        if (plane.f.size() != table.nodeCount() || plane.tis.size() != table.incidenceDeg.size()) {
            return "planes that are not of its axes' size";
        }
    }
    return "";
}

/// Why a sample does not go with the first; empty when it does.
std::string mismatch(const SpecularTable& first, const SpecularTable& other) {
    if (first.incidenceDeg != other.incidenceDeg) return "other incidences than the first sample";
    if (tileSizeOf(first) != tileSizeOf(other)) return "another size than the first sample";
    if (first.kind != other.kind) return "another kind than the first sample";
    if (first.symmetry != other.symmetry) return "another symmetry than the first sample";
    return "";
}

std::vector<float> radiansOf(const std::vector<double>& degrees) {
    std::vector<float> radians;
    for (const double angle : degrees) {
        radians.push_back(static_cast<float>(Radians::fromDegrees(angle).value()));
    }
    return radians;
}

/// What a picture holds beside its pixels.
void appendAttributes(ExrPart& part,
                      std::span<const AtlasSample> samples,
                      const ExrTileLayout& layout,
                      LossReport& loss) {
    const SpecularTable& first = samples.front().table;
    part.numbers["bsdfTileAngles"] = radiansOf(first.incidenceDeg);
    part.text["bsdfSymmetry"] =
        first.symmetry == TableSymmetry::PlaneSymmetrical ? "PlaneSymmetrical" : "Asymmetrical";
    part.text["bsdfType"] = first.kind == ScatterKind::Brdf ? "BRDF" : "BTDF";
    const std::string_view method = samples.front().about.at("method");
    part.text["bsdfMethod"] = method.empty() ? "measured" : std::string(method);
    part.text["gonioAngleUnit"] = "rad";
    part.text["gonioPixelPhase"] = "centre";
    part.text["gonioTileColumns"] = std::to_string(layout.columns);
    if (samples.size() > 1) {
        part.text["gonioAtlas"] =
            std::to_string(layout.samples) + " " + std::to_string(layout.innerColumns);
    }
    std::size_t lostTis = 0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const std::string number = samples.size() > 1 ? std::to_string(k) : "";
        Metadata about = samples[k].about;
        about.comments.insert(about.comments.end(),
                              samples[k].table.comments.begin(),
                              samples[k].table.comments.end());
        part.text["gonioAbout" + number] = metadataText(about);
        std::vector<float>& tis = part.numbers["gonioTis" + number];
        const std::vector<TablePlane>& planes = samples[k].table.planes;
        for (std::size_t c = 0; c < part.floats.size(); ++c) {
            const std::size_t plane = std::min(c, planes.size() - 1);
            for (std::size_t i = 0; i < planes[plane].tis.size(); ++i) {
                double value = planes[plane].tis[i];
                if (!std::isfinite(value)) {
                    value = specularIntegral(samples[k].table, plane, {.incidence = i});
                }
                lostTis += std::isfinite(value) ? 0U : 1U;
                tis.push_back(std::isfinite(value) ? static_cast<float>(value) : 0.0F);
            }
        }
    }
    loss.add(Loss::Dropped, "TIS without a finite value, written as 0", lostTis);
}

/// As 16 bits hold it: 11 significant bits, fewer below 2^-14; ties to even.
float asHalf(float value) {
    const int exponent = std::max(std::ilogb(value), -14);
    return std::ldexp(std::nearbyint(std::ldexp(value, 10 - exponent)), exponent - 10);
}

/// Moves what half the bits cannot hold, and counts it.
void narrow(ExrPart& part, LossReport& loss) {
    std::size_t clamped = 0;
    std::size_t vanished = 0;
    std::size_t rounded = 0;
    double largest = 0;
    for (auto& [channel, pixels] : part.floats) {
        for (float& value : pixels) {
            if (std::abs(value) > kMostHalf) {
                value = std::copysign(kMostHalf, value);
                ++clamped;
            }
            if (value == 0) continue;
            const float held = asHalf(value);
            vanished += held == 0 ? 1U : 0U;
            if (held == 0 || held == value) continue;
            ++rounded;
            largest =
                std::max(largest, static_cast<double>(std::abs(held - value) / std::abs(value)));
        }
    }
    loss.add(Loss::Clamped, "values beyond 65504, the most of 16 bits", clamped);
    loss.add(Loss::Masked, "values that are 0 in 16 bits: read as missing", vanished);
    if (rounded == 0) return;
    loss.items.push_back({.kind = Loss::Resampled,
                          .what = "values rounded to 16 bits",
                          .count = rounded,
                          .largestError = largest});
}

}  // namespace

Result<Written> encodeExrAtlas(std::span<const AtlasSample> samples,
                               const ExrAtlasOptions& options) {
    if (samples.empty()) return Error{ErrorKind::Usage, "exr-atlas: no sample"};
    for (const AtlasSample& sample : samples) {
        std::string wrong = complaint(sample.table);
        if (wrong.empty()) wrong = mismatch(samples.front().table, sample.table);
        if (!wrong.empty()) {
            return Error{
                ErrorKind::Usage,
                "exr-atlas: sample " + std::to_string(&sample - samples.data()) + ": " + wrong};
        }
    }
    const Size tile = *tileSizeOf(samples.front().table);
    const ExrTileLayout layout = chosenLayout({.tiles = samples.front().table.incidenceDeg.size(),
                                               .columns = options.columns,
                                               .samples = samples.size(),
                                               .innerColumns = options.innerColumns,
                                               .width = static_cast<std::size_t>(tile.width),
                                               .height = static_cast<std::size_t>(tile.height)});
    if (samples.size() > kMostAtlasSamples) {
        return Error{ErrorKind::Usage,
                     "exr-atlas: more than " + std::to_string(kMostAtlasSamples) + " samples"};
    }
    constexpr std::size_t kMostSide = 1U << 15;
    if (layout.pictureWidth() > kMostSide || layout.pictureHeight() > kMostSide) {
        return Error{ErrorKind::Usage, "exr-atlas: a picture of more than 32768 pixels a side"};
    }
    Written out;
    ExrPart part;
    part.size = {static_cast<int>(layout.pictureWidth()), static_cast<int>(layout.pictureHeight())};
    part.half = options.half;
    paintSamples(part, samples, layout, out.loss);
    if (options.half) narrow(part, out.loss);
    appendAttributes(part, samples, layout, out.loss);
    auto bytes = encodeExr(std::span(&part, 1));
    const std::size_t pixelBytes = part.size.pixels() * part.floats.size() * sizeof(float);
    if (bytes && pixelBytes > mostPixelBytes(bytes->size())) {
        part.packed = false;
        bytes = encodeExr(std::span(&part, 1));
    }
    if (!bytes) return bytes.error().in("exr-atlas");
    out.bytes = std::move(*bytes);
    return out;
}

}  // namespace gonio::proc
