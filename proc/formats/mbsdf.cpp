#include "proc/formats/mbsdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "proc/formats/little_endian.h"
#include "proc/formats/quoted_lines.h"
#include "proc/formats/shown.h"
#include "proc/table/axis.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kMagic = "NVIDIA ARC MBSDF V1\n";
constexpr std::string_view kPlain = "MBSDF_DATA=\n";
constexpr std::string_view kReflection = "MBSDF_DATA_REFLECTION=\n";
constexpr std::string_view kTransmission = "MBSDF_DATA_TRANSMISSION=\n";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Centres of even cells.
std::vector<double> centres(std::size_t cells, double span) {
    std::vector<double> axis;
    const double step = span / static_cast<double>(cells);
    for (std::size_t i = 0; i < cells; ++i) axis.push_back((static_cast<double>(i) + 0.5) * step);
    return axis;
}

/// theta_out of a block, ascending: from 90 to 180 in transmission.
std::vector<double> thetaAxis(std::size_t cells, bool transmission) {
    std::vector<double> axis = centres(cells, 90);
    if (!transmission) return axis;
    for (double& theta : axis) theta = 180 - theta;
    std::reverse(axis.begin(), axis.end());
    return axis;
}

void appendBlocks(SphericalTable& table, const MbsdfShape& shape, bool transmission) {
    const std::vector<double> azimuths = centres(shape.azimuths, 180);
    const std::vector<double> thetas = thetaAxis(shape.thetas, transmission);
    for (const double incidence : centres(shape.thetas, 90)) {
        for (std::size_t channel = 0; channel < table.channels.size(); ++channel) {
            SphericalBlock block;
            block.channel = channel;
            block.incidenceDeg = incidence;
            block.transmission = transmission;
            block.azimuthDeg = azimuths;
            block.thetaDeg = thetas;
            block.f.assign(azimuths.size() * thetas.size(), kNan);
            table.blocks.push_back(std::move(block));
        }
    }
}

/// Calls visit(block, node of the block) in the order of the file's values.
template <class Blocks, class Visit>
void eachValue(Blocks&& blocks, std::size_t channels, const Visit& visit) {
    for (std::size_t first = 0; first < blocks.size(); first += channels) {
        const SphericalBlock& shape = blocks[first];
        const std::size_t thetas = shape.thetaDeg.size();
        for (std::size_t theta = 0; theta < thetas; ++theta) {
            const std::size_t at = shape.transmission ? thetas - 1 - theta : theta;
            for (std::size_t azimuth = 0; azimuth < shape.azimuthDeg.size(); ++azimuth) {
                for (std::size_t channel = 0; channel < channels; ++channel) {
                    visit(blocks[first + channel], shape.index(azimuth, at));
                }
            }
        }
    }
}

