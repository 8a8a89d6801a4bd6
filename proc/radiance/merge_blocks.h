#pragma once
// The loops of the merge over a block of pixels of one row, free of branches and of a fixed length
// that stays in the nearest cache, so that they become vector instructions: the loader picks the
// widest that the machine has (SSE2, AVX2 or AVX-512), and as nothing is contracted or reordered
// all of them give the same bits. Their slow twin is mergeReference (merge.h).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace gonio::proc {

inline constexpr std::size_t kBlock = 64;
using BlockOfPixels = std::array<double, kBlock>;

// A tally: how many samples in its upper 10 bits, the sum of their DN in its lower 22.
inline constexpr std::uint32_t kSumBits = 22;
inline constexpr std::uint32_t kLargestSum = (1U << kSumBits) - 1;
inline constexpr std::uint32_t kMostAlike = (1U << (32 - kSumBits)) - 1;

/// Added to a divisor, so that 0 / 0 is 0 without a choice: the compiler would compute both sides
/// of it. Lost in any other divisor here; its inverse is a float.
inline constexpr double kTiny = 1e-37;

/// Sum of a block in eight strands, which an addition of doubles would otherwise serialise.
[[nodiscard]] inline double total(const BlockOfPixels& of) {
    constexpr std::size_t kStrands = 8;
    std::array<double, kStrands> sums{};
    for (std::size_t x = 0; x < kBlock; x += kStrands)
        for (std::size_t i = 0; i < kStrands; ++i) sums[i] += of[x + i];
    double sum = 0;
    for (const double strand : sums) sum += strand;
    return sum;
}

/// Adds the samples of a row whose `usable` is 1 to the tallies.
void addUsable(std::span<const std::uint16_t> row,
               std::span<const std::uint8_t> usable,
               std::span<std::uint32_t> tallies);

/// One group's samples; nothing usable behind the end of the row.
struct GroupBlock {
    BlockOfPixels count{};   ///< usable samples
    BlockOfPixels net{};     ///< their sum less the dark, DN
    BlockOfPixels excess{};  ///< of a hot pixel: variance of a sample, electrons^2
    bool anyHot = false;     ///< false: `excess` says nothing, there is none
    bool single = false;     ///< one frame: a pixel has one sample or none
};

/// Counts, and sums less `count` times the dark, of at most kBlock pixels.
void unpackTallies(std::span<const std::uint32_t> tallies,
                   std::span<const float> dark,
                   GroupBlock& block);

/// A bent response (Linearity), of which the loops know only the numbers.
struct Bend {
    double black = 0, range = 1;           ///< DN
    std::span<const double> coefficients;  ///< a_1 .. a_d, at least one
};
/// The sums as a proportional sensor would have given them: of n samples n times the correction of
/// their mean, less that of the dark.
void straighten(const Bend& bend, std::span<const float> dark, GroupBlock& block);

/// What does not depend on the pixel. Variances in electrons^2.
struct GroupFigures {
    double tau = 0;
    double floorVariance = 0;  ///< of one sample in the dark
    double darkVariance = 0;   ///< of the dark frame
    double excessInDark = 0;   ///< share of a sample's excess that the dark frame has
    bool single = false;       ///< one frame: a pixel has one sample or none
};

/// What is alike in all groups.
struct BracketFigures {
    double electronsPerDn = 1;
    double members = 1;  ///< sensor pixels of which a pixel is the mean
    double frames = 0;   ///< samples of a pixel, usable or not
};

/// Where the results of a block go: at most kBlock pixels.
struct MergedBlock {
    std::span<float> radiance, variance;
    std::span<std::uint8_t> used, saturated;
};
/// Sums over pixels; the counts are whole numbers.
struct BlockTotals {
    double chiSquare = 0;
    double freedom = 0;
    double unused = 0;  ///< pixels without a usable sample
};
/// The weighted mean over the groups, each with its figures; NaN where nothing is usable.
BlockTotals mergeBlock(std::span<const GroupBlock> groups,
                       std::span<const GroupFigures> figures,
                       const BracketFigures& bracket,
                       const MergedBlock& out);

}  // namespace gonio::proc
