#include "proc/formats/utia.h"

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "proc/formats/exr_parts.h"
#include "proc/formats/little_endian.h"

namespace gonio::proc {
namespace {

constexpr std::size_t kThetas = 6, kPhis = 48;
constexpr std::size_t kDirections = kThetas * kPhis;
constexpr std::size_t kPlane = kDirections * kDirections;
constexpr std::size_t kBytes = 3 * kPlane * sizeof(double);
constexpr double kThetaStepDeg = 15, kPhiStepDeg = 7.5;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Error failed(std::string_view name, const std::string& what) {
    return {ErrorKind::File, "utia: " + std::string(name) + ": " + what};
}

/// Where a node of the table stands in the file.
struct UtiaNode {
    std::size_t plane = 0, thetaIn = 0, phiIn = 0, theta = 0, azimuth = 0;

    [[nodiscard]] std::size_t block() const { return (plane * kThetas + thetaIn) * kPhis + phiIn; }
    [[nodiscard]] std::size_t column() const { return kPhis * theta + (phiIn + azimuth) % kPhis; }
    [[nodiscard]] std::size_t row() const { return kPhis * thetaIn + phiIn; }
};

/// All nodes, those of a block one after another.
template <class Visit>
void eachNode(const Visit& visit) {
    UtiaNode n;
    for (n.plane = 0; n.plane < 3; ++n.plane) {
        for (n.thetaIn = 0; n.thetaIn < kThetas; ++n.thetaIn) {
            for (n.phiIn = 0; n.phiIn < kPhis; ++n.phiIn) {
                for (n.azimuth = 0; n.azimuth < kPhis; ++n.azimuth) {
                    for (n.theta = 0; n.theta < kThetas; ++n.theta) visit(n);
                }
            }
        }
    }
}

std::vector<double> evenly(std::size_t count, double step) {
    std::vector<double> axis;
    for (std::size_t i = 0; i < count; ++i) axis.push_back(static_cast<double>(i) * step);
    return axis;
}

double scaled(double number, UtiaScale scale) {
    if (scale == UtiaScale::Raw) return number;
    constexpr double kStraight = 0.0375;
    const double v = number / 140;
    return 100 * (v > kStraight ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92);
}

/// `numberAt(node)` is the file's.
template <class NumberAt>
FileRead<SphericalTable> tableOf(const NumberAt& numberAt, UtiaScale scale) {
    FileRead<SphericalTable> read{.content = utiaGrid(), .about = {}};
    std::size_t negative = 0;
    eachNode([&](const UtiaNode& n) {
        SphericalBlock& block = read.content.blocks[n.block()];
        const double number = numberAt(n);
        negative += number < 0 ? 1U : 0U;
        block.f[block.index(n.azimuth, n.theta)] = scaled(number, scale);
    });
    if (scale == UtiaScale::Raw) {
        read.warnings.emplace_back(
            "the scale of UTIA files is disputed: the numbers are taken for f in 1/sr as they are");
    }
    if (negative > 0) read.warnings.push_back(std::to_string(negative) + " negative values");
    return read;
}

/// Why the table is not one of the format's grid; empty when it is.
std::string complaint(const SphericalTable& table) {
    const SphericalTable grid = utiaGrid();
    if (table.channels.size() != 3) return "wanted the channels R, G, B";
    for (std::size_t i = 0; i < 3; ++i) {
        if (table.channels[i].name != grid.channels[i].name) return "wanted the channels R, G, B";
    }
    if (table.planeSymmetrical || table.mirrorAzimuthDeg != grid.mirrorAzimuthDeg ||
        table.blocks.size() != grid.blocks.size()) {
        return "wanted " + std::to_string(grid.blocks.size()) +
               " blocks whose azimuth is phi_v - phi_i";
    }
    for (std::size_t i = 0; i < grid.blocks.size(); ++i) {
        const SphericalBlock& a = table.blocks[i];
        const SphericalBlock& b = grid.blocks[i];
        if (a.channel != b.channel || a.transmission || a.incidenceDeg != b.incidenceDeg ||
            a.lightAzimuthDeg != b.lightAzimuthDeg || a.azimuthDeg != b.azimuthDeg ||
            a.thetaDeg != b.thetaDeg || a.f.size() != b.f.size()) {
            return "block " + std::to_string(i) + " has other directions than the format's grid";
        }
    }
    return "";
}

}  // namespace

SphericalTable utiaGrid() {
    SphericalTable grid;
    for (const char* name : {"R", "G", "B"}) grid.channels.push_back({name, std::nullopt});
    const std::vector<double> azimuths = evenly(kPhis, kPhiStepDeg);
    const std::vector<double> thetas = evenly(kThetas, kThetaStepDeg);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        for (const double incidence : thetas) {
            for (const double azimuth : azimuths) {
                SphericalBlock block;
                block.channel = channel;
                block.lightAzimuthDeg = azimuth;
                block.incidenceDeg = incidence;
                block.azimuthDeg = azimuths;
                block.thetaDeg = thetas;
                block.f.assign(kDirections, kNan);
                grid.blocks.push_back(std::move(block));
            }
        }
    }
    return grid;
}

