#include "daemon/merge_inputs.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "daemon/material.h"
#include "proc/core/log.h"
#include "proc/core/number_text.h"
#include "proc/formats/flag_column.h"
#include "proc/formats/named_band.h"
#include "proc/formats/points_csv.h"
#include "proc/table/band_channels.h"
#include "proc/table/scattered_of.h"

namespace gonio::daemon {
namespace {

namespace fs = std::filesystem;

Error usage(const std::string& file, const std::string& what) {
    return {ErrorKind::Usage, "merge: '" + file + "': " + what};
}

/// The only band that any LED has; empty where there are several.
std::optional<Band> onlyBand(const proc::SampleSet& set) {
    std::optional<Band> only;
    for (const proc::LedTable& led : set.leds) {
        for (const Band band : kBands) {
            if (led.bands[index(band)].size() == 0) continue;
            if (only && *only != band) return std::nullopt;
            only = band;
        }
    }
    return only;
}

Result<Band> bandOf(const std::string& file, const std::vector<std::string>& comments) {
    const std::optional<Band> named = proc::bandOfName(file);
    const std::optional<double> nm = proc::wavelengthIn(comments);
    if (!nm && named) return *named;
    if (!nm) {
        return usage(file,
                     "of which band is it? put R, G or B into its name, as in NAME_R.bsdf, or the "
                     "comment # Wavelength (nm) = 630 into it");
    }
    const std::optional<Band> told = proc::bandOfWavelength(*nm);
    if (!told) {
        return usage(file,
                     "its wavelength is " + shortest(*nm) +
                         " nm; wanted one of the LEDs', 630, 525 or 465 nm, to " +
                         shortest(proc::kBandReachNm) + " nm");
    }
    if (named && *named != *told) {
        return usage(file,
                     "its name says band " + std::string(letter(*named)) + ", its wavelength of " +
                         shortest(*nm) + " nm says " + std::string(letter(*told)) + "; rename it");
    }
    return *told;
}

/// A column where there is one.
Result<std::vector<double>> columnOr(const proc::Points& points, const std::string& name) {
    const auto& all = points.columns;
    if (std::find(all.begin(), all.end(), name) == all.end()) return std::vector<double>{};
    return proc::numbersOf(points, name);
}

Result<proc::ScatteredSet> valuesOf(const std::string& file, const proc::Points& points) {
    const auto has = [&](const char* name) {
        return std::find(points.columns.begin(), points.columns.end(), name) !=
               points.columns.end();
    };
    if (has("f_r")) return usage(file, "it holds three bands already; wanted one, in a column f");
    const auto f = proc::numbersOf(points, "f");
    if (!f) return f.error().in("merge: '" + file + "'");
    const bool split = has("u_random");
    const auto random = columnOr(points, split ? "u_random" : "u");
    if (!random) return random.error().in("merge: '" + file + "'");
    const auto systematic = columnOr(points, split ? "u_systematic" : "");
    if (!systematic) return systematic.error().in("merge: '" + file + "'");
    const auto flags = has("flags") ? proc::flagsOf(points, "flags")
                                    : Result<std::vector<Flags>>(std::vector<Flags>{});
    if (!flags) return flags.error().in("merge: '" + file + "'");
    proc::ScatteredSet set(proc::PairSymmetry::None, BandCount::One);
    std::vector<proc::ScatteredSample> samples;
    for (std::size_t i = 0; i < points.pairs.size(); ++i) {
        const LightView& pair = points.pairs[i];
        if (!std::isfinite((*f)[i]) || !pair.in.aboveHorizon() || !pair.out.aboveHorizon())
            continue;
        proc::ScatteredSample sample{
            .pair = pair, .f = LedBands::all((*f)[i]), .uRandom = {}, .uSystematic = {}};
        if (i < flags->size()) {
            if (proc::isLost((*flags)[i])) continue;
            sample.flags = (*flags)[i];
        }
        const auto known = [&](const std::vector<double>& column) {
            return i < column.size() && std::isfinite(column[i]);
        };
        if (known(*random)) sample.uRandom = LedBands::all((*random)[i]);
        if (known(*systematic)) sample.uSystematic = LedBands::all((*systematic)[i]);
        samples.push_back(sample);
    }
    if (samples.empty()) {
        return Error{ErrorKind::File,
                     "merge: '" + file + "': no row has a value above the horizon"};
    }
    if (const auto added = set.add(samples); !added)
        return added.error().in("merge: '" + file + "'");
    return set;
}

Result<MergeInput> readOne(const std::string& file, const fs::path& store) {
    MergeInput input{.file = file};
    if (fs::path(file).extension() == ".csv") {
        const auto points = proc::readPoints(file);
        if (!points) return points.error();
        auto values = valuesOf(file, *points);
        if (!values) return values.error();
        input.values = std::move(*values);
        const auto band = bandOf(file, {});
        if (!band) return band.error();
        input.band = *band;
        return input;
    }
    Result<Material> material = openMaterial(file, store);
    if (!material) return material.error();
    if (material->sample != nullptr) {
        input.sample = *material->sample;
        input.band = onlyBand(*input.sample);
        return input;
    }
    if (material->table == nullptr) return usage(file, "a model needs no merge; wanted files");
    auto scattered = proc::scatteredOf(*material->table);
    if (!scattered) return scattered.error().in("merge: '" + file + "'");
    input.values = std::move(scattered->set);
    const auto band = bandOf(file, material->table->comments);
    if (!band) return band.error();
    input.band = *band;
    return input;
}

/// NaN is NaN here.
bool sameValues(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return x == y || (std::isnan(x) && std::isnan(y));
    });
}

bool sameSample(const proc::SampleSet& a, const proc::SampleSet& b) {
    const auto sameTable = [](const proc::LedTable& one, const proc::LedTable& other) {
        for (std::size_t i = 0; i < 3; ++i) {
            if (!sameValues(one.bands[i].f, other.bands[i].f)) return false;
        }
        return one.incidence == other.incidence && one.rotation == other.rotation;
    };
    return std::equal(a.leds.begin(), a.leds.end(), b.leds.begin(), b.leds.end(), sameTable);
}

}  // namespace

Result<std::vector<MergeInput>> readMergeInputs(const std::vector<std::string>& files,
                                                const fs::path& store) {
    std::vector<MergeInput> inputs;
    for (const std::string& file : files) {
        Result<MergeInput> one = readOne(file, store);
        if (!one) return one.error();
        const auto twin = std::find_if(inputs.begin(), inputs.end(), [&](const MergeInput& other) {
            return one->sample && other.sample && sameSample(*one->sample, *other.sample);
        });
        if (twin == inputs.end()) {
            inputs.push_back(std::move(*one));
            continue;
        }
        log::warning("merge: '" + file + "' holds the same values as '" + twin->file +
                     "'; it counts once");
    }
    return inputs;
}

}  // namespace gonio::daemon
