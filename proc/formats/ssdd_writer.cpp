#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "proc/core/number_text.h"
#include "proc/formats/far_side.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/ssdd.h"
#include "proc/table/spherical_turn.h"

namespace gonio::proc {
namespace {

/// A comment may hold '#', as it begins with one; a field may not.
std::string oneLine(std::string text, bool comment = false) {
    for (char& c : text) {
        if (c == '\n' || c == '\r' || (c == '#' && !comment)) c = ' ';
    }
    return text;
}

struct Colours {
    std::string model;
    std::vector<std::size_t> channels;  ///< of the table, in the file's order
    std::vector<double> nanometres;
};

std::optional<Colours> coloursOf(const std::vector<Channel>& channels) {
    Colours colours;
    std::map<double, std::size_t> byWavelength;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        if (channels[i].nanometres) byWavelength.emplace(*channels[i].nanometres, i);
    }
    if (!channels.empty() && byWavelength.size() == channels.size()) {
        colours.model = "spectrum";
        for (const auto& [nm, channel] : byWavelength) {
            colours.nanometres.push_back(nm);
            colours.channels.push_back(channel);
        }
        return colours;
    }
    const auto named = [&](std::string_view names) {
        for (std::size_t i = 0; i < channels.size(); ++i) {
            if (channels[i].name != names.substr(i, 1)) return false;
        }
        return channels.size() == 3;
    };
    if (channels.size() == 1) {
        colours.model = "monochrome";
    } else if (named("RGB")) {
        colours.model = "rgb";
    } else if (named("XYZ")) {
        colours.model = "xyz";
    } else {
        return std::nullopt;
    }
    colours.channels.resize(channels.size());
    std::iota(colours.channels.begin(), colours.channels.end(), 0U);
    return colours;
}

/// The grid of one side of the surface; a node that no block has is NaN.
struct Grid {
    std::vector<double> incidences, lights, thetas, azimuths;
    /// By incidence, light, channel.
    std::map<std::array<std::size_t, 3>, const SphericalBlock*> blocks;
};

class Writer {
public:
    Writer(const SphericalTable& table, const Metadata& about, SsddData data)
        : about_(about), data_(data) {
        half_ = table.planeSymmetrical &&
                std::all_of(table.blocks.begin(), table.blocks.end(), [](const SphericalBlock& b) {
                    return b.lightAzimuthDeg == 0;
                });
        table_ = wholeCircle(withMirrorAt(table, 180));
        for (SphericalBlock& block : table_.blocks) toSample(block);
    }

    Result<Written> write() {
        const auto colours = coloursOf(table_.channels);
        if (!colours) {
            return Error{
                ErrorKind::Usage,
                "ssdd: channels have neither wavelengths nor the names R, G, B or X, Y, Z"};
        }
        if (table_.blocks.empty()) return Error{ErrorKind::Usage, "ssdd: table has no blocks"};
        header();
        for (const bool transmission : {false, true}) side(transmission, *colours);
        out_.loss.add(Loss::Masked, "nodes without data, written as 0", masked_);
        out_.loss.add(Loss::Dropped, "TIS as stated", tis_);
        out_.loss.add(Loss::Dropped, "blocks on other axes than the first of their kind", dropped_);
        if (rounded_ > 0) {
            out_.loss.add(Loss::Resampled, "values rounded to single precision", rounded_);
            out_.loss.items.back().largestError = largestError_;
        }
        return std::move(out_);
    }

private:
    /// Azimuths in the sample's frame; half of them for a symmetrical table.
    void toSample(SphericalBlock& block) const {
        SphericalTable one{.channels = {}, .mirrorAzimuthDeg = 180, .blocks = {block}};
        if (block.lightAzimuthDeg != 0) {
            one = withMirrorAt(std::move(one), std::fmod(180 + block.lightAzimuthDeg, 360));
            one.blocks.front().lightAzimuthDeg = block.lightAzimuthDeg;
        }
        block = std::move(one.blocks.front());
        for (double& azimuth : block.azimuthDeg) azimuth = roundedDegrees(azimuth);
        if (!half_) return;
        const auto kept = static_cast<std::size_t>(
            std::upper_bound(block.azimuthDeg.begin(), block.azimuthDeg.end(), 180) -
            block.azimuthDeg.begin());
        block.azimuthDeg.resize(kept);
        block.f.resize(kept * block.thetaDeg.size());
    }

    void header() {
        out_.bytes = "VERSION 0.3\n";
        for (const std::string& line : metadataLines(about_))
            out_.bytes += "# " + oneLine(line, true) + "\n";
        field("SOFTWARE", about_.at(key::kSoftware));
    }
    void field(std::string_view name, std::string_view value) {
        const std::string text = oneLine(std::string(value));
        if (text.find_first_not_of(' ') == std::string::npos) return;
        out_.bytes += std::string(name) + " " + text + "\n";
    }
    void list(std::string_view name, const std::vector<double>& numbers) {
        out_.bytes += name;
        for (const double number : numbers) out_.bytes += " " + shortest(number);
        out_.bytes += "\n";
    }

