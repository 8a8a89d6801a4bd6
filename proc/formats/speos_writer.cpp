#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "proc/core/number_text.h"
#include "proc/formats/file_degrees.h"
#include "proc/formats/speos.h"
#include "proc/formats/speos_values.h"
#include "proc/table/block_integral.h"
#include "proc/table/spherical_turn.h"

namespace gonio::proc {
namespace {

/// What a table without a wavelength is said to be measured at: the converters' own ends.
constexpr std::array<double, 2> kAnyWavelength{350, 850};
constexpr double kUnknownNm = 550;

/// Per cent in digits that read back to the same ones through a fraction.
double perCentOf(double fraction) { return std::round(fraction * 1e12) / 1e10; }

double anisotropyAngle(const SphericalBlock& block) {
    const double angle = roundedDegrees(360 - block.lightAzimuthDeg);
    return angle >= 360 ? 0 : angle;
}

bool hasTristimulus(const SphericalTable& table) {
    return std::any_of(table.channels.begin(), table.channels.end(), [](const Channel& channel) {
        return channel.name == "X" || channel.name == "Y" || channel.name == "Z";
    });
}

/// The blocks of one side of the surface, in the order of a `.brdf`.
using Blocks = std::vector<const SphericalBlock*>;
/// By anisotropy angle, then incidence.
using Fans = std::map<double, std::map<double, const SphericalBlock*>>;

struct SpectrumRow {
    double nanometres = 0, percent = 0;
};

class Writer {
public:
    Writer(const SphericalTable& table, const Metadata& about)
        : table_(wholeCircle(withMirrorAt(table, kSpeosTextMirrorDeg))), about_(about) {}

    Result<Written> brdf();
    Result<Written> anisotropic();

private:
    [[nodiscard]] std::optional<Error> unfit() const {
        if (hasTristimulus(table_)) {
            return Error{ErrorKind::Usage, "speos: X, Y, Z have no wavelength: convert them first"};
        }
        if (table_.blocks.empty()) return Error{ErrorKind::Usage, "speos: table has no blocks"};
        return std::nullopt;
    }

    void title(std::string_view kind) {
        std::string description;
        Metadata described = about_;
        described.values.erase(std::string(kSpeosSpectrum));
        for (const std::string& line : metadataLines(described)) {
            description += (description.empty() ? "" : "\n") + line;
        }
        out_.bytes = "OPTIS - " + std::string(kind) + " surface file v8.0\n0\n" +
                     std::string(kSpeosOwnComment) + "\n" + std::to_string(description.size()) +
                     "\n" + description + "\n";
    }
    void list(const std::vector<double>& numbers) {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            out_.bytes += (i > 0 ? "\t" : "") + shortest(numbers[i]);
        }
        out_.bytes += "\n";
    }
    void flags(bool reflection, bool transmission) {
        out_.bytes += reflection ? "1\t" : "0\t";
        out_.bytes += transmission ? "1\n1\n" : "0\n1\n";
    }

    /// Per cent, as the source says: readers scale the values by it. Else what they add up to;
    /// empty where neither tells.
    [[nodiscard]] std::optional<double> total(const SphericalBlock& block) const {
        double percent = perCentOf(block.tis);
        if (!std::isfinite(percent)) percent = perCentOf(blockIntegral(table_, block));
        if (!std::isfinite(percent)) return std::nullopt;
        return std::max(percent, 0.0);
    }
    [[nodiscard]] double orNone(std::optional<double> percent) {
        noTotal_ += percent ? 0U : 1U;
        return percent.value_or(0);
    }

    void values(const SphericalBlock& block) {
        out_.bytes += std::to_string(block.thetaDeg.size()) + "\t" +
                      std::to_string(block.azimuthDeg.size()) + "\n";
        for (const double azimuth : block.azimuthDeg) out_.bytes += "\t" + shortest(azimuth);
        out_.bytes += "\n";
        for (std::size_t t = 0; t < block.thetaDeg.size(); ++t) {
            out_.bytes += shortest(block.thetaDeg[t]);
            for (std::size_t a = 0; a < block.azimuthDeg.size(); ++a) {
                const double f = block.f[block.index(a, t)];
                masked_ += std::isfinite(f) ? 0U : 1U;
                out_.bytes += "\t" + (std::isfinite(f) ? shortest(f) : "0");
            }
            out_.bytes += "\n";
        }
    }

