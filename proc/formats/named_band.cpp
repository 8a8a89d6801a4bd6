#include "proc/formats/named_band.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "proc/core/number_text.h"
#include "proc/table/band_channels.h"

namespace gonio::proc {
namespace {

/// The number behind the word.
std::optional<double> behind(std::string_view word, const std::string& comment) {
    const std::size_t at = comment.find(word);
    if (at == std::string::npos) return std::nullopt;
    std::string number = comment.substr(at + word.size());
    std::erase_if(number, [](char c) { return std::isspace(static_cast<unsigned char>(c)); });
    return parseDouble(number);
}

/// The number before the only " nm" of a line on the light source.
std::optional<double> ofSource(const std::string& comment) {
    const std::size_t end = comment.find(" nm");
    if (comment.find("ight source") == std::string::npos || end == std::string::npos) {
        return std::nullopt;
    }
    const std::size_t begin = comment.find_last_not_of("0123456789.", end - 1) + 1;
    return parseDouble(std::string_view(comment).substr(begin, end - begin));
}

}  // namespace

std::optional<Band> bandOfName(const std::filesystem::path& file) {
    std::optional<Band> band;
    std::string word;
    for (const char c : file.stem().string() + " ") {
        if (std::isalpha(static_cast<unsigned char>(c))) {
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
            continue;
        }
        if (word == "r" || word == "red") band = Band::R;
        if (word == "g" || word == "green") band = Band::G;
        if (word == "b" || word == "blue") band = Band::B;
        word.clear();
    }
    return band;
}

std::optional<Band> bandOfWavelength(double nm) {
    for (const Band band : kBands) {
        if (std::abs(nm - nanometres(band)) <= kBandReachNm) return band;
    }
    return std::nullopt;
}

std::optional<Band> bandOfChannel(const Channel& channel) {
    for (const Band band : kBands) {
        if (channel.name == Channel::of(band).name) return band;
    }
    if (!channel.nanometres) return std::nullopt;
    return bandOfWavelength(*channel.nanometres);
}

std::optional<double> wavelengthIn(std::span<const std::string> comments) {
    for (const std::string& comment : comments) {
        if (const auto nm = behind("Wavelength (nm) =", comment)) return nm;
    }
    for (const std::string& comment : comments) {
        if (const auto nm = ofSource(comment)) return nm;
    }
    return std::nullopt;
}

}  // namespace gonio::proc
