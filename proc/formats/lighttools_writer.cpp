#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

#include "proc/core/number_text.h"
#include "proc/formats/far_side.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/lighttools.h"
#include "proc/formats/text_lines.h"
#include "proc/table/block_integral.h"
#include "proc/table/spherical_turn.h"

namespace gonio::proc {
namespace {

constexpr std::array<std::string_view, 3> kXyz{"X", "Y", "Z"};

std::vector<double> azimuthsOf(const SphericalBlock& block) {
    std::vector<double> azimuths;
    for (const double azimuth : block.azimuthDeg) azimuths.push_back(roundedDegrees(azimuth));
    return azimuths;
}

std::optional<std::size_t> tristimulus(const Channel& channel) {
    const auto found = std::find(kXyz.begin(), kXyz.end(), channel.name);
    if (found == kXyz.end()) return std::nullopt;
    return static_cast<std::size_t>(found - kXyz.begin());
}

class Writer {
public:
    Writer(const SphericalTable& table, const Metadata& about)
        : table_(withMirrorAt(table, kLightToolsMirrorDeg)), about_(about) {
        for (const Channel& channel : table_.channels) {
            xyz_ = xyz_ || tristimulus(channel).has_value();
        }
    }

    Written write() {
        chooseBlocks();
        header();
        for (const SphericalBlock* block : blocks_) append(*block);
        out_.bytes += "DataEnd\n";
        out_.loss.add(Loss::Masked, "nodes without data, written as 0", masked_);
        out_.loss.add(Loss::Dropped, "TIS that is not known, written as 0", noTis_);
        return std::move(out_);
    }

private:
    void chooseBlocks() {
        std::set<std::tuple<bool, double, double, double>> seen;
        std::size_t channels = 0;
        std::size_t axes = 0;
        for (const SphericalBlock& block : table_.blocks) {
            const Channel& channel = table_.channels[block.channel];
            if (xyz_ && !tristimulus(channel)) {
                ++channels;
                continue;
            }
            const double which =
                xyz_ ? static_cast<double>(*tristimulus(channel)) : channel.nanometres.value_or(0);
            if (!seen.emplace(block.transmission,
                              roundedDegrees(block.incidenceDeg),
                              roundedDegrees(block.lightAzimuthDeg),
                              which)
                     .second) {
                ++channels;
                continue;
            }
            if (blocks_.empty()) {
                azimuths_ = azimuthsOf(block);
                radials_ = thetasFromOwnNormal(block);
            } else if (azimuthsOf(block) != azimuths_ || thetasFromOwnNormal(block) != radials_) {
                ++axes;
                continue;
            }
            blocks_.push_back(&block);
        }
        out_.loss.add(
            Loss::Dropped, "blocks of a channel without a wavelength of its own", channels);
        out_.loss.add(Loss::Dropped, "blocks on other axes than the first", axes);
    }

    void axis(std::string_view keyword, const std::vector<double>& degrees) {
        out_.bytes += std::string(keyword) + "  " + std::to_string(degrees.size()) + "\n";
        for (std::size_t i = 0; i < degrees.size(); ++i) {
            out_.bytes += (i > 0 ? "\t" : "") + shortest(degrees[i]);
        }
        out_.bytes += "\n";
    }

    void header() {
        for (const std::string& line : metadataLines(about_)) {
            out_.bytes += "# " + onOneLine(line) + "\n";
        }
        out_.bytes += "Symmetry  ";
        out_.bytes += table_.planeSymmetrical ? "PlaneSymmetrical\n" : "Asymmetric\n";
        out_.bytes += "SpectralContent  ";
        out_.bytes += xyz_ ? "XYZ\n" : "Monochrome\n";
        axis("ScatterAzimuth", azimuths_);
        axis("ScatterRadial", radials_);
        out_.bytes += "DataBegin\n";
    }

    void append(const SphericalBlock& block) {
        const Channel& channel = table_.channels[block.channel];
        out_.bytes += "AOI  " + shortest(roundedDegrees(block.incidenceDeg)) + "\nPOI  " +
                      shortest(roundedDegrees(block.lightAzimuthDeg)) + "\nSide  " +
                      (about_.at(kLightToolsSide) == "back" ? "Back" : "Front") + "\nWavelength  " +
                      shortest(channel.nanometres.value_or(0)) + "\nScatterType  " +
                      (block.transmission ? "BTDF" : "BRDF") + "\n";
        if (xyz_) {
            out_.bytes +=
                "TristimulusValue  Tris" + std::string(kXyz[*tristimulus(channel)]) + "\n";
        }
        double tis = std::isfinite(block.tis) ? block.tis : blockIntegral(table_, block);
        if (!std::isfinite(tis)) {
            tis = 0;
            ++noTis_;
        }
        out_.bytes += "TIS  " + shortest(tis) + "\n";
        values(block);
    }

    void values(const SphericalBlock& block) {
        const std::size_t count = block.thetaDeg.size();
        for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
            for (std::size_t r = 0; r < count; ++r) {
                const std::size_t t = block.transmission ? count - 1 - r : r;
                double f = block.f[block.index(a, t)];
                if (!std::isfinite(f)) {
                    f = 0;
                    ++masked_;
                }
                out_.bytes += shortest(f);
                out_.bytes += r + 1 < count ? '\t' : '\n';
            }
        }
    }

    SphericalTable table_;
    const Metadata& about_;
    bool xyz_ = false;
    std::vector<const SphericalBlock*> blocks_;
    std::vector<double> azimuths_, radials_;
    std::size_t masked_ = 0, noTis_ = 0;
    Written out_;
};

}  // namespace

Written writeLightTools(const SphericalTable& table, const Metadata& about) {
    return Writer(table, about).write();
}

}  // namespace gonio::proc