    Written done() {
        out_.loss.add(Loss::Masked, "nodes without data, written as 0", masked_);
        out_.loss.add(Loss::Dropped, "totals that are not known, written as 0", noTotal_);
        return std::move(out_);
    }

    [[nodiscard]] std::vector<std::size_t> channelsByWavelength();
    [[nodiscard]] Blocks ofBrdf(const std::vector<std::size_t>& channels,
                                bool transmission,
                                std::set<double>& incidences);
    [[nodiscard]] std::vector<SpectrumRow> spectrumAsRead() const;
    [[nodiscard]] std::vector<SpectrumRow> spectrumOf(const std::vector<Fans>& sides);
    void turns(const Fans& fans);

    SphericalTable table_;
    Metadata about_;
    Written out_;
    std::size_t masked_ = 0, noTotal_ = 0;
};

std::vector<std::size_t> Writer::channelsByWavelength() {
    if (table_.channels.size() == 1 && !table_.channels[0].nanometres) {
        table_.channels[0].nanometres = kUnknownNm;
        out_.loss.add(Loss::Dropped, "wavelength that is not known, written as 550 nm", 1);
    }
    std::map<double, std::size_t> byWavelength;
    for (std::size_t i = 0; i < table_.channels.size(); ++i) {
        if (const auto nm = table_.channels[i].nanometres) byWavelength.emplace(*nm, i);
    }
    out_.loss.add(Loss::Dropped,
                  "channels without a wavelength of their own",
                  table_.channels.size() - byWavelength.size());
    std::vector<std::size_t> channels;
    for (const auto& [nm, channel] : byWavelength) channels.push_back(channel);
    return channels;
}

/// Incidence > wavelength; incidences that not every wavelength has are taken out of the set.
Blocks Writer::ofBrdf(const std::vector<std::size_t>& channels,
                      bool transmission,
                      std::set<double>& incidences) {
    std::map<std::pair<double, std::size_t>, const SphericalBlock*> found;
    const double light = table_.blocks.front().lightAzimuthDeg;
    for (const SphericalBlock& block : table_.blocks) {
        if (block.transmission != transmission || block.lightAzimuthDeg != light) continue;
        found.emplace(std::pair(block.incidenceDeg, block.channel), &block);
    }
    if (found.empty()) return {};
    std::erase_if(incidences, [&](double incidence) {
        return std::any_of(channels.begin(), channels.end(), [&](std::size_t channel) {
            return !found.contains({incidence, channel});
        });
    });
    Blocks blocks;
    for (const double incidence : incidences) {
        for (const std::size_t channel : channels) blocks.push_back(found[{incidence, channel}]);
    }
    return blocks;
}

Result<Written> Writer::brdf() {
    if (const auto error = unfit()) return *error;
    const std::vector<std::size_t> channels = channelsByWavelength();
    std::set<double> incidences;
    for (const SphericalBlock& block : table_.blocks) incidences.insert(block.incidenceDeg);
    std::array<Blocks, 2> sides;
    for (int pass = 0; pass < 2; ++pass) {  // twice: each side takes incidences from the other
        sides = {ofBrdf(channels, false, incidences), ofBrdf(channels, true, incidences)};
    }
    if (incidences.size() < 2 || channels.empty()) {
        return Error{ErrorKind::Usage,
                     "speos: " + std::to_string(incidences.size()) +
                         " incidences that all wavelengths have, wanted two or more"};
    }
    const std::size_t written = sides[0].size() + sides[1].size();
    title("brdf");
    flags(!sides[0].empty(), !sides[1].empty());
    out_.bytes += std::to_string(incidences.size()) + "\t" + std::to_string(channels.size()) + "\n";
    list({incidences.begin(), incidences.end()});
    std::vector<double> nanometres;
    for (const std::size_t channel : channels) {
        nanometres.push_back(*table_.channels[channel].nanometres);
    }
    list(nanometres);
    for (const Blocks& side : sides) {
        for (const SphericalBlock* block : side) {
            out_.bytes += shortest(orNone(total(*block))) + "\n";
            values(*block);
        }
    }
    out_.loss.add(Loss::Dropped,
                  "blocks of other light azimuths, channels or incidences than a file holds",
                  table_.blocks.size() - written);
    return done();
}

/// The rows that were read; empty where there are none.
std::vector<SpectrumRow> Writer::spectrumAsRead() const {
    std::vector<SpectrumRow> rows;
    std::string_view text = about_.at(kSpeosSpectrum);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(", "), text.size());
        const std::string_view row = text.substr(0, end);
        const std::size_t space = std::min(row.find(' '), row.size());
        const auto nm = parseDouble(row.substr(0, space));
        const auto percent = parseDouble(row.substr(std::min(space + 1, row.size())));
        if (!nm || !percent) return {};
        rows.push_back({*nm, *percent});
        text.remove_prefix(std::min(end + 2, text.size()));
    }
    return rows;
}

