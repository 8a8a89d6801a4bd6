#include "daemon/channel_merging.h"

#include <algorithm>
#include <cmath>

#include "daemon/merge_checks.h"
#include "daemon/merge_verdicts.h"
#include "proc/core/number_text.h"
#include "proc/table/achieved.h"
#include "proc/table/merged_info.h"

namespace gonio::daemon {
namespace {

/// R, G, B of three inputs; a Usage error where they are not that.
Result<std::array<const MergeInput*, 3>> bandsOf(const std::vector<MergeInput>& inputs) {
    std::array<const MergeInput*, 3> bands{};
    if (inputs.size() != 3) {
        return mergeError("three files of one band each make one of three; here are " +
                          std::to_string(inputs.size()));
    }
    for (const MergeInput& input : inputs) {
        if (!input.band) return mergeError(quoted(input) + ": it holds more than one band");
        const MergeInput*& place = bands[index(*input.band)];
        if (place != nullptr) {
            return mergeError(quoted(*place) + " and " + quoted(input) + " are both of band " +
                              std::string(letter(*input.band)) +
                              "; one of each of r, g, b is wanted");
        }
        place = &input;
    }
    return bands;
}

Result<Merged> mergedScattered(const std::array<const MergeInput*, 3>& bands,
                               const MergeOptions& options) {
    if (options.plane || options.isotropic || options.reciprocal) {
        return mergeError("--plane, --isotropic and --reciprocal are for .gonio files");
    }
    std::array<const proc::ScatteredSet*, 3> sets{};
    for (std::size_t b = 0; b < 3; ++b) {
        if (bands[b]->sample) {
            return mergeError(quoted(*bands[b]) +
                              " is a .gonio, another is not: merge three .gonio, or convert it to "
                              "Zemax first");
        }
        sets[b] = &*bands[b]->values;
    }
    auto result = proc::mergedChannels(sets);
    if (!result) return result.error().in("merge");
    Merged merged{.how = "channels", .rows = std::move(result->rows)};
    merged.channels = result->counts;
    return merged;
}

/// Of samples: the cells of one file, whatever averages are asked for follow.
std::vector<MergeInput> mergedSamples(std::span<const MergeInput> inputs,
                                      const std::array<const MergeInput*, 3>& bands,
                                      Merged& into) {
    std::array<const proc::SampleSet*, 3> sets{};
    std::vector<proc::SampleInfo> infos;
    std::vector<proc::SampleSet> all;
    for (std::size_t b = 0; b < 3; ++b) {
        sets[b] = &*bands[b]->sample;
        infos.push_back(sets[b]->info);
        all.push_back({.info = sets[b]->info, .leds = sets[b]->leds});
    }
    proc::MergedSample made = proc::mergedChannels(sets);
    into.channels = made.counts;
    made.set.info = proc::mergedInfo(infos, "channels");
    made.set.info.budgetJson = proc::budgetOfChannels(made.set, all);
    const std::string averages = averagesOf(inputs);
    if (!averages.empty()) made.set.info.extra["averaged"] = averages;
    std::vector<MergeInput> one;
    one.push_back({.file = bands[0]->file, .sample = std::move(made.set)});
    return one;
}

}  // namespace

Result<Merged> mergedBands(const std::vector<MergeInput>& inputs, const MergeOptions& options) {
    const auto bands = bandsOf(inputs);
    if (!bands) return bands.error();
    const bool scattered = std::any_of(inputs.begin(), inputs.end(), [](const MergeInput& one) {
        return !one.sample.has_value();
    });
    if (scattered) return mergedScattered(*bands, options);
    if (Result<void> good = checkOrigins(inputs, options); !good) return good.error();
    if (Result<void> good = checkAverages(inputs, options); !good) return good.error();
    Merged whole{.how = "channels"};
    std::vector<MergeInput> one = mergedSamples(inputs, *bands, whole);
    if (options.plane || options.isotropic || options.reciprocal) {
        Result<Merged> averaged = mergedAlike(one, options, inputs);
        if (!averaged) return averaged;
        averaged->how = whole.how;
        averaged->channels = whole.channels;
        return averaged;
    }
    whole.sample = std::move(*one.front().sample);
    whole.sample.info.achievedUncertainty = proc::achievedUncertainty(whole.sample);
    judge(whole, inputs, {}, options.limits);
    return whole;
}

std::string channelCsv(const std::vector<proc::ChannelRow>& rows) {
    const bool withU = std::any_of(rows.begin(), rows.end(), [](const proc::ChannelRow& row) {
        return std::any_of(row.u.begin(), row.u.end(), [](double u) { return std::isfinite(u); });
    });
    const auto orEmpty = [](double value) {
        return "," + (std::isfinite(value) ? shortest(value) : std::string());
    };
    std::string text = "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b";
    text += withU ? ",u_r,u_g,u_b,flags_r,flags_g,flags_b\n" : ",flags_r,flags_g,flags_b\n";
    for (const proc::ChannelRow& row : rows) {
        text += degrees(row.pair.in.theta()) + "," + degrees(row.pair.in.phi()) + "," +
                degrees(row.pair.out.theta()) + "," + degrees(row.pair.out.phi());
        for (const double f : row.f) text += orEmpty(f);
        if (withU) {
            for (const double u : row.u) text += orEmpty(u);
        }
        for (const Flags flags : row.flags) text += "," + std::to_string(flags.mask());
        text += "\n";
    }
    return text;
}

}  // namespace gonio::daemon
