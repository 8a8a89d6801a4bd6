#include "proc/export/conversion_steps.h"

#include <algorithm>
#include <cmath>

#include "proc/export/one_band.h"
#include "proc/export/resampling.h"
#include "proc/formats/open.h"
#include "proc/optics/cell_grid.h"
#include "proc/table/band_channels.h"

namespace gonio::proc {
namespace {

/// Probes that are asked at most: a quarter of a second of the slowest estimator.
constexpr std::size_t kMostProbes = 40'000;

struct PlainLosses {
    std::size_t uncertain = 0, flagged = 0, transmitted = 0, otherMatrices = 0;
};

void count(PlainLosses& lost, const SampleSet& set) {
    for (const LedTable& led : set.leds) {
        for (const CellSamples& cells : led.bands) {
            for (std::size_t i = 0; i < cells.size(); ++i) {
                if (!cells.present(i)) continue;
                if (!std::isnan(cells.uRandom[i])) ++lost.uncertain;
                if (cells.flags[i] != Flags{Flag::Measured}) ++lost.flagged;
            }
        }
    }
}
void count(PlainLosses& lost, const BrdfRows& rows) {
    for (std::size_t i = 0; i < rows.f.size(); ++i) {
        if (std::isnan(rows.f[i])) continue;
        if (!rows.uRandom.empty() && !std::isnan(rows.uRandom[i])) ++lost.uncertain;
        if (!rows.flags.empty() && rows.flags[i] != Flags{Flag::Measured}) ++lost.flagged;
        if (!rows.pairs[i / rows.channels.size()].out.aboveHorizon()) ++lost.transmitted;
    }
}
void count(PlainLosses& lost, const SphericalTable& table) {
    for (const SphericalBlock& block : table.blocks) {
        if (!block.transmission) continue;
        lost.transmitted += static_cast<std::size_t>(
            std::count_if(block.f.begin(), block.f.end(), [](double f) { return !std::isnan(f); }));
    }
}
/// What the look-up does not answer from: all but the front's visible reflection.
void count(PlainLosses& lost, const KlemsTable& table) {
    for (const KlemsMatrix& matrix : table.matrices) {
        if (matrix.transmission) lost.transmitted += matrix.f.size();
        const bool taken = matrix.face == KlemsFace::Front && matrix.spectrum == "Visible";
        if (!taken && !matrix.transmission) lost.otherMatrices += matrix.f.size();
    }
}
template <class Other>
void count(PlainLosses& /*lost*/, const Other& /*table*/) {}

/// What the source says, at its own values where nothing answers between them.
std::vector<Probe> probesOfSource(const ConversionSource& source) {
    if (source.scatterer) {
        const std::size_t lights = source.incidenceDeg.size() * source.rotationDeg.size();
        const std::size_t stride =
            std::max<std::size_t>(1, lights * CellGrid::count() / kMostProbes);
        return probesOf(*source.scatterer, source.incidenceDeg, source.rotationDeg, stride);
    }
    std::vector<Probe> probes;
    const auto* rows = source.file ? source.file->as<BrdfRows>() : nullptr;
    if (rows == nullptr) return probes;
    const auto bands = bandChannels(rows->channels);
    if (!bands) return probes;
    for (std::size_t i = 0; i < rows->pairs.size(); ++i) {
        Probe probe{rows->pairs[i], {}};
        for (const Band band : kBands) {
            probe.f[band] = bands->bands[index(band)].of(
                [&](std::size_t channel) { return rows->f[rows->index(i, channel)]; });
        }
        probes.push_back(probe);
    }
    return probes;
}

}  // namespace

ConvertedFile fileOf(Written written) {
    return {"", std::move(written.bytes), std::move(written.loss)};
}

Converted onlyFile(Result<Written> written) {
    if (!written) return written.error();
    return std::vector{fileOf(std::move(*written))};
}

bool mayCopy(const ConversionSource& source, const ConversionWish& wish) {
    if (source.file == nullptr || source.estimated || wish.grid.asks()) return false;
    const bool kept =
        source.file->as<SampleSet>() != nullptr || source.file->as<BrdfRows>() != nullptr;
    return kept || source.file->bands.empty();  // of samples and rows the others are gone already
}

std::vector<double> incidencesFor(const ConversionSource& source, const ConversionWish& wish) {
    return wish.grid.incidenceDeg.value_or(source.incidenceDeg);
}

std::shared_ptr<const Scatterer> bandOf(const ConversionSource& source, Band band) {
    if (source.scatterer->bandCount() == BandCount::One) return source.scatterer;
    return std::make_shared<OneBand>(source.scatterer, band);
}

std::shared_ptr<const Scatterer> allBands(const ConversionSource& source) {
    return source.bands.size() == 1 ? bandOf(source, source.bands.front()) : source.scatterer;
}

std::vector<Channel> channelsFor(const ConversionSource& source) {
    if (!source.monochrome()) {
        std::vector<Channel> channels;
        channels.reserve(source.bands.size());
        for (const Band band : source.bands) channels.push_back(Channel::of(band));
        return channels;
    }
    if (source.file) {
        std::vector<Channel> own = channelsOf(*source.file);
        if (own.size() == 1) return own;
    }
    if (source.bands.empty()) return {Channel{}};
    return {Channel::of(source.bands.front())};
}

Result<void> mustAnswer(const ConversionSource& source, Format to) {
    if (source.scatterer) return {};
    return Error{ErrorKind::Usage,
                 "a " + std::string(factsOf(to).title) +
                     " is a grid that must be answered at: " + source.noScatterer};
}

Result<void> mustHaveThree(const ConversionSource& source, Format to) {
    if (source.bands.size() != 2) return {};
    return Error{ErrorKind::Usage,
                 "a " + std::string(factsOf(to).title) +
                     " holds R, G and B, and this has two of them: --bands takes one"};
}

namespace {

PlainLosses lossesOf(const ConversionSource& source) {
    PlainLosses lost;
    if (!source.file) return lost;
    std::visit([&](const auto& content) { count(lost, content); }, source.file->content);
    return lost;
}

void addSides(LossReport& loss, const ConversionSource& source, const PlainLosses& lost) {
    loss.add(Loss::Dropped, "values of transmission", lost.transmitted);
    loss.add(Loss::Dropped,
             "values of other faces and spectra than the front's visible one",
             lost.otherMatrices);
    if (source.lightAzimuths > source.rotationDeg.size()) {
        loss.add(Loss::Dropped,
                 "azimuths of the light",
                 source.lightAzimuths - source.rotationDeg.size());
    }
}

}  // namespace

void addPlainLosses(LossReport& loss, const ConversionSource& source) {
    const PlainLosses lost = lossesOf(source);
    loss.add(Loss::Dropped, "uncertainties", lost.uncertain);
    loss.add(Loss::Dropped, "flags other than measured", lost.flagged);
    addSides(loss, source, lost);
}

void addSideLosses(LossReport& loss, const ConversionSource& source) {
    addSides(loss, source, lossesOf(source));
}

void addResampling(ConvertedFile& file,
                   const ConversionSource& source,
                   const Asked& asked,
                   Format to,
                   std::optional<Band> band) {
    LossReport::Item item{Loss::Resampled, "values asked at the format's directions", asked.nodes};
    const std::vector<Band> bands = band                   ? std::vector{*band}
                                    : source.bands.empty() ? std::vector{Band::R}
                                                           : source.bands;
    Result<BrdfFile> back = decodeBrdf(to, file.bytes, "what was written");
    if (back) {
        if (auto lookup = lookupOver(std::move(*back))) {
            const auto error = resamplingError(probesOfSource(source), **lookup, bands);
            if (error) {
                item.largestError = error->largest;
                item.weightedError = error->weighted;
                file.loss.add(Loss::Masked, "values of the source without one nearby", error->lost);
            }
        }
    }
    file.loss.items.insert(file.loss.items.begin(), std::move(item));
    file.loss.add(Loss::Masked, "directions without an answer", asked.unanswered);
    file.loss.add(Loss::Extrapolated, "values from beyond what was measured", asked.extrapolated);
}

}  // namespace gonio::proc