class Reader {
public:
    Reader(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

    Result<FileRead<SphericalTable>> read() {
        if (!bytes_.starts_with(kMagic)) return fail("wanted the line NVIDIA ARC MBSDF V1");
        at_ = kMagic.size();
        if (auto about = metadata(); !about) return about.error();
        bool transmission = false;
        if (!takes(kPlain) && !takes(kReflection)) {
            if (!takes(kTransmission)) return fail("wanted MBSDF_DATA=");
            transmission = true;
        }
        if (auto block = data(transmission); !block) return block.error();
        if (!transmission && takes(kTransmission)) {
            if (auto block = data(true); !block) return block.error();
        }
        if (at_ != bytes_.size()) return fail("nothing after the last block");
        if (negative_ > 0) read_.warnings.push_back(std::to_string(negative_) + " negative values");
        return std::move(read_);
    }

private:
    [[nodiscard]] Error fail(const std::string& what) const {
        return {ErrorKind::File,
                "mbsdf: " + std::string(name_) + ": byte " + std::to_string(at_) + ": " + what};
    }
    bool takes(std::string_view text) {
        if (!bytes_.substr(at_).starts_with(text)) return false;
        at_ += text.size();
        return true;
    }

    Result<void> metadata() {
        while (!bytes_.substr(at_).starts_with("MBSDF_DATA")) {
            const auto line = quotedLine(bytes_.substr(at_));
            if (!line) return fail("wanted key=\"value\" or MBSDF_DATA=");
            if (line->key == "comment") {
                read_.about.comments.push_back(line->value);
            } else if (read_.about.values.contains(line->key)) {
                return fail(shown(line->key) + " is given twice");
            } else {
                read_.about.values[line->key] = line->value;
            }
            at_ += line->bytes;
        }
        return {};
    }

    Result<void> data(bool transmission) {
        constexpr std::size_t kHead = 3 * sizeof(std::uint32_t);
        if (bytes_.size() - at_ < kHead) return fail("the file ends in the head of a block");
        const auto type = littleAt<std::uint32_t>(bytes_, at_);
        const MbsdfShape shape{littleAt<std::uint32_t>(bytes_, at_ + 4),
                               littleAt<std::uint32_t>(bytes_, at_ + 8)};
        if (type > 1) return fail("type " + std::to_string(type) + ", wanted 0 or 1");
        const std::size_t channels = type == 0 ? 1 : 3;
        if (auto fits = checkSize(shape, channels); !fits) return fits.error();
        at_ += kHead;
        return values(shape, channels, transmission);
    }

    [[nodiscard]] Result<void> checkSize(const MbsdfShape& shape, std::size_t channels) const {
        const std::size_t left = (bytes_.size() - at_) / sizeof(float) - 3;
        std::size_t wanted = shape.thetas * shape.azimuths;  // of 32 bits each
        const bool over = __builtin_mul_overflow(wanted, shape.thetas, &wanted) ||
                          __builtin_mul_overflow(wanted, channels, &wanted);
        if (over || wanted == 0 || wanted > left) {
            return fail("block of " + std::to_string(shape.thetas) + " x " +
                        std::to_string(shape.thetas) + " x " + std::to_string(shape.azimuths) +
                        " x " + std::to_string(channels) + " values, " + std::to_string(left) +
                        " are left");
        }
        if (!read_.content.channels.empty() && read_.content.channels.size() != channels) {
            return fail("transmission has another type than reflection");
        }
        return {};
    }

    Result<void> values(const MbsdfShape& shape, std::size_t channels, bool transmission) {
        SphericalTable part;
        part.channels.resize(channels);
        if (channels == 3) part.channels = {{"R", {}}, {"G", {}}, {"B", {}}};
        appendBlocks(part, shape, transmission);
        bool finite = true;
        eachValue(part.blocks, channels, [&](SphericalBlock& block, std::size_t node) {
            const auto f = static_cast<double>(littleAt<float>(bytes_, at_));
            finite = finite && std::isfinite(f);
            if (!finite) return;
            at_ += sizeof(float);
            negative_ += f < 0 ? 1U : 0U;
            block.f[node] = f;
        });
        if (!finite) return fail("not a finite number");
        SphericalTable& table = read_.content;
        table.channels = part.channels;
        table.planeSymmetrical = true;
        table.cellCentred = true;
        std::move(part.blocks.begin(), part.blocks.end(), std::back_inserter(table.blocks));
        return {};
    }

    std::string_view bytes_, name_;
    std::size_t at_ = 0;
    std::size_t negative_ = 0;
    FileRead<SphericalTable> read_;
};

/// The shape of one kind's blocks; nothing where there are none.
std::optional<MbsdfShape> shapeOf(const SphericalTable& table, bool transmission) {
    for (const SphericalBlock& block : table.blocks) {
        if (block.transmission != transmission) continue;
        return MbsdfShape{block.thetaDeg.size(), block.azimuthDeg.size()};
    }
    return std::nullopt;
}

bool sameBlock(const SphericalBlock& a, const SphericalBlock& b) {
    constexpr double kRounding = 1e-9;  // degrees
    return a.channel == b.channel && a.transmission == b.transmission &&
           a.lightAzimuthDeg == b.lightAzimuthDeg && a.f.size() == b.f.size() &&
           std::abs(a.incidenceDeg - b.incidenceDeg) <= kRounding &&
           sameAxis(a.azimuthDeg, b.azimuthDeg, kRounding) &&
           sameAxis(a.thetaDeg, b.thetaDeg, kRounding);
}

/// Why the table is none of the format's; empty when it is.
std::string complaint(const SphericalTable& table) {
    const std::size_t channels = table.channels.size();
    const bool rgb = channels == 3 && table.channels[0].name == "R" &&
                     table.channels[1].name == "G" && table.channels[2].name == "B";
    if (channels != 1 && !rgb) return "wanted one channel, or R, G, B";
    if (!table.planeSymmetrical || table.mirrorAzimuthDeg != 180) {
        return "wanted a plane-symmetrical table with the mirror direction at azimuth 180";
    }
    const auto reflection = shapeOf(table, false);
    SphericalTable grid;
    grid.channels = table.channels;
    if (reflection) appendBlocks(grid, *reflection, false);
    if (const auto shape = shapeOf(table, true)) appendBlocks(grid, *shape, true);
    if (table.blocks.empty() || !std::equal(table.blocks.begin(),
                                            table.blocks.end(),
                                            grid.blocks.begin(),
                                            grid.blocks.end(),
                                            sameBlock)) {
        return "the directions are not the centres of the format's cells";
    }
    return "";
}

void appendData(Written& out, const SphericalTable& table, bool transmission) {
    const auto shape = shapeOf(table, transmission);
    if (!shape) return;
    out.bytes += transmission ? kTransmission : kReflection;
    appendLittle<std::uint32_t>(out.bytes, table.channels.size() == 3 ? 1 : 0);
    appendLittle(out.bytes, static_cast<std::uint32_t>(shape->thetas));
    appendLittle(out.bytes, static_cast<std::uint32_t>(shape->azimuths));
    const std::size_t blocks = shape->thetas * table.channels.size();
    const std::span all(table.blocks);
    std::size_t missing = 0;
    eachValue(transmission ? all.last(blocks) : all.first(blocks),
              table.channels.size(),
              [&](const SphericalBlock& block, std::size_t node) {
                  const auto f = static_cast<float>(block.f[node]);
                  missing += std::isfinite(f) ? 0U : 1U;
                  appendLittle(out.bytes, std::isfinite(f) ? f : 0.0F);
              });
    out.loss.add(Loss::Masked, "nodes without a finite value, written as 0", missing);
}

}  // namespace