    [[nodiscard]] Grid gridOf(bool transmission, const Colours& colours) {
        Grid grid;
        std::set<double> incidences;
        std::set<double> lights;
        std::vector<const SphericalBlock*> kept;
        for (const SphericalBlock& block : table_.blocks) {
            if (block.transmission != transmission) continue;
            if (kept.empty()) {
                grid.thetas = thetasFromOwnNormal(block);
                grid.azimuths = block.azimuthDeg;
            } else if (thetasFromOwnNormal(block) != grid.thetas ||
                       block.azimuthDeg != grid.azimuths) {
                ++dropped_;
                continue;
            }
            tis_ += std::isfinite(block.tis) ? 1U : 0U;
            incidences.insert(block.incidenceDeg);
            lights.insert(block.lightAzimuthDeg);
            kept.push_back(&block);
        }
        grid.incidences.assign(incidences.begin(), incidences.end());
        grid.lights.assign(lights.begin(), lights.end());
        const auto place = [](const std::vector<double>& axis, double at) {
            return static_cast<std::size_t>(std::lower_bound(axis.begin(), axis.end(), at) -
                                            axis.begin());
        };
        for (const SphericalBlock* block : kept) {
            const auto channel =
                std::find(colours.channels.begin(), colours.channels.end(), block->channel);
            grid.blocks[{place(grid.incidences, block->incidenceDeg),
                         place(grid.lights, block->lightAzimuthDeg),
                         static_cast<std::size_t>(channel - colours.channels.begin())}] = block;
        }
        return grid;
    }

    void side(bool transmission, const Colours& colours) {
        const Grid grid = gridOf(transmission, colours);
        if (grid.blocks.empty()) return;
        out_.bytes += "\nDATA_TYPE ";
        out_.bytes += transmission ? "btdf\n" : "brdf\n";
        out_.bytes += "COLOR_MODEL " + colours.model + "\n";
        if (colours.model == "spectrum") list("WAVELENGTH_LIST", colours.nanometres);
        out_.bytes += "PARAM_TYPE spherical_coordinate_system\n";
        if (half_) out_.bytes += "REDUCTION_TYPE bilateral_symmetry\n";
        list("PARAM0_LIST", grid.incidences);
        if (grid.lights.size() > 1 || grid.lights[0] != 0) list("PARAM1_LIST", grid.lights);
        list("PARAM2_LIST", grid.thetas);
        list("PARAM3_LIST", grid.azimuths);
        field("NAME", about_.at(key::kSample));
        field("DEVICE", about_.at(key::kRig));
        field("MEASUREMENT_DATE", about_.at(key::kDate).substr(0, 10));
        out_.bytes += data_ == SsddData::Ascii ? "DATA ascii\n" : "DATA binary\n";
        for (std::size_t a = 0; a < grid.azimuths.size(); ++a) {
            for (std::size_t p2 = 0; p2 < grid.thetas.size(); ++p2) {
                const std::size_t t = transmission ? grid.thetas.size() - 1 - p2 : p2;
                point(grid, colours.channels.size(), a, t);
            }
        }
    }

    void point(const Grid& grid, std::size_t channels, std::size_t a, std::size_t t) {
        for (std::size_t light = 0; light < grid.lights.size(); ++light) {
            for (std::size_t incidence = 0; incidence < grid.incidences.size(); ++incidence) {
                for (std::size_t channel = 0; channel < channels; ++channel) {
                    const auto found = grid.blocks.find({incidence, light, channel});
                    const SphericalBlock* block =
                        found == grid.blocks.end() ? nullptr : found->second;
                    value(block == nullptr ? std::nan("") : block->f[block->index(a, t)]);
                    if (data_ == SsddData::Ascii) out_.bytes += channel + 1 < channels ? ' ' : '\n';
                }
            }
        }
    }

    void value(double f) {
        masked_ += std::isfinite(f) ? 0U : 1U;
        if (!std::isfinite(f)) f = 0;
        if (data_ == SsddData::Ascii) {
            out_.bytes += shortest(f);
            return;
        }
        constexpr double kMost = std::numeric_limits<float>::max();
        const auto single = static_cast<float>(std::clamp(f, -kMost, kMost));
        out_.bytes.append(reinterpret_cast<const char*>(&single), sizeof single);  // NOLINT(*cast*)
        if (static_cast<double>(single) == f) return;
        ++rounded_;
        const double error = std::abs(static_cast<double>(single) / f - 1);
        largestError_ = std::max(largestError_, error);
    }

    SphericalTable table_;
    Metadata about_;
    SsddData data_;
    bool half_ = false;
    std::size_t masked_ = 0, tis_ = 0, dropped_ = 0, rounded_ = 0;
    double largestError_ = 0;
    Written out_;
};

}  // namespace

Result<Written> writeSsdd(const SphericalTable& table, const Metadata& about, SsddData data) {
    return Writer(table, about, data).write();
}

}  // namespace gonio::proc
