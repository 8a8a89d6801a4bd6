#include "proc/export/one_channel.h"

#include <algorithm>

#include "proc/core/number_text.h"
#include "proc/formats/named_band.h"

namespace gonio::proc {
namespace {

void keep(SphericalTable& table, std::size_t channel, const Channel& as) {
    std::erase_if(table.blocks,
                  [&](const SphericalBlock& block) { return block.channel != channel; });
    for (SphericalBlock& block : table.blocks) block.channel = 0;
    table.channels = {as};
}

void keep(SpecularTable& table, std::size_t channel, const Channel& /*as*/) {
    table.planes = {std::move(table.planes[channel])};
    table.colour = TableColour::Monochrome;
}

/// Every `count`-th of what stands channel by channel.
template <class Value>
void keepColumn(std::vector<Value>& values, std::size_t channel, std::size_t count) {
    for (std::size_t i = 0; i < values.size() / count; ++i) {
        values[i] = values[i * count + channel];
    }
    values.resize(values.size() / count);
}

void keep(BrdfRows& rows, std::size_t channel, const Channel& as) {
    const std::size_t count = rows.channels.size();
    keepColumn(rows.f, channel, count);
    keepColumn(rows.uRandom, channel, count);
    keepColumn(rows.uSystematic, channel, count);
    keepColumn(rows.flags, channel, count);
    rows.channels = {as};
}

void keep(TensorTable& table, std::size_t channel, const Channel& as) {
    const std::size_t each = table.values.width * table.values.height;
    const std::size_t count = table.channels.size();
    std::vector<float> kept;
    for (std::size_t slice = channel; slice < table.values.slices(); slice += count) {
        const auto from = table.values.values.begin() + static_cast<std::ptrdiff_t>(slice * each);
        kept.insert(kept.end(), from, from + static_cast<std::ptrdiff_t>(each));
    }
    table.values.values = std::move(kept);
    table.channels = {as};
}

/// Of samples, MERL's tables and matrices, whose channels are not taken apart here.
template <class Other>
void keep(Other& /*content*/, std::size_t /*channel*/, const Channel& /*as*/) {}

bool hasBands(const BrdfFile& file) {
    const auto* specular = file.as<SpecularTable>();
    return file.as<SampleSet>() != nullptr || file.as<HalfDifferenceTable>() != nullptr ||
           (specular != nullptr && specular->colour == TableColour::LedBands);
}

std::string described(const Channel& channel, std::size_t number) {
    if (!channel.name.empty()) return std::to_string(number) + ": " + channel.name;
    if (channel.nanometres)
        return std::to_string(number) + ": " + shortest(*channel.nanometres) + " nm";
    return std::to_string(number);
}

}  // namespace

Result<BrdfFile> withChannelAlone(BrdfFile file, std::size_t number) {
    const std::vector<Channel> channels = channelsOf(file);
    if (number < 1 || number > channels.size()) {
        return Error{ErrorKind::Usage,
                     "--bands " + std::to_string(number) + ": the file has " +
                         std::to_string(channels.size()) +
                         (channels.size() == 1 ? " channel" : " channels")};
    }
    if (channels.size() == 1) return file;
    Channel channel = channels[number - 1];
    file.band = bandOfChannel(channel);
    if (hasBands(file)) {
        file.bands = {*file.band};
        file.band.reset();
        return file;
    }
    file.about.set("channel", described(channel, number));
    if (!file.band || channel.name != Channel::of(*file.band).name) channel.name.clear();
    std::visit([&](auto& content) { keep(content, number - 1, channel); }, file.content);
    return file;
}

}  // namespace gonio::proc