SphericalTable mbsdfGrid(std::vector<Channel> channels,
                         MbsdfShape reflection,
                         std::optional<MbsdfShape> transmission) {
    SphericalTable grid;
    grid.channels = std::move(channels);
    grid.planeSymmetrical = true;
    grid.cellCentred = true;
    appendBlocks(grid, reflection, false);
    if (transmission) appendBlocks(grid, *transmission, true);
    return grid;
}

Result<FileRead<SphericalTable>> parseMbsdf(std::string_view bytes, std::string_view name) {
    return Reader(bytes, name).read();
}

Result<Written> writeMbsdf(const SphericalTable& table, const Metadata& about) {
    if (const std::string wrong = complaint(table); !wrong.empty()) {
        return Error{ErrorKind::Usage, "mbsdf: " + wrong};
    }
    Written out;
    out.bytes = kMagic;
    std::size_t dropped = 0;
    for (const auto& [key, value] : about.values) {
        if (isQuotedKey(key) && key != "comment") {
            appendQuotedLine(out.bytes, {.key = key, .value = value});
        } else {
            ++dropped;
        }
    }
    for (const std::string& comment : about.comments) {
        appendQuotedLine(out.bytes, {.key = "comment", .value = comment});
    }
    out.loss.add(Loss::Dropped, "metadata entries", dropped);
    std::size_t wavelengths = 0;
    for (const Channel& channel : table.channels) wavelengths += channel.nanometres ? 1U : 0U;
    out.loss.add(Loss::Dropped, "wavelengths of channels", wavelengths);
    appendData(out, table, false);
    appendData(out, table, true);
    return out;
}

}  // namespace gonio::proc
