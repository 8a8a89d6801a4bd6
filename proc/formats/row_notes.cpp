#include "proc/formats/row_notes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "proc/core/number_text.h"
#include "proc/formats/text_lines.h"

namespace gonio::proc {
namespace {

constexpr std::string_view kSymmetry = "symmetry";

/// Empty unless each channel has one.
std::string wavelengthsOf(const std::vector<Channel>& channels) {
    std::string list;
    for (const Channel& channel : channels) {
        if (!channel.nanometres) return "";
        list += (list.empty() ? "" : " ") + shortest(*channel.nanometres);
    }
    return list;
}

bool setWavelengths(std::string_view list, std::vector<Channel>& channels) {
    const std::vector<std::string_view> words = wordsIn(list);
    if (words.size() != channels.size()) return false;
    std::vector<double> nm;
    for (const std::string_view word : words) {
        const auto one = parseDouble(word);
        if (!one) return false;
        nm.push_back(*one);
    }
    for (std::size_t i = 0; i < nm.size(); ++i) channels[i].nanometres = nm[i];
    return true;
}

}  // namespace

Metadata withRowNotes(Metadata about, const BrdfRows& rows, bool namesHideWavelengths) {
    if (rows.isotropic != lightsAtOneAzimuth(rows.pairs)) {
        about.values.insert_or_assign(std::string(kSymmetry),
                                      rows.isotropic ? "isotropic" : "none");
    }
    if (namesHideWavelengths) about.set(key::kWavelengths, wavelengthsOf(rows.channels));
    return about;
}

void takeRowNotes(Metadata& about, BrdfRows& rows) {
    const auto symmetry = about.values.find(kSymmetry);
    if (symmetry == about.values.end()) {
        rows.isotropic = lightsAtOneAzimuth(rows.pairs);
    } else {
        rows.isotropic = symmetry->second == "isotropic";
        about.values.erase(symmetry);
    }
    const auto wavelengths = about.values.find(key::kWavelengths);
    if (wavelengths != about.values.end() && setWavelengths(wavelengths->second, rows.channels)) {
        about.values.erase(wavelengths);
    }
}

void countDroppedColumns(const BrdfRows& rows, LossReport& loss) {
    const auto known = std::count_if(
        rows.uRandom.begin(), rows.uRandom.end(), [](double u) { return std::isfinite(u); });
    loss.add(Loss::Dropped, "uncertainties", static_cast<std::size_t>(known));
    const auto more = std::count_if(rows.flags.begin(), rows.flags.end(), [](Flags flags) {
        return flags != Flags{} && flags != Flags{Flag::Measured};
    });
    loss.add(Loss::Dropped, "flags beside measured", static_cast<std::size_t>(more));
}

Error noWholeRow(std::string_view format) {
    return Error{ErrorKind::Usage,
                 std::string(format) + ": no direction has a value in every channel"};
}

std::vector<std::string> negativeValues(const BrdfRows& rows) {
    const auto count = std::count_if(rows.f.begin(), rows.f.end(), [](double f) { return f < 0; });
    if (count == 0) return {};
    return {std::to_string(count) + " negative values"};
}

}  // namespace gonio::proc
