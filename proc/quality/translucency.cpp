#include "proc/quality/translucency.h"

#include <algorithm>
#include <cmath>

#include "proc/optics/cell_grid.h"
#include "proc/table/rotations.h"

namespace gonio::proc {
namespace {

constexpr Radians kOutermost = 60_deg, kFromMirror = 30_deg;

bool diffuse(const Direction& wo, Radians incidence) {
    const Direction mirror = Direction::fromSpherical(incidence, Radians(kPi));
    return wo.theta() < kOutermost && angleBetween({wo, mirror}) > kFromMirror;
}

/// Sums over cells of f on white minus f on black.
struct Sums {
    double difference = 0, random = 0, onBlack = 0, onWhite = 0, cells = 0;

    void add(const CellSamples& black, const CellSamples& white, std::size_t cell) {
        difference += white.f[cell] - black.f[cell];
        random += std::pow(black.uRandom[cell], 2) + std::pow(white.uRandom[cell], 2);
        onBlack += black.uSystematic[cell];
        onWhite += white.uSystematic[cell];
        ++cells;
    }
    [[nodiscard]] double u() const { return std::hypot(std::sqrt(random), onBlack, onWhite); }
};

void addLed(Sums& sums, const LedTable& black, const LedTable& white, Band band) {
    const CellSamples& onBlack = black.bands[index(band)];
    const CellSamples& onWhite = white.bands[index(band)];
    const std::size_t cells = std::min(onBlack.size(), onWhite.size());
    for (std::size_t cell = 0; cell < cells; ++cell) {
        if (!onBlack.present(cell) || !onWhite.present(cell)) continue;
        if (diffuse(CellGrid::centre(cell), black.incidence)) sums.add(onBlack, onWhite, cell);
    }
}

Sums sumsOf(const BackingPair& pair, Band band) {
    Sums sums;
    for (const LedTable& black : pair.black.leds) {
        for (const LedTable& white : pair.white.leds) {
            if (sameLight(black, white)) addLed(sums, black, white, band);
        }
    }
    return sums;
}

/// "R 8.70 % (u 0.30 %), G ..., B ...".
std::string byBand(const BackingDifference& difference) {
    std::string text;
    for (const Band band : kBands) {
        text += (text.empty() ? "" : ", ") + std::string(letter(band)) + " " +
                amount(difference.reflectance[band], "1") + " (u " +
                amount(difference.u[band], "1") + ")";
    }
    return text;
}

Band largestOf(const LedBands& bands) {
    return *std::max_element(
        kBands.begin(), kBands.end(), [&](Band a, Band b) { return bands[a] < bands[b]; });
}

}  // namespace

std::string_view name(Backing backing) { return backing == Backing::White ? "white" : "black"; }

Result<Backing> parseBacking(std::string_view text) {
    if (text == "black") return Backing::Black;
    if (text == "white") return Backing::White;
    return Error{ErrorKind::Usage, "backing '" + std::string(text) + "': wanted black or white"};
}

std::optional<BackingDifference> backingDifference(const BackingPair& pair) {
    BackingDifference difference;
    for (const Band band : kBands) {
        const Sums sums = sumsOf(pair, band);
        if (sums.cells == 0) return std::nullopt;
        difference.reflectance[band] = kPi * sums.difference / sums.cells;
        difference.u[band] = kPi * sums.u() / sums.cells;
    }
    return difference;
}

Verdict translucencyVerdict(const std::optional<BackingDifference>& difference,
                            const std::optional<Backing>& backing,
                            const QualityLimits& limits) {
    Verdict verdict{.name = "translucency", .figure = {}, .evidence = {}, .next = {}};
    if (!difference || !backing) {
        const bool onWhite = backing == Backing::White;
        verdict.evidence =
            backing ? "it was measured on one backing alone, " + std::string(name(*backing))
                    : "it was not said on which backing it lay";
        verdict.next =
            std::string("where light may go through it, measure it on a black and on a ") +
            "white backing, the second time with --backing " + (onWhite ? "black" : "white") +
            " --against the first";
        return verdict;
    }
    const Band largest = largestOf(difference->reflectance);
    const double size = difference->reflectance[largest], u = difference->u[largest];
    const double limit = std::max(limits.translucencySure * u, limits.translucency);
    verdict.figure = Figure{.value = size, .u = u, .unit = "1", .limit = limit};
    verdict.evidence =
        "from a black to a white backing its reflectance changes by " + byBand(*difference);
    if (size <= limit) {
        verdict.grade = Grade::Ok;
        return verdict;
    }
    verdict.grade = backing == Backing::White ? Grade::Refused : Grade::Warned;
    verdict.evidence = "light goes through the sample: " + verdict.evidence;
    if (largest != Band::R) {
        verdict.evidence += ", though not most in red: was it the same spot of the sample?";
    }
    verdict.next = backing == Backing::White ? "measure it on a black backing"
                                             : "keep the black backing, or make the sample thicker";
    return verdict;
}

}  // namespace gonio::proc
