#pragma once
// The materials that a statistical prior is drawn from, as specs of our models in one band: one per
// line in a text file, with lines that start with # as comments. The standard library is drawn from
// documented families by a seed:
//   lobe     GGX, Beckmann or GTR (gamma 1.2 .. 4, log-uniform) a third each; alpha log-uniform in
//            [0.04, 0.7]; f0 of a dielectric (0.02 .. 0.1, half of them) or a metal (0.15 .. 1)
//   second   in half of them another of the three, f0 log-uniform in [0.003, 0.5]
//   diffuse  none in a fifth, else Lambert or Oren-Nayar (sigma 0.1 .. 0.9) half each, albedo
//            log-uniform in [0.005, 0.9]
// Published fits to measured materials (proc/models/published_fits.h) can be added.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "proc/core/result.h"

namespace gonio::proc {

struct PriorLibrary {
    static constexpr std::size_t kFewest = 10;  ///< materials that differ; fewer have no statistics

    std::vector<std::string> specs;

    [[nodiscard]] static PriorLibrary standard(std::size_t count, std::uint64_t seed = 1);
    /// Adds the fits of a file whose lobes a grid of one degree resolves: widths of at least 0.04.
    /// Returns how many; a File error as readPublishedFits().
    Result<std::size_t> addPublishedFits(const std::filesystem::path& file);

    [[nodiscard]] std::string text() const;
    /// A File error names the line whose spec is no model; likewise for fewer than kFewest
    /// different specs.
    [[nodiscard]] static Result<PriorLibrary> read(const std::filesystem::path& file);
};

}  // namespace gonio::proc
