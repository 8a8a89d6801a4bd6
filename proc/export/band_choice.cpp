#include "proc/export/band_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "proc/core/colour.h"
#include "proc/core/number_text.h"
#include "proc/export/band_rows.h"
#include "proc/export/one_channel.h"
#include "proc/table/band_channels.h"

namespace gonio::proc {
namespace {

Error wanted(std::string_view text) {
    return {ErrorKind::Usage,
            "--bands '" + std::string(text) +
                "': wanted some of r,g,b with commas, the number of a channel (2, or g=2 where "
                "it is green), or srgb for a file of X, Y, Z"};
}

bool isXyz(const std::vector<Channel>& channels) {
    return channels.size() == 3 && channels[0].name == "X" && channels[1].name == "Y" &&
           channels[2].name == "Z";
}

/// X, Y, Z of each value in place; NaN stays NaN.
template <class At>
void convertAt(std::size_t count, const At& at) {
    for (std::size_t i = 0; i < count; ++i) {
        const LinearSrgb rgb = toLinearSrgb({{at(i, 0), at(i, 1), at(i, 2)}});
        for (std::size_t c = 0; c < 3; ++c) at(i, c) = rgb.value[c];
    }
}

constexpr const char* kNote = "linear sRGB from CIE XYZ (D65, no adaptation)";

std::vector<Channel> srgbChannels() { return {{"R", {}}, {"G", {}}, {"B", {}}}; }

Result<void> toSrgb(BrdfRows& rows) {
    convertAt(rows.pairs.size(),
              [&](std::size_t i, std::size_t c) -> double& { return rows.f[3 * i + c]; });
    rows.uRandom.clear();
    rows.uSystematic.clear();
    rows.channels = srgbChannels();
    return {};
}

Result<void> toSrgb(SpecularTable& table) {
    const auto has = [&](std::size_t i) {
        return std::any_of(table.planes.begin(), table.planes.end(), [&](const TablePlane& plane) {
            return plane.f[i] != 0 && !std::isnan(plane.f[i]);
        });
    };
    std::vector<bool> data(table.nodeCount());
    for (std::size_t i = 0; i < data.size(); ++i) data[i] = has(i);
    convertAt(data.size(),
              [&](std::size_t i, std::size_t c) -> double& { return table.planes[c].f[i]; });
    for (std::size_t i = 0; i < data.size(); ++i) {
        if (data[i]) continue;
        for (TablePlane& plane : table.planes) {
            plane.f[i] = std::numeric_limits<double>::quiet_NaN();
        }
    }
    convertAt(table.planes[0].tis.size(),
              [&](std::size_t i, std::size_t c) -> double& { return table.planes[c].tis[i]; });
    table.colour = TableColour::LedBands;
    return {};
}

Result<void> toSrgb(SphericalTable& table) {
    const std::size_t lights = table.blocks.size() / 3;
    std::vector<std::array<SphericalBlock*, 3>> triples(lights);
    for (std::size_t c = 0; c < 3; ++c) {
        std::size_t light = 0;
        for (SphericalBlock& block : table.blocks) {
            if (block.channel == c && light < lights) triples[light++][c] = &block;
        }
        if (light != lights) return Error{ErrorKind::File, "X, Y and Z are not of the same lights"};
    }
    for (auto& triple : triples) {
        for (const SphericalBlock* one : triple) {
            if (one->f.size() != triple[0]->f.size() ||
                one->incidenceDeg != triple[0]->incidenceDeg ||
                one->transmission != triple[0]->transmission) {
                return Error{ErrorKind::File, "X, Y and Z are not of the same directions"};
            }
        }
        convertAt(triple[0]->f.size(),
                  [&](std::size_t i, std::size_t c) -> double& { return triple[c]->f[i]; });
        convertAt(1, [&](std::size_t, std::size_t c) -> double& { return triple[c]->tis; });
    }
    table.channels = srgbChannels();
    return {};
}

template <class Other>
Result<void> toSrgb(Other& /*table*/) {
    return Error{ErrorKind::Usage, "--bands srgb is for a file of X, Y, Z"};
}

bool wants(const std::vector<Band>& bands, Band band) {
    return std::find(bands.begin(), bands.end(), band) != bands.end();
}

void keepOnly(SampleSet& set, const std::vector<Band>& bands) {
    for (LedTable& led : set.leds) {
        for (const Band band : kBands) {
            if (!wants(bands, band)) led.bands[index(band)] = {};
        }
    }
}

bool hasBand(const SampleSet& set, Band band) {
    return std::any_of(set.leds.begin(), set.leds.end(), [&](const LedTable& led) {
        return led.bands[index(band)].size() > 0;
    });
}

/// Where every channel is named as a band: these.
std::vector<Band> namedBands(const std::vector<Channel>& channels) {
    std::vector<Band> bands;
    for (const Band band : kBands) {
        const bool there =
            std::any_of(channels.begin(), channels.end(), [&](const Channel& channel) {
                return channel.name == Channel::of(band).name;
            });
        if (there) bands.push_back(band);
    }
    return bands.size() == channels.size() ? bands : std::vector<Band>{};
}

}  // namespace

Result<BandChoice> parseBandChoice(std::string_view text) {
    BandChoice choice;
    if (text == "srgb") {
        choice.srgb = true;
        return choice;
    }
    if (const auto number = parseInteger(text.substr(text.find('=') + 1))) {
        if (*number < 1) return wanted(text);
        choice.channel = static_cast<std::size_t>(*number);
        if (text.find('=') == std::string_view::npos) return choice;
        text = text.substr(0, text.find('='));
        if (text.size() != 1) return wanted(text);
    }
    for (std::size_t i = 0; i < text.size(); i += 2) {
        const auto band = std::find_if(
            kBands.begin(), kBands.end(), [&](Band b) { return letter(b)[0] == text[i]; });
        const bool comma = i + 1 == text.size() || text[i + 1] == ',';
        if (band == kBands.end() || !comma || wants(choice.bands, *band)) return wanted(text);
        choice.bands.push_back(*band);
    }
    if (text.empty() || text.back() == ',') return wanted(text);
    std::sort(choice.bands.begin(), choice.bands.end());
    return choice;
}

Result<BrdfFile> chosen(BrdfFile file, const BandChoice& choice) {
    if (choice.srgb) {
        if (!isXyz(channelsOf(file))) {
            return Error{ErrorKind::Usage, "--bands srgb is for a file of X, Y, Z"};
        }
        auto done = std::visit([](auto& content) { return toSrgb(content); }, file.content);
        if (!done) return done.error();
        file.about.set("colour", kNote);
        return file;
    }
    if (choice.channel) {
        auto one = withChannelAlone(std::move(file), *choice.channel);
        if (!one) return one;
        const std::vector<Band> own = std::exchange(one->bands, {});
        if (!own.empty() && !choice.bands.empty() && own != choice.bands) {
            return Error{ErrorKind::Usage,
                         "--bands: channel " + std::to_string(*choice.channel) +
                             " of the file is " + Channel::of(own.front()).name};
        }
        return chosen(std::move(*one), {.bands = own.empty() ? choice.bands : own});
    }
    if (choice.bands.empty()) return file;
    if (channelsOf(file).size() == 1 && file.as<SampleSet>() == nullptr) {
        if (choice.bands.size() > 1) {
            return Error{ErrorKind::Usage,
                         "the file has one value: say --bands with one of r, g, b"};
        }
        file.band = choice.bands.front();
        return file;
    }
    if (auto* sample = std::get_if<SampleSet>(&file.content)) keepOnly(*sample, choice.bands);
    if (auto* rows = std::get_if<BrdfRows>(&file.content)) {
        Result<BrdfRows> kept = onlyBands(*rows, choice.bands);
        if (!kept) return kept.error();
        *rows = std::move(*kept);
        if (choice.bands.size() == 1) file.band = choice.bands.front();
    }
    file.bands = choice.bands;
    const auto left = bandsOf(file);
    if (!left) return left.error();
    if (left->size() != choice.bands.size()) {
        return Error{ErrorKind::Usage, "the file does not have all bands that --bands names"};
    }
    return file;
}

Result<std::vector<Band>> bandsOf(const BrdfFile& file) {
    std::vector<Band> bands;
    const auto* sample = file.as<SampleSet>();
    if (sample == nullptr) {
        const std::vector<Channel> channels = channelsOf(file);
        if (std::vector<Band> some = namedBands(channels); some.size() == 2) return some;
        const auto found = bandChannels(channels);
        if (!found) return found.error();
        if (found->count == BandCount::One) {
            if (file.band) bands.push_back(*file.band);
            return bands;
        }
    }
    for (const Band band : kBands) {
        const bool there = sample == nullptr || hasBand(*sample, band);
        if (there && (file.bands.empty() || wants(file.bands, band))) bands.push_back(band);
    }
    return bands;
}

}  // namespace gonio::proc