/// The totals of each wavelength at the first block of each side.
std::vector<SpectrumRow> Writer::spectrumOf(const std::vector<Fans>& sides) {
    std::set<double> nanometres;
    for (const Channel& channel : table_.channels) {
        if (channel.nanometres) nanometres.insert(*channel.nanometres);
    }
    const bool known = !nanometres.empty();
    if (!known) nanometres = {kAnyWavelength.begin(), kAnyWavelength.end()};
    const std::vector<SpectrumRow> read = spectrumAsRead();
    std::vector<SpectrumRow> rows;
    for (const Fans& fans : sides) {
        const SphericalBlock& first = *fans.begin()->second.begin()->second;
        std::map<double, const SphericalBlock*> there;
        for (const SphericalBlock& block : table_.blocks) {
            const auto nm = table_.channels[block.channel].nanometres;
            if (nm && block.transmission == first.transmission &&
                block.incidenceDeg == first.incidenceDeg &&
                block.lightAzimuthDeg == first.lightAzimuthDeg) {
                there.emplace(*nm, &block);
            }
        }
        for (const double nm : nanometres) {
            const auto found = there.find(nm);
            const SphericalBlock* block = !known                 ? &first
                                          : found == there.end() ? nullptr
                                                                 : found->second;
            auto percent = block == nullptr ? std::nullopt : total(*block);
            const std::size_t i = rows.size();
            if (!percent && i < read.size() && read[i].nanometres == nm) percent = read[i].percent;
            rows.push_back({nm, orNone(percent)});
        }
    }
    return rows;
}

void Writer::turns(const Fans& fans) {
    std::vector<double> angles;
    for (const auto& [angle, fan] : fans) angles.push_back(angle);
    out_.bytes += std::to_string(angles.size()) + "\n";
    list(angles);
    for (const auto& [angle, fan] : fans) {
        std::vector<double> incidences;
        for (const auto& [incidence, block] : fan) incidences.push_back(incidence);
        out_.bytes += std::to_string(incidences.size()) + "\n";
        list(incidences);
    }
}

Result<Written> Writer::anisotropic() {
    if (const auto error = unfit()) return *error;
    std::array<Fans, 2> byKind;
    std::size_t others = 0;
    for (const SphericalBlock& block : table_.blocks) {
        const bool first = block.channel == table_.blocks.front().channel;
        others += first ? 0U : 1U;
        if (!first) continue;
        byKind[block.transmission ? 1 : 0][anisotropyAngle(block)][block.incidenceDeg] = &block;
    }
    std::vector<Fans> sides;
    for (const Fans& fans : byKind) {
        if (!fans.empty()) sides.push_back(fans);
    }
    title("Anisotropic BSDF");
    out_.bytes += "0\t1\t0\n";
    flags(!byKind[0].empty(), !byKind[1].empty());
    for (const Fans& fans : sides) turns(fans);
    list({sides.front().begin()->second.begin()->first, 0});
    out_.bytes += "\n";
    const bool oneShape = table_.channels.size() == 1 && !table_.channels[0].nanometres;
    auto rows = oneShape ? spectrumAsRead() : std::vector<SpectrumRow>{};
    if (rows.empty() || rows.size() % sides.size() != 0) rows = spectrumOf(sides);
    out_.bytes += std::to_string(rows.size() / sides.size()) + "\n";
    for (const SpectrumRow& row : rows) list({row.nanometres, row.percent});
    for (const Fans& fans : sides) {
        for (const auto& [angle, fan] : fans) {
            for (const auto& [incidence, block] : fan) values(*block);
        }
    }
    out_.loss.add(Loss::Dropped, "blocks of channels beyond the first", others);
    return done();
}

}  // namespace

Result<Written> writeSpeosBrdf(const SphericalTable& table, const Metadata& about) {
    return Writer(table, about).brdf();
}

Result<Written> writeSpeosAnisotropic(const SphericalTable& table, const Metadata& about) {
    return Writer(table, about).anisotropic();
}

}  // namespace gonio::proc