Result<FileRead<SphericalTable>> parseUtia(std::string_view bytes,
                                           std::string_view name,
                                           UtiaScale scale) {
    if (bytes.size() != kBytes) {
        return failed(name,
                      std::to_string(bytes.size()) + " bytes, wanted " + std::to_string(kBytes));
    }
    for (std::size_t i = 0; i < 3 * kPlane; ++i) {
        if (!std::isfinite(littleAt<double>(bytes, i * sizeof(double)))) {
            return failed(name, "value " + std::to_string(i) + " is not a finite number");
        }
    }
    const auto numberAt = [&](const UtiaNode& n) {
        const std::size_t at = n.plane * kPlane + kDirections * n.row() + n.column();
        return littleAt<double>(bytes, at * sizeof(double));
    };
    return tableOf(numberAt, scale);
}

Result<FileRead<SphericalTable>> parseUtiaExr(std::string_view bytes,
                                              std::string_view name,
                                              UtiaScale scale) {
    constexpr int kSide = static_cast<int>(kDirections);
    const auto parts = decodeExr(
        bytes, {.largest = {kSide, kSide}, .parts = 1, .bytes = 4 * kPlane * sizeof(float)});
    if (!parts) return parts.error().in("utia: " + std::string(name));
    const ExrPart& picture = parts->front();
    std::array<const std::vector<float>*, 3> planes{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto found = picture.floats.find(std::string("RGB").substr(i, 1));
        if (found == picture.floats.end() || picture.size != Size{kSide, kSide}) {
            return failed(name, "wanted a picture of 288 x 288 pixels with R, G and B");
        }
        planes[i] = &found->second;
        for (const float number : found->second) {
            if (!std::isfinite(number)) return failed(name, "a value is not a finite number");
        }
    }
    const auto numberAt = [&](const UtiaNode& n) {
        return static_cast<double>((*planes[n.plane])[kDirections * n.row() + n.column()]);
    };
    return tableOf(numberAt, scale);
}

Result<Written> writeUtia(const SphericalTable& table, const Metadata& about) {
    if (const std::string wrong = complaint(table); !wrong.empty()) {
        return Error{ErrorKind::Usage, "utia: " + wrong};
    }
    std::vector<double> numbers(3 * kPlane);
    std::size_t missing = 0;
    eachNode([&](const UtiaNode& n) {
        const SphericalBlock& block = table.blocks[n.block()];
        const double f = block.f[block.index(n.azimuth, n.theta)];
        missing += std::isfinite(f) ? 0U : 1U;
        numbers[n.plane * kPlane + kDirections * n.row() + n.column()] = std::isfinite(f) ? f : 0;
    });
    Written out;
    out.bytes.reserve(kBytes);
    for (const double number : numbers) appendLittle(out.bytes, number);
    out.loss.add(Loss::Clamped, "missing values, written as 0: they read as black", missing);
    out.loss.add(Loss::Dropped, "metadata entries", about.values.size() + about.comments.size());
    return out;
}

}  // namespace gonio::proc
